//! The same scene for programs that read Mitsuba 3's XML.
//!
//! Emission is `rgb`, whose luminance is the number itself in spectral variants too; a uniform spectrum of 1 has the luminance
//! 1.000999 there. Meshes stand in OBJ files beside the scene.

use crate::mode::Mode;
use crate::scene::{
    Camera, Falloff, Interpolation, Light, Masking, Material, Object, Projection, Scene, Shape,
    Sky, Triple, quad_normal,
};
use std::fmt::Write;

/// A scene as XML.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MitsubaXml {
    /// The scene's text.
    pub text: String,
    /// Names and texts of the files that it names.
    pub files: Vec<(String, Vec<u8>)>,
}

/// Writes a scene, whose own files are named after `name`.
///
/// # Errors
/// What the format cannot say.
pub fn write(scene: &Scene, name: &str, mode: Mode) -> Result<MitsubaXml, String> {
    let mut files = Vec::new();
    let mut body = String::new();
    for (index, object) in scene.objects.iter().enumerate() {
        let file = format!("{name}-{index}.obj");
        body += &self::object(object, &file)?;
        if let Shape::Mesh {
            positions_m,
            triangles,
        } = &object.shape
        {
            files.push((file, obj(positions_m, triangles).into_bytes()));
        }
    }
    for light in &scene.lights {
        body += &self::light(light)?;
    }
    match &scene.sky {
        None => {}
        Some(Sky::Even { radiance }) => {
            let radiance = rgb("radiance", *radiance);
            let _ = writeln!(body, "  <emitter type=\"constant\">{radiance}</emitter>");
        }
        Some(map @ Sky::Map { .. }) => {
            let file = format!("{name}.pfm");
            files.push((file.clone(), pfm(map)?));
            body += &environment(map, &file);
        }
    }
    let depth = match mode {
        Mode::Measure => {
            "<integer name=\"max_depth\" value=\"-1\"/><integer name=\"rr_depth\" value=\"20\"/>"
        }
        Mode::Shipped => "",
    };
    let has_medium = scene.objects.iter().any(|object| object.interior.is_some());
    let integrator = if has_medium { "volpath" } else { "path" };
    let text = format!(
        "<scene version=\"3.0.0\">\n  <default name=\"spp\" value=\"64\"/>\n  <default name=\"sampler\" value=\"independent\"/>\n  \
         <integrator type=\"{integrator}\">{depth}</integrator>\n{camera}{body}</scene>\n",
        camera = camera(&scene.camera, scene.pixels)
    );
    Ok(MitsubaXml { text, files })
}

/// A number that reads back as it was.
fn number(value: f64) -> String {
    format!("{value:?}")
}

fn triple([x, y, z]: Triple) -> String {
    format!("{x:?}, {y:?}, {z:?}")
}

fn rgb(name: &str, value: f64) -> String {
    format!("<rgb name=\"{name}\" value=\"{value:?}\"/>")
}

fn uniform(name: &str, value: f64) -> String {
    format!(
        "<spectrum name=\"{name}\" type=\"uniform\"><float name=\"value\" value=\"{value:?}\"/></spectrum>"
    )
}

fn float(name: &str, value: f64) -> String {
    format!("<float name=\"{name}\" value=\"{}\"/>", number(value))
}

fn camera(camera: &Camera, pixels: u32) -> String {
    let (kind, parameters, width) = match camera.projection {
        Projection::Orthographic { width_m } => ("orthographic", String::new(), Some(width_m)),
        Projection::Pinhole {
            field_of_view_degrees,
        } => ("perspective", float("fov", field_of_view_degrees), None),
        Projection::ThinLens {
            field_of_view_degrees,
            lens_radius_m,
            focus_distance_m,
        } => {
            let parameters = [
                float("fov", field_of_view_degrees),
                float("aperture_radius", lens_radius_m),
                float("focus_distance", focus_distance_m),
            ];
            ("thinlens", parameters.concat(), None)
        }
    };
    let scale = width.map_or_else(String::new, |width| {
        format!("<scale x=\"{0}\" y=\"{0}\"/>", number(0.5 * width))
    });
    format!(
        "  <sensor type=\"{kind}\">{parameters}{near}{far}\n    <transform name=\"to_world\">{scale}\
         <lookat origin=\"{origin}\" target=\"{target}\" up=\"{up}\"/></transform>\n    \
         <film type=\"hdrfilm\"><integer name=\"width\" value=\"{pixels}\"/><integer name=\"height\" value=\"{pixels}\"/>\
         <string name=\"component_format\" value=\"float32\"/><rfilter type=\"box\"/></film>\n    \
         <sampler type=\"$sampler\"><integer name=\"sample_count\" value=\"$spp\"/></sampler>\n  </sensor>\n",
        near = float("near_clip", 1e-3),
        far = float("far_clip", 1e6),
        origin = triple(camera.origin_m),
        target = triple(camera.target_m),
        up = triple(camera.up),
    )
}

fn object(object: &Object, file: &str) -> Result<String, String> {
    let (kind, shape) = match &object.shape {
        Shape::Sphere {
            center_m,
            radius_m,
            inward,
        } => {
            let shape = format!(
                "<point name=\"center\" value=\"{}\"/>{}<boolean name=\"flip_normals\" value=\"{inward}\"/>",
                triple(*center_m),
                float("radius", *radius_m)
            );
            ("sphere", shape)
        }
        Shape::Quad {
            center_m,
            half_u_m,
            half_v_m,
        } => {
            let normal = quad_normal(*half_u_m, *half_v_m).to_array();
            let shape = to_world([*half_u_m, *half_v_m, normal], *center_m);
            ("rectangle", shape)
        }
        Shape::Box {
            center_m,
            half_axes_m,
        } => ("cube", to_world(*half_axes_m, *center_m)),
        Shape::Mesh { .. } => {
            let shape = format!(
                "<string name=\"filename\" value=\"{file}\"/><boolean name=\"face_normals\" value=\"true\"/>"
            );
            ("obj", shape)
        }
    };
    let emitter = match object.emitted_radiance {
        0.0 => String::new(),
        radiance => format!(
            "<emitter type=\"area\">{}</emitter>",
            rgb("radiance", radiance)
        ),
    };
    let interior = object.interior.map_or_else(String::new, |medium| {
        let extinction = medium.absorption_per_m + medium.scattering_per_m;
        format!(
            "<medium name=\"interior\" type=\"homogeneous\">{}{}</medium>",
            uniform("albedo", medium.scattering_per_m / extinction),
            float("sigma_t", extinction)
        )
    });
    Ok(format!(
        "  <shape type=\"{kind}\">{shape}\n    {}{emitter}{interior}</shape>\n",
        bsdf(&object.material)?
    ))
}

/// The transform of a shape's own axes.
fn to_world(axes: [Triple; 3], center: Triple) -> String {
    let row = |i: usize| {
        let [a, b, c] = axes.map(|axis| axis[i]);
        format!("{a:?} {b:?} {c:?} {:?} ", center[i])
    };
    format!(
        "<transform name=\"to_world\"><matrix value=\"{}{}{}0 0 0 1\"/></transform>",
        row(0),
        row(1),
        row(2)
    )
}

fn bsdf(material: &Material) -> Result<String, String> {
    Ok(match *material {
        Material::Diffuse { reflectance } => format!(
            "<bsdf type=\"twosided\"><bsdf type=\"diffuse\">{}</bsdf></bsdf>",
            uniform("reflectance", reflectance)
        ),
        Material::Mirror { reflectance } => format!(
            "<bsdf type=\"twosided\"><bsdf type=\"conductor\"><string name=\"material\" value=\"none\"/>{}</bsdf></bsdf>",
            uniform("specular_reflectance", reflectance)
        ),
        Material::Conductor { n, k } => format!(
            "<bsdf type=\"twosided\"><bsdf type=\"conductor\">{}{}</bsdf></bsdf>",
            uniform("eta", n),
            uniform("k", k)
        ),
        Material::RoughConductor {
            masking: Masking::HeightCorrelated,
            ..
        } => {
            return Err("microfacets hide each other independently, and these do not".to_owned());
        }
        Material::RoughConductor { n, k, alpha, .. } => format!(
            "<bsdf type=\"twosided\"><bsdf type=\"roughconductor\"><string name=\"distribution\" value=\"ggx\"/>{}{}{}</bsdf></bsdf>",
            float("alpha", alpha),
            uniform("eta", n),
            uniform("k", k)
        ),
        Material::Glass { n } => format!(
            "<bsdf type=\"dielectric\">{}{}</bsdf>",
            float("int_ior", n),
            float("ext_ior", 1.0)
        ),
        Material::Nothing => "<bsdf type=\"null\"/>".to_owned(),
    })
}

fn light(light: &Light) -> Result<String, String> {
    Ok(match *light {
        Light::Point {
            position_m,
            intensity,
        } => format!(
            "  <emitter type=\"point\"><point name=\"position\" value=\"{}\"/>{}</emitter>\n",
            triple(position_m),
            rgb("intensity", intensity)
        ),
        Light::Spot {
            falloff: Some(Falloff::SmoothInCosine | Falloff::QuarticInCosine),
            ..
        } => {
            return Err("spots fall off linearly in the angle, and this one does not".to_owned());
        }
        Light::Spot {
            position_m,
            target_m,
            intensity,
            even_to_degrees,
            dark_from_degrees,
            ..
        } => {
            let axis = glam::DVec3::from(target_m) - glam::DVec3::from(position_m);
            let up = axis.normalize().any_orthonormal_vector().to_array();
            format!(
                "  <emitter type=\"spot\"><transform name=\"to_world\"><lookat origin=\"{}\" target=\"{}\" up=\"{}\"/></transform>\
                 {}{}{}</emitter>\n",
                triple(position_m),
                triple(target_m),
                triple(up),
                rgb("intensity", intensity),
                float("beam_width", even_to_degrees),
                float("cutoff_angle", dark_from_degrees)
            )
        }
        Light::Sun {
            direction,
            irradiance,
        } => format!(
            "  <emitter type=\"directional\"><vector name=\"direction\" value=\"{}\"/>{}</emitter>\n",
            triple(direction),
            rgb("irradiance", irradiance)
        ),
    })
}

/// The plugin for a map: there +y is the zenith, and columns begin at −z and go on toward +x.
fn environment(map: &Sky, file: &str) -> String {
    let Sky::Map {
        zenith, meridian, ..
    } = map
    else {
        return String::new();
    };
    let (up, first) = (glam::DVec3::from(*zenith), glam::DVec3::from(*meridian));
    let columns = [-up.cross(first), up, -first];
    let row = |i: usize| columns.map(|column| number(column[i])).join(" ") + " 0 ";
    format!(
        "  <emitter type=\"envmap\"><string name=\"filename\" value=\"{file}\"/>\
         <transform name=\"to_world\"><matrix value=\"{}0 0 0 1\"/></transform></emitter>\n",
        [0, 1, 2].map(row).concat()
    )
}

/// A map as a portable float map, whose last row comes first. Columns go the other way round there.
fn pfm(map: &Sky) -> Result<Vec<u8>, String> {
    let Sky::Map {
        interpolation: Interpolation::RowsToPoles,
        rows,
        columns,
        radiance,
        ..
    } = map
    else {
        return Err(
            "environment maps are bilinear, with rows at the poles, and this sky is not".to_owned(),
        );
    };
    let mut bytes = format!("PF\n{columns} {rows}\n-1.0\n").into_bytes();
    for row in radiance.chunks(*columns as usize).rev() {
        for value in row.iter().rev() {
            bytes.extend((*value as f32).to_le_bytes().repeat(3));
        }
    }
    Ok(bytes)
}

/// Triangles as OBJ.
fn obj(positions: &[Triple], triangles: &[[u32; 3]]) -> String {
    let mut text = String::new();
    for [x, y, z] in positions {
        let _ = writeln!(text, "v {x:?} {y:?} {z:?}");
    }
    for [a, b, c] in triangles {
        let _ = writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1);
    }
    text
}
