//! Bad sensors are refused with one message each.

use super::*;

#[test]
fn mistakes_are_refused() {
    let scaled = DMat4::from_scale(DVec3::splat(2.0));
    let flat = DMat4::from_scale(DVec3::new(1.0, 1.0, 0.0));
    for (plugin, properties, expected) in [
        ("perspective", vec![number("fov", 180.0)], "cannot be 180"),
        ("perspective", vec![number("fov", -1.0)], "cannot be -1"),
        ("perspective", vec![word("fov_axis", "y")], "without `fov`"),
        (
            "perspective",
            vec![number("fov", 50.0), word("fov_axis", "z")],
            "not a value of `fov_axis`",
        ),
        (
            "perspective",
            vec![number("fov", 50.0), word("focal_length", "5mm")],
            "not both",
        ),
        (
            "perspective",
            vec![word("focal_length", "0mm")],
            "cannot be `0mm`",
        ),
        ("perspective", vec![number("near_clip", 0.0)], "cannot be 0"),
        (
            "perspective",
            vec![number("far_clip", 0.001)],
            "cannot be 0.001",
        ),
        ("perspective", vec![placed(scaled)], "scale or shear"),
        ("orthographic", vec![placed(flat)], "cannot be inverted"),
        ("thinlens", vec![], "needs the parameter `aperture_radius`"),
        (
            "thinlens",
            vec![number("aperture_radius", -1.0)],
            "cannot be -1",
        ),
        (
            "thinlens",
            vec![
                number("aperture_radius", 1.0),
                number("focus_distance", 0.0),
            ],
            "cannot be 0",
        ),
        (
            "perspective",
            vec![number("shutter_open", 1.0)],
            "shutter_close",
        ),
        (
            "perspective",
            vec![number("rolling_shutter_duration", 1.5)],
            "cannot be 1.5",
        ),
        (
            "perspective",
            vec![word("rolling_shutter_type", "bottom")],
            "`bottom` is not a value",
        ),
        (
            "perspective",
            vec![number("fow", 1.0)],
            "no parameter `fow`",
        ),
        ("distant", vec![], "its film has 40 × 30 pixels"),
        ("flat_sensor", vec![], "not built yet"),
        ("fish", vec![], "unknown sensor plugin"),
        ("fisheye", vec![number("fov", 361.0)], "cannot be 361"),
        (
            "fisheye",
            vec![number("fov", 181.0), word("mapping", "orthographic")],
            "cannot be 181",
        ),
        (
            "spherical",
            vec![word("mapping", "mercator")],
            "not a value of `mapping`",
        ),
        ("spherical", vec![placed(scaled)], "scale or shear"),
        ("irradiancemeter", vec![], "must be the child of a shape"),
        (
            "irradiancemeter",
            vec![placed(look_at())],
            "is where its shape is",
        ),
        ("batch", vec![], "needs sensors inside"),
    ] {
        let (_, messages) = read(plugin, &properties, FILM);
        assert!(
            matches!(&messages[..], [message] if message.contains(expected)),
            "{plugin} {expected}: {messages:?}"
        );
    }
}
