//! Scenes of Mitsuba 0.x, read as Mitsuba 3 reads them.
//!
//! Files of a version before 2.0 write names in camel case (`toWorld`, `intIOR`); they become
//! underscored. `diffuse` called its reflectance `diffuseReflectance`, and textures had
//! `uoffset`, `voffset`, `uscale` and `vscale` where they now have `to_uv`, a scale after a
//! translation.

use super::draft::{DraftObject, DraftProperty, DraftValue};
use etalon_params::{DMat4, DVec3, Value};

/// The version of a scene file.
pub(crate) type Version = [u32; 3];

/// A version as the files write it: three numbers with points between them.
pub(crate) fn version(text: &str) -> Option<Version> {
    let mut numbers = text.trim().split('.').map(str::parse::<u32>);
    let mut next = || numbers.next().and_then(Result::ok);
    let version = [next()?, next()?, next()?];
    numbers.next().is_none().then_some(version)
}

/// Whether the names of a file have to be upgraded.
pub(crate) fn is_old(version: Version) -> bool {
    version < [2, 0, 0]
}

/// `toWorld` → `to_world`, `intIOR` → `int_ior`.
fn underscored(name: &str) -> String {
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

/// Upgrades the properties of an object of an old file.
pub(crate) fn upgrade(object: &mut DraftObject) {
    for property in &mut object.properties {
        property.name = underscored(&property.name);
        if object.plugin.value == "diffuse" && property.name == "diffuse_reflectance" {
            property.name = "reflectance".into();
        }
    }
    upgrade_uv(&mut object.properties);
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

    #[test]
    fn versions_are_three_numbers() {
        assert_eq!(version("3.0.0"), Some([3, 0, 0]));
        assert_eq!(version("0.6.0"), Some([0, 6, 0]));
        for text in ["", "3", "3.0", "3.0.0.0", "x", "3.-1.0"] {
            assert_eq!(version(text), None, "{text}");
        }
        assert!(is_old([1, 9, 9]) && !is_old([2, 0, 0]));
    }
}
