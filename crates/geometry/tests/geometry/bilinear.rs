//! Bilinear patches against fine nets of triangles.

use crate::description::make;
use crate::things::{Random, geometry_of, mesh_of};
use etalon_params::{DVec3, Value};
use etalon_transport::Ray;
use glam::Vec3;

/// Corners p00, p10, p01, p11.
type Corners = [Vec3; 4];

fn at(corners: &Corners, u: f32, v: f32) -> Vec3 {
    let [a, b, c, d] = *corners;
    a.lerp(b, u).lerp(c.lerp(d, u), v)
}

/// The patch as 2·N² triangles.
fn net(corners: &Corners, n: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let part = |i: u32| i as f32 / n as f32;
    let places = (0..=n).flat_map(|j| (0..=n).map(move |i| (i, j)));
    let positions = places.map(|(i, j)| at(corners, part(i), part(j))).collect();
    let cells = (0..n).flat_map(|j| (0..n).map(move |i| j * (n + 1) + i));
    let triangles = cells.flat_map(|k| [[k, k + 1, k + n + 2], [k, k + n + 2, k + n + 1]]);
    (positions, triangles.collect())
}

#[test]
fn patches_are_their_nets() {
    let mut random = Random(9);
    let flat = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)];
    let mut cases: Vec<Corners> = vec![flat];
    for _ in 0..12 {
        let bent = flat.map(|corner| corner + random.point() * 0.4);
        cases.push(bent);
    }
    for corners in cases {
        let names = ["p00", "p10", "p01", "p11"];
        let properties = names.iter().zip(corners);
        let properties = properties
            .map(|(name, p)| (*name, Value::Vector(DVec3::from(p.as_dvec3().to_array()))));
        let (shape, messages) = make("bilinear", properties.collect());
        let patch = geometry_of([shape.unwrap_or_else(|| panic!("{messages}"))]);
        let (positions, triangles) = net(&corners, 100);
        let net = geometry_of([mesh_of(positions, triangles)]);
        let mut hits = 0;
        for index in 0..4000 {
            let (u, v) = (random.number() * 1.2 - 0.1, random.number() * 1.2 - 0.1);
            let target = at(&corners, u, v);
            let from = match index % 3 {
                0 => target + [Vec3::X, -Vec3::Y, Vec3::Z][index / 3 % 3],
                _ => random.point() * 3.0,
            };
            let ray = Ray::new(from, (target - from).normalize(), 0.0);
            let slope = |d: Vec3| (at(&corners, u + d.x, v + d.y) - target) / 1e-2;
            let normal = slope(Vec3::X * 1e-2)
                .cross(slope(Vec3::Y * 1e-2))
                .normalize();
            if normal.dot(ray.direction).abs() < 1e-2 {
                continue; // Edge-on: rounding decides.
            }
            let (a, b) = (patch.intersect(&ray), net.intersect(&ray));
            assert_eq!(patch.occluded(&ray), a.is_some());
            let (Some(a), Some(b)) = (a, b) else {
                // Only at the border and where the net's chords miss a bend that the ray grazes.
                let border = u.min(v).min(1.0 - u).min(1.0 - v).abs() < 1e-2;
                let inside = u > 0.0 && u < 1.0 && v > 0.0 && v < 1.0;
                assert!(
                    a.is_some() || border || !inside,
                    "{ray:?} misses ({u}, {v})"
                );
                continue;
            };
            let vertex = patch.vertex(&ray, &a);
            let flat = net.vertex(&ray, &b);
            let uv = vertex.uv;
            let there = at(&corners, uv.x, uv.y);
            assert!((vertex.position - there).length() < 1e-5, "{ray:?}");
            let along = (at(&corners, uv.x + 0.01, uv.y) - there) * 100.0;
            assert!((vertex.dp_du - along).length() < 1e-2, "{}", vertex.dp_du);
            let grazing = flat.normal.dot(ray.direction).abs() < 0.1;
            if !grazing && (vertex.t - flat.t).abs() < 0.1 {
                assert!((vertex.t - flat.t).abs() < 1e-3, "{} {}", vertex.t, flat.t);
                assert!(vertex.normal.dot(flat.normal) > 0.99);
                hits += 1;
            }
            // It leaves the patch for good, or meets it once more.
            let again = patch.intersect(&vertex.spawn(ray.direction));
            assert!(again.is_none_or(|again| again.t > 1e-4), "{ray:?}");
        }
        assert!(hits > 1500, "{hits}");
    }
    let line = (0..4).map(|i| {
        (
            ["p00", "p10", "p01", "p11"][i],
            Value::Vector(DVec3::X * i as f64),
        )
    });
    assert!(
        make("bilinear", line.collect())
            .1
            .contains("not all in a line")
    );
}
