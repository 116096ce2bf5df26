//! Planes without end.

use crate::solids::{ball, built};
use crate::things::{Random, geometry_of};
use etalon_geometry::Placement;
use etalon_params::{DVec3, Value};
use etalon_transport::Ray;

/// A plane is a rectangle as large as it must be, also in a group, and takes nothing from the box of the rest.
#[test]
fn a_plane_is_a_large_rectangle() {
    let tilted = |size: f64| {
        let turned = etalon_params::DMat4::from_rotation_x(0.6);
        let scaled = etalon_params::DMat4::from_scale(DVec3::new(size, size, 1.0));
        vec![("to_world", Value::Transform(turned * scaled))]
    };
    let plane = geometry_of([ball(0.0, 0.0, 0.0, 0.5), built("plane", tilted(1.0))]);
    let large = geometry_of([ball(0.0, 0.0, 0.0, 0.5), built("rectangle", tilted(1e3))]);
    let mut builder = etalon_geometry::GeometryBuilder::new();
    let none = etalon_transport::MaterialId(0);
    let group = builder.add_group([(built("plane", Vec::new()), none)]);
    let turned = Placement::from_matrix(&etalon_params::DMat4::from_rotation_x(0.6));
    builder.add_instance(group, turned.expect("a rotation"));
    builder.add_shape(
        ball(0.0, 0.0, 0.0, 0.5),
        none,
        etalon_transport::LightId::NONE,
    );
    let grouped = builder.build();
    assert!(plane.is_endless() && grouped.is_endless() && !large.is_endless());
    for geometry in [&plane, &grouped] {
        let half = geometry.bounds().max - geometry.bounds().center();
        assert!((half - 0.5).abs().max_element() < 1e-5);
    }
    let mut random = Random(9);
    let mut hits = 0;
    for _ in 0..10_000 {
        let ray = Ray::new(random.point() * 3.0, random.direction(), 0.0);
        let Some(expected) = large.intersect(&ray) else {
            continue;
        };
        let expected = large.vertex(&ray, &expected);
        // Grazing rays err by more.
        if expected.normal.dot(ray.direction).abs() < 0.1 {
            continue;
        }
        hits += 1;
        for geometry in [&plane, &grouped] {
            let hit = geometry.intersect(&ray).expect("it is there");
            let vertex = geometry.vertex(&ray, &hit);
            let slack = expected.error.length() + 1e-5 * (1.0 + expected.position.length());
            assert!(
                (vertex.position - expected.position).length() < slack,
                "{ray:?}"
            );
            assert!(vertex.normal.dot(expected.normal) > 0.999);
            let before = Ray {
                t_max: 0.99 * hit.t,
                ..ray
            };
            let beyond = Ray {
                t_max: 1.01 * hit.t,
                ..ray
            };
            assert!(geometry.occluded(&beyond) && !geometry.occluded(&before));
        }
    }
    assert!(hits > 3000, "{hits}");
}
