//! Bad lights are refused with one message each.

use super::*;
use etalon_params::{DMat4, DVec3};

#[test]
fn mistakes_are_refused() {
    let number = |name, value| vec![(name, Value::Float(value))];
    let placed = |name, scale| {
        let matrix = Value::Transform(DMat4::from_scale(DVec3::from(scale)));
        vec![("to_world", matrix), (name, Value::Vector(DVec3::Z))]
    };
    let stretched = Value::Transform(DMat4::from_scale(DVec3::new(1.0, 2.0, 1.0)));
    let mut world = SmallWorld::default();
    world.shutter.close = 1.0;
    add_file(&mut world, "nan.pfm", 2, &[[f32::NAN; 3]; 6]);
    let file = |name: &str| vec![("filename", Value::String(name.into()))];
    for (plugin, properties, expected) in [
        ("point", placed("position", [1.0; 3]), "not both"),
        ("directional", placed("direction", [1.0; 3]), "not both"),
        (
            "directional",
            vec![("direction", Value::Vector(DVec3::ZERO))],
            "must not vanish",
        ),
        ("spot", vec![("to_world", stretched)], "scale uniformly"),
        ("spot", number("cutoff_angle", 181.0), "cannot be 181"),
        ("spot", number("beam_width", -1.0), "cannot be -1"),
        (
            "spot",
            vec![
                ("cutoff_angle", Value::Float(90.0)),
                ("texture", texture("bitmap")),
            ],
            "cannot be 90",
        ),
        (
            "point",
            vec![("intensity", texture("bitmap"))],
            "must be a spectrum",
        ),
        (
            "constant",
            vec![("radiance", texture("checkerboard"))],
            "must be a spectrum",
        ),
        ("constant", number("sampling_weight", -1.0), "cannot be -1"),
        (
            "constant",
            number("intensity", 1.0),
            "no parameter `intensity`",
        ),
        ("envmap", vec![], "needs the parameter `filename`"),
        ("envmap", file("none.exr"), "no file `none.exr`"),
        ("envmap", file("nan.pfm"), "column 0 of row 0"),
        ("timed_sunsky", number("hour", 12.0), "no parameter `hour`"),
        ("sunsky", number("turbidity", 0.5), "cannot be 0.5"),
        ("sunsky", number("hour", 25.0), "cannot be 25"),
        ("sun", vec![], "sun"),
    ] {
        let messages = read(&mut world, plugin, properties)
            .err()
            .unwrap_or_default();
        assert!(
            matches!(&messages[..], [message] if message.contains(expected)),
            "{plugin} {expected}: {messages:?}"
        );
    }
}

#[test]
fn lights_stand_where_they_belong() {
    let mut world = SmallWorld::default();
    for (plugin, shape, expected) in [
        ("area", None, "child of a shape"),
        ("point", Some(ShapeId(0)), "cannot be the child of a shape"),
    ] {
        let diagnostics = Diagnostics::new();
        let node = node(Class::Emitter, plugin, vec![]);
        let params = Params::new(&node, &diagnostics);
        assert!(LightDescription::from_params(&params, shape, &mut world).is_none());
        let messages = diagnostics.into_sorted();
        assert!(matches!(&messages[..], [m] if m.message.contains(expected)));
    }
}
