//! Other names and defaults of Mitsuba 0.6.
//!
//! Names here are underscored already. Unchanged parameters are not listed; those without effect are in
//! [`etalon_params::ignored`], and refused ones in [`etalon_params::unbuilt`].

use super::draft::{DraftObject, DraftProperty, DraftValue};
use super::reader::Reader;
use etalon_params::{Class, DMat4, Diagnostic, Spanned, Value};
use glam::DVec4;

/// Parameters that have another name today, with the plugins they belong to.
const RENAMED: [(Class, &[&str], &str, &str); 12] = [
    (
        Class::Bsdf,
        &["diffuse", "roughdiffuse"],
        "diffuse_reflectance",
        "reflectance",
    ),
    (
        Class::Integrator,
        &["ppm", "sppm"],
        "photon_count",
        "photons",
    ),
    (
        Class::Integrator,
        &["ppm", "sppm"],
        "initial_radius",
        "radius",
    ),
    (Class::Integrator, &["pssmlt"], "p_large", "large_step"),
    (
        Class::Integrator,
        &["pssmlt"],
        "luminance_samples",
        "bootstrap_samples",
    ),
    (
        Class::Integrator,
        &["pssmlt"],
        "mutation_size_low",
        "smallest_step",
    ),
    (
        Class::Integrator,
        &["pssmlt"],
        "mutation_size_high",
        "largest_step",
    ),
    (Class::Medium, &["heterogeneous"], "density", "sigma_t"),
    (Class::Shape, &["heightfield"], "scale", "height"),
    (
        Class::Shape,
        &["heightfield"],
        "shading_normals",
        "face_normals",
    ),
    (Class::Subsurface, &["adipole"], "D", "moments"),
    (
        Class::Subsurface,
        &["adipole"],
        "sigma_tn",
        "normal_extinction",
    ),
];

/// What a medium may be given by.
const COEFFICIENTS: [&str; 5] = ["material", "sigma_a", "sigma_s", "sigma_t", "albedo"];

/// The aperture of the sun (°).
const SUN: f64 = 0.5358;

/// Gives an object of Mitsuba 0.6 the parameters that mean the same today. Where there are none, what to say of that.
pub(crate) fn upgrade(object: &mut DraftObject) -> Option<Diagnostic> {
    let class = object.class;
    let plugin = object.plugin.value.clone();
    if (class, plugin.as_str()) == (Class::Shape, "heightfield") {
        // How finely a texture was to be looked up; a picture has its own pixels.
        let is_size = |p: &DraftProperty| {
            ["width", "height"].contains(&p.name.as_str()) && integer(p).is_some()
        };
        object.properties.retain(|property| !is_size(property));
    }
    for property in &mut object.properties {
        let is_it = |(of, plugins, old, _): &&(Class, &[&str], &str, &str)| {
            *of == class && plugins.contains(&plugin.as_str()) && *old == property.name
        };
        if let Some((.., today)) = RENAMED.iter().find(is_it) {
            property.name = (*today).into();
        }
    }
    match (class, plugin.as_str()) {
        (Class::Emitter, "sunsky" | "sky" | "sun") => {
            let missing = match plugin.as_str() {
                "sky" => Some("sun_scale"),
                "sun" => Some("sky_scale"),
                _ => None,
            };
            if let Some(missing) = missing {
                object.plugin.value = "sunsky".into();
                add_default(object, missing, Value::Float(0.0));
            }
            sun_and_sky(object);
        }
        (Class::Integrator, "ppm" | "sppm") => {
            // 0 asked for the width of some pixels, as the default does.
            object
                .properties
                .retain(|p| p.name != "radius" || number(p) != Some(0.0));
        }
        (Class::Integrator, "pssmlt") => {
            for property in &mut object.properties {
                if property.name == "direct_samples" && number(property) < Some(0.0) {
                    replace(property, "separate_direct", Value::Boolean(false));
                }
            }
        }
        (Class::Integrator, "ao") => {
            for property in &mut object.properties {
                if property.name == "ray_length" && number(property) > Some(0.0) {
                    property.name = "distance".into();
                }
            }
            let by_scene = |p: &DraftProperty| p.name == "ray_length" && number(p) < Some(0.0);
            object.properties.retain(|property| !by_scene(property));
            if !has_any(object, &["distance"]) {
                let message = "rays of `ao` are not limited, where Mitsuba 0.6 ends them after half the radius of the scene's bounding sphere";
                let diagnostic = Diagnostic::note(object.plugin.span, message);
                return Some(diagnostic.help("give `rayLength`, a number above 0"));
            }
        }
        (Class::Shape, "heightfield") => {
            for property in &mut object.properties {
                if let ("face_normals", DraftValue::Plain(Value::Boolean(smooth))) =
                    (property.name.as_str(), &mut property.value)
                {
                    *smooth = !*smooth;
                }
            }
            add_default(object, "raw", Value::Boolean(false));
        }
        (Class::Volume, "gridvolume") => grid(object),
        (Class::Bsdf, "conductor" | "roughconductor")
            if !has_any(object, &["material", "eta", "k"]) =>
        {
            add_default(object, "material", Value::String("Cu".into()));
        }
        (Class::Medium, "homogeneous")
        | (Class::Subsurface, "dipole" | "multidipole" | "adipole")
            if !has_any(object, &COEFFICIENTS) =>
        {
            add_default(object, "material", Value::String("skin1".into()));
        }
        _ => {}
    }
    None
}

/// Shapes without a material that bound a medium were invisible, not grey. What they contain is known once references are resolved.
pub(crate) fn invisible_surfaces(reader: &mut Reader<'_>) {
    let objects = &reader.draft.objects;
    let has = |object: &DraftObject, class: Class| {
        let children = object.properties.iter();
        children.into_iter().any(|property| match property.value {
            DraftValue::Object(child) => objects[child].class == class,
            _ => false,
        })
    };
    let is_invisible = |object: &DraftObject| {
        object.class == Class::Shape
            && reader.old_files.contains(&object.span.file)
            && has(object, Class::Medium)
            && ![Class::Bsdf, Class::Emitter, Class::Subsurface]
                .into_iter()
                .any(|class| has(object, class))
    };
    let found = (0..objects.len()).filter(|&id| is_invisible(&objects[id]));
    for id in found.collect::<Vec<_>>() {
        let shape = &reader.draft.objects[id];
        let (plugin, span) = (shape.plugin.span, shape.span);
        let material = reader.draft.objects.len();
        reader.draft.objects.push(DraftObject {
            class: Class::Bsdf,
            plugin: Spanned {
                value: "null".into(),
                span: plugin,
            },
            id: None,
            span,
            properties: Vec::new(),
        });
        reader.draft.objects[id].properties.push(DraftProperty {
            name: String::new(),
            name_span: plugin,
            value: DraftValue::Object(material),
            span: plugin,
            excused: false,
        });
    }
}

/// `scale` was the default of `sun_scale` and `sky_scale`; `sun_radius_scale` a factor on the aperture of the sun, whose power
/// stays the same.
fn sun_and_sky(object: &mut DraftObject) {
    let scale = object.properties.iter().position(|p| p.name == "scale");
    if let Some(scale) = scale.map(|at| object.properties.remove(at)) {
        for name in ["sun_scale", "sky_scale"] {
            if !has_any(object, &[name]) {
                let name = name.to_owned();
                object.properties.push(DraftProperty {
                    name,
                    ..scale.clone()
                });
            }
        }
    }
    for property in &mut object.properties {
        if property.name == "sun_radius_scale"
            && let Some(factor) = number(property).filter(|factor| *factor > 0.0)
        {
            replace(property, "sun_aperture", Value::Float(SUN * factor));
        }
    }
    add_default(object, "albedo", Value::Float(0.15));
    place(object, SKY);
}

/// From the sky of today, where z is up, x south and y west, to that of 0.6, where y was up, z south and x east.
const SKY: DMat4 = DMat4::from_cols(DVec4::Z, DVec4::NEG_X, DVec4::Y, DVec4::W);

/// Places what an object is in its own space by `first`, before `to_world`.
fn place(object: &mut DraftObject, first: DMat4) {
    add_default(object, "to_world", Value::Transform(DMat4::IDENTITY));
    for property in &mut object.properties {
        if let ("to_world", DraftValue::Plain(Value::Transform(to_world))) =
            (property.name.as_str(), &mut property.value)
        {
            *to_world *= first;
        }
    }
}

/// A grid lay in the box of its file, or in that of `min` and `max`.
fn grid(object: &mut DraftObject) {
    let corner = |name: &str| {
        let property = object.properties.iter().find(|p| p.name == name)?;
        match property.value {
            DraftValue::Plain(Value::Vector(corner)) => Some(corner),
            _ => None,
        }
    };
    let Some((min, max)) = corner("min").zip(corner("max")) else {
        add_default(object, "use_grid_bbox", Value::Boolean(true));
        return;
    };
    add_default(object, "use_grid_bbox", Value::Boolean(false));
    let in_box = DMat4::from_translation(min) * DMat4::from_scale(max - min);
    place(object, in_box);
    object
        .properties
        .retain(|p| !["min", "max"].contains(&p.name.as_str()));
}

fn has_any(object: &DraftObject, names: &[&str]) -> bool {
    object
        .properties
        .iter()
        .any(|p| names.contains(&p.name.as_str()))
}

/// Adds a parameter that is not given.
fn add_default(object: &mut DraftObject, name: &str, value: Value) {
    if !has_any(object, &[name]) {
        let span = object.plugin.span;
        object.properties.push(DraftProperty {
            name: name.into(),
            name_span: span,
            value: DraftValue::Plain(value),
            span,
            excused: false,
        });
    }
}

fn replace(property: &mut DraftProperty, name: &str, value: Value) {
    property.name = name.into();
    property.value = DraftValue::Plain(value);
}

fn number(property: &DraftProperty) -> Option<f64> {
    match property.value {
        DraftValue::Plain(Value::Float(x)) => Some(x),
        _ => integer(property).map(|i| i as f64),
    }
}

fn integer(property: &DraftProperty) -> Option<i64> {
    match property.value {
        DraftValue::Plain(Value::Integer(i)) => Some(i),
        _ => None,
    }
}
