//! Several sensors in one film.

use super::*;
use etalon_transport::Camera;

fn batch(width: u32, inside: &[(&str, &[(&str, Value)])]) -> (Option<AnyCamera>, Vec<String>) {
    let sensors: Vec<_> = (inside.iter())
        .map(|(plugin, properties)| ("", Value::Object(Arc::new(node(plugin, properties)))))
        .collect();
    let window = FilmWindow::whole(UVec2::new(width, 32));
    read_node(&node("batch", &sensors), window, None)
}

/// Mitsuba 3.9.1's `sensor.sample_ray` for two pinhole cameras in a film of 64 × 32 pixels: each has a square view, whatever its own film.
#[test]
fn views_stand_side_by_side_as_in_mitsuba() {
    let aside = DMat4::from_translation(DVec3::new(5.0, 0.0, 0.0));
    let (left, right) = ([number("fov", 60.0)], [number("fov", 40.0), placed(aside)]);
    let (camera, messages) = batch(64, &[("perspective", &left), ("perspective", &right)]);
    assert!(messages.is_empty(), "{messages:?}");
    let camera = camera.expect("a batch");
    for (place, origin, direction) in [
        (
            [0.1, 0.2],
            [0.003_464_1, 0.003_464_1, 0.01],
            [0.311_086, 0.311_086, 0.898_026],
        ),
        (
            [0.6, 0.3],
            [5.002_18, 0.001_455_88, 0.01],
            [0.211_228, 0.140_819, 0.967_24],
        ),
        (
            [0.999, 0.001],
            [4.996_38, 0.003_632_42, 0.01],
            [-0.322_523, 0.323_171, 0.889_685],
        ),
    ] {
        let raster = Vec2::from(place) * Vec2::new(64.0, 32.0);
        let ray = camera.ray(raster, Vec2::ZERO, 0.0).ray;
        assert!(ray.origin.distance(Vec3::from(origin)) < 1e-5, "{ray:?}");
        assert!(
            ray.direction.distance(Vec3::from(direction)) < 2e-6,
            "{ray:?}"
        );
    }
    assert!(!camera.can_connect() && !camera.is_meter());
}

#[test]
fn mistakes_of_batches_are_refused() {
    let (_, messages) = batch(64, &[("perspective", &[] as &[_]); 3]);
    assert!(
        messages[0].contains("64 pixels wide cannot be divided among 3"),
        "{messages:?}"
    );
    let (_, messages) = batch(64, &[("perspective", &[number("fow", 3.0)])]);
    assert!(messages[0].contains("no parameter `fow`"), "{messages:?}");
    let (_, messages) = batch(64, &[("radiancemeter", &[])]);
    assert!(
        messages[0].contains("its film has 64 × 32 pixels"),
        "{messages:?}"
    );
}
