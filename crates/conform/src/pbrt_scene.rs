//! The same scene for pbrt-v4 and programs that read its format.
//!
//! pbrt's camera has +x on the right of the picture in a left-handed space, so that `Scale -1 1 1` comes before `LookAt`. Emission is
//! `rgb`, whose luminance is the number itself; other spectra are the same at all wavelengths.

use crate::mode::Mode;
use crate::scene::{
    Camera, Falloff, Light, Masking, Material, Medium, Object, Projection, Scene, Shape, Sky,
    Triple,
};
use glam::DVec3;
use std::fmt::Write;

/// Bounces where nothing is to be left out; with this many, little light is left in any scene.
const BOUNCES: u32 = 1000;

/// Writes a scene.
///
/// # Errors
/// What the format cannot say.
pub fn write(scene: &Scene, mode: Mode) -> Result<String, String> {
    let pixels = scene.pixels;
    let depth = match mode {
        Mode::Measure => format!(" \"integer maxdepth\" {BOUNCES}"),
        Mode::Shipped => String::new(),
    };
    let mut text = format!(
        "Film \"rgb\" \"integer xresolution\" {pixels} \"integer yresolution\" {pixels} \"bool savefp16\" false\n\
         PixelFilter \"box\"\nSampler \"independent\"\nIntegrator \"volpath\"{depth}\n{}WorldBegin\n",
        camera(&scene.camera)
    );
    for (index, object) in scene.objects.iter().enumerate() {
        text += &self::object(object, &format!("inside{index}"))?;
    }
    for light in &scene.lights {
        text += &self::light(light)?;
    }
    match &scene.sky {
        None => {}
        Some(Sky::Even { radiance }) => {
            let _ = writeln!(text, "LightSource \"infinite\" {}", rgb("L", *radiance));
        }
        Some(Sky::Map { .. }) => {
            return Err(
                "images of infinite lights are equal-area maps, and this sky is not".to_owned(),
            );
        }
    }
    Ok(text)
}

fn triple([x, y, z]: Triple) -> String {
    format!("{x:?} {y:?} {z:?}")
}

fn rgb(name: &str, value: f64) -> String {
    format!("\"rgb {name}\" [ {value:?} {value:?} {value:?} ]")
}

/// A spectrum that is the same wherever light is.
fn even(name: &str, value: f64) -> String {
    format!("\"spectrum {name}\" [ 300 {value:?} 900 {value:?} ]")
}

fn camera(camera: &Camera) -> String {
    let plugin = match camera.projection {
        Projection::Orthographic { width_m } => {
            let half = 0.5 * width_m;
            format!(
                "\"orthographic\" \"float screenwindow\" [ -{half:?} {half:?} -{half:?} {half:?} ]"
            )
        }
        Projection::Pinhole {
            field_of_view_degrees,
        } => format!("\"perspective\" \"float fov\" {field_of_view_degrees:?}"),
        Projection::ThinLens {
            field_of_view_degrees,
            lens_radius_m,
            focus_distance_m,
        } => format!(
            "\"perspective\" \"float fov\" {field_of_view_degrees:?} \"float lensradius\" {lens_radius_m:?} \
             \"float focaldistance\" {focus_distance_m:?}"
        ),
    };
    format!(
        "Scale -1 1 1\nLookAt {}  {}  {}\nCamera {plugin}\n",
        triple(camera.origin_m),
        triple(camera.target_m),
        triple(camera.up)
    )
}

/// An object in a block of its own; `inside` is a name for its medium.
fn object(object: &Object, inside: &str) -> Result<String, String> {
    let mut text = format!("AttributeBegin\n  {}\n", material(&object.material)?);
    if let Some(Medium {
        absorption_per_m,
        scattering_per_m,
    }) = object.interior
    {
        let _ = writeln!(
            text,
            "  MakeNamedMedium \"{inside}\" \"string type\" \"homogeneous\" {} {}\n  MediumInterface \"{inside}\" \"\"",
            even("sigma_a", absorption_per_m),
            even("sigma_s", scattering_per_m)
        );
    }
    if object.emitted_radiance != 0.0 {
        let radiance = rgb("L", object.emitted_radiance);
        let _ = writeln!(text, "  AreaLightSource \"diffuse\" {radiance}");
    }
    Ok(text + &shape(&object.shape) + "AttributeEnd\n")
}

fn material(material: &Material) -> Result<String, String> {
    Ok(match *material {
        Material::Diffuse { reflectance } => {
            format!("Material \"diffuse\" {}", even("reflectance", reflectance))
        }
        Material::Mirror { .. } => {
            return Err(
                "what mirrors reflect depends on the angle, and here it does not".to_owned(),
            );
        }
        Material::Conductor { n, k } => {
            format!("Material \"conductor\" {} {}", even("eta", n), even("k", k))
        }
        Material::RoughConductor {
            masking: Masking::Separable,
            ..
        } => {
            return Err("microfacets hide each other by their height, and these do not".to_owned());
        }
        Material::RoughConductor { n, k, alpha, .. } => format!(
            "Material \"conductor\" {} {} \"float roughness\" {alpha:?} \"bool remaproughness\" false",
            even("eta", n),
            even("k", k)
        ),
        Material::Glass { n } => format!("Material \"dielectric\" \"float eta\" {n:?}"),
        Material::Nothing => "Material \"interface\"".to_owned(),
    })
}

fn shape(shape: &Shape) -> String {
    match shape {
        Shape::Sphere {
            center_m,
            radius_m,
            inward,
        } => {
            let turned = if *inward {
                "  ReverseOrientation\n"
            } else {
                ""
            };
            format!(
                "{turned}  Translate {}\n  Shape \"sphere\" \"float radius\" {radius_m:?}\n",
                triple(*center_m)
            )
        }
        Shape::Quad {
            center_m,
            half_u_m,
            half_v_m,
        } => {
            let [center, u, v] = [center_m, half_u_m, half_v_m].map(|t| DVec3::from(*t));
            let corners = [
                center - u - v,
                center + u - v,
                center + u + v,
                center - u + v,
            ];
            mesh(
                &corners.map(|corner| corner.to_array()),
                &[[0, 1, 2], [0, 2, 3]],
            )
        }
        Shape::Box {
            center_m,
            half_axes_m,
        } => {
            let axes = half_axes_m.map(DVec3::from);
            let side = |index: u32, bit: u32| f64::from(index >> bit & 1) * 2.0 - 1.0;
            let corner = |index: u32| {
                let parts = (0..3).map(|bit| side(index, bit) * axes[bit as usize]);
                (DVec3::from(*center_m) + parts.sum::<DVec3>()).to_array()
            };
            let corners: Vec<Triple> = (0..8).map(corner).collect();
            mesh(&corners, &BOX)
        }
        Shape::Mesh {
            positions_m,
            triangles,
        } => mesh(positions_m, triangles),
    }
}

/// Two triangles for each face of a box, which turn to the left from outside; a corner's bits are its sides along the axes.
const BOX: [[u32; 3]; 12] = [
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
];

fn mesh(corners: &[Triple], triangles: &[[u32; 3]]) -> String {
    let points: Vec<String> = corners.iter().map(|corner| triple(*corner)).collect();
    let indices: Vec<String> = triangles.iter().flatten().map(u32::to_string).collect();
    format!(
        "  Shape \"trianglemesh\" \"point3 P\" [ {} ] \"integer indices\" [ {} ]\n",
        points.join("  "),
        indices.join(" ")
    )
}

fn light(light: &Light) -> Result<String, String> {
    Ok(match *light {
        Light::Point {
            position_m,
            intensity,
        } => format!(
            "LightSource \"point\" \"point3 from\" [ {} ] {}\n",
            triple(position_m),
            rgb("I", intensity)
        ),
        Light::Spot {
            falloff: Some(Falloff::LinearInAngle | Falloff::QuarticInCosine),
            ..
        } => {
            return Err(
                "spots fall off by a smooth step in the cosine, and this one does not".to_owned(),
            );
        }
        Light::Spot {
            position_m,
            target_m,
            intensity,
            even_to_degrees,
            dark_from_degrees,
            ..
        } => format!(
            "LightSource \"spot\" \"point3 from\" [ {} ] \"point3 to\" [ {} ] {} \"float coneangle\" {dark_from_degrees:?} \
             \"float conedeltaangle\" {:?}\n",
            triple(position_m),
            triple(target_m),
            rgb("I", intensity),
            dark_from_degrees - even_to_degrees
        ),
        Light::Sun {
            direction,
            irradiance,
        } => format!(
            "LightSource \"distant\" \"point3 from\" [ 0 0 0 ] \"point3 to\" [ {} ] {}\n",
            triple(direction),
            rgb("L", irradiance)
        ),
    })
}
