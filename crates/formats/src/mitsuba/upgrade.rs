//! Scenes of Mitsuba 0.x, read as Mitsuba 3 reads them.
//!
//! Files of a version before 2.0 write names in camel case (`toWorld`, `intIOR`); they become
//! underscored. Some had other names, see [`mitsuba06`], and textures had
//! `uoffset`, `voffset`, `uscale` and `vscale` where they now have `to_uv`, a scale after a
//! translation.
//!
//! Before 0.4, sensors were `<camera>`s whose x axis pointed the other way, emitters were
//! `<luminaire>`s, and some plugins and parameters had other names; they become what Mitsuba 0.6
//! made of them (its `data/schema/upgrade_*.xsl`).

use super::animation::Animation;
use super::draft::{DraftObject, DraftProperty, DraftValue};
use super::mitsuba06;
use super::version::{Version, is_ancient};
use etalon_params::{Class, DMat4, DVec3, Diagnostic, Value};
use glam::DMat3;

/// `toWorld` → `to_world`, `intIOR` → `int_ior`.
pub fn underscored(name: &str) -> String {
    let mut result = String::with_capacity(name.len() + 4);
    let mut previous = ' ';
    let mut in_capitals = false;
    for c in name.chars() {
        in_capitals = c.is_ascii_uppercase() && (in_capitals || previous.is_ascii_lowercase());
        if in_capitals {
            if previous.is_ascii_lowercase() {
                result.push('_');
            }
            result.push(c.to_ascii_lowercase());
        } else {
            result.push(c);
        }
        previous = c;
    }
    result
}

/// Names of plugins before 0.4, and what they became.
const PLUGINS: [(&str, &str); 9] = [
    ("composite", "mixturebsdf"),
    ("exrfilm", "hdrfilm"),
    ("exrtexture", "bitmap"),
    ("lambertian", "diffuse"),
    ("ldrtexture", "bitmap"),
    ("mixture", "mixturebsdf"),
    ("pngfilm", "ldrfilm"),
    ("roughglass", "roughdielectric"),
    ("roughmetal", "roughconductor"),
];

/// Names of parameters before 0.4 with the class and plugin they belong to (`""`: any).
const PARAMETERS: [(Class, &str, &str, &str); 13] = [
    (Class::Bsdf, "roughdielectric", "alpha_b", "alpha"),
    (Class::Bsdf, "roughconductor", "alpha_b", "alpha"),
    (Class::Emitter, "", "intensity_scale", "scale"),
    (Class::Emitter, "area", "intensity", "radiance"),
    (Class::Emitter, "constant", "intensity", "radiance"),
    (Class::Emitter, "directional", "intensity", "irradiance"),
    (
        Class::Integrator,
        "",
        "luminaire_samples",
        "emitter_samples",
    ),
    (Class::Sensor, "", "focus_depth", "focus_distance"),
    (Class::Shape, "sphere", "inverted", "flip_normals"),
    (Class::Texture, "checkerboard", "bright_color", "color0"),
    (Class::Texture, "checkerboard", "dark_color", "color1"),
    (Class::Shape, "cylinder", "p1", "p0"),
    (Class::Shape, "cylinder", "p2", "p1"),
];

/// What a tag of an old file is called today.
pub(crate) fn tag(version: Version, name: &str) -> &str {
    match name {
        "camera" if is_ancient(version) => "sensor",
        "luminaire" if is_ancient(version) => "emitter",
        name => name,
    }
}

/// Upgrades an object of an old file; what to say of it, if anything.
pub(crate) fn upgrade(object: &mut DraftObject, version: Version) -> Option<Diagnostic> {
    for property in &mut object.properties {
        property.name = underscored(&property.name);
    }
    if is_ancient(version) {
        upgrade_ancient(object, version);
    }
    upgrade_uv(&mut object.properties);
    mitsuba06::upgrade(object)
}

/// What changed with 0.3 and 0.4.
fn upgrade_ancient(object: &mut DraftObject, version: Version) {
    let plugin = &mut object.plugin.value;
    if let Some((_, today)) = PLUGINS.iter().find(|(old, _)| old == plugin) {
        *plugin = (*today).into();
    }
    for property in &mut object.properties {
        // The ends of cylinders were renamed with 0.3 already.
        let renamed = PARAMETERS.iter().find(|(class, of, old, _)| {
            *class == object.class
                && (of.is_empty() || of == plugin)
                && *old == property.name
                && (*of != "cylinder" || version < [0, 3, 0])
        });
        if let Some((_, _, _, today)) = renamed {
            property.name = (*today).into();
        }
        let replaced = match (&property.value, property.name.as_str()) {
            (DraftValue::Plain(Value::Boolean(smaller)), "map_smaller_side") => {
                let axis = if *smaller { "smaller" } else { "larger" };
                Some(("fov_axis", Value::String(axis.into())))
            }
            (DraftValue::Plain(Value::Boolean(alpha)), "alpha") if object.class == Class::Film => {
                let format = if *alpha { "rgba" } else { "rgb" };
                Some(("pixel_format", Value::String(format.into())))
            }
            (DraftValue::Plain(Value::Transform(to_world)), "to_world")
                if object.class == Class::Sensor =>
            {
                let mirror = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
                Some(("to_world", Value::Transform(*to_world * mirror)))
            }
            (DraftValue::Animation(Animation::Moving(motion)), "to_world")
                if object.class == Class::Sensor =>
            {
                let mirror = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
                property.value =
                    DraftValue::Animation(Animation::Moving(motion.after(mirror).into()));
                None
            }
            _ => None,
        };
        if let Some((name, value)) = replaced {
            property.name = name.into();
            property.value = DraftValue::Plain(value);
        }
    }
}

fn upgrade_uv(properties: &mut Vec<DraftProperty>) {
    let mut offset = DVec3::ZERO;
    let mut scale = DVec3::ONE;
    let mut first = None;
    properties.retain(|property| {
        let target = match property.name.as_str() {
            "uoffset" => &mut offset.x,
            "voffset" => &mut offset.y,
            "uscale" => &mut scale.x,
            "vscale" => &mut scale.y,
            _ => return true,
        };
        match property.value {
            DraftValue::Plain(Value::Float(x)) => *target = x,
            DraftValue::Plain(Value::Integer(i)) => *target = i as f64,
            _ => return true,
        }
        first.get_or_insert((property.name_span, property.span));
        false
    });
    if let Some((name_span, span)) = first {
        let to_uv = DMat4::from_scale(scale) * DMat4::from_translation(offset);
        properties.push(DraftProperty {
            name: "to_uv".into(),
            name_span,
            value: DraftValue::Plain(Value::Transform(to_uv)),
            span,
            excused: false,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_underscored_as_in_mitsuba() {
        for (old, new) in [
            ("toWorld", "to_world"),
            ("intIOR", "int_ior"),
            ("fovAxis", "fov_axis"),
            ("diffuseReflectance", "diffuse_reflectance"),
            ("sigmaT", "sigma_t"),
            ("already_new", "already_new"),
            ("IOR", "IOR"),
            ("maxDepth2X", "max_depth2X"),
        ] {
            assert_eq!(underscored(old), new);
        }
    }
}
