//! No ray leaves a closed mesh: rays at vertices and edges from inside all hit.

use crate::things::{Random, geometry_of, icosphere, mesh_of};
use etalon_transport::Ray;
use glam::Vec3;

/// Shoots at every vertex and at points of every edge, from several points inside.
fn count_leaks(positions: &[Vec3], triangles: &[[u32; 3]], inside: &[Vec3]) -> (u32, u32) {
    let geometry = geometry_of([mesh_of(positions.to_vec(), triangles.to_vec())]);
    let mut random = Random(17);
    let (mut rays, mut leaks) = (0, 0);
    for &from in inside {
        let mut shoot = |target: Vec3| {
            let ray = Ray::new(from, (target - from).normalize(), 0.0);
            rays += 1;
            leaks += u32::from(geometry.intersect(&ray).is_none() || !geometry.occluded(&ray));
        };
        positions.iter().for_each(|&p| shoot(p));
        for triangle in triangles {
            let [a, b, c] = triangle.map(|i| positions[i as usize]);
            for (p, q) in [(a, b), (b, c), (c, a)] {
                shoot((p + q) * 0.5);
                shoot(p.lerp(q, random.number()));
            }
        }
    }
    (rays, leaks)
}

#[test]
fn spheres_do_not_leak() {
    for (scale, shift) in [
        (1.0, Vec3::ZERO),
        (1e-5, Vec3::ZERO),
        (2.0, Vec3::new(1000.0, -300.0, 70.0)),
    ] {
        let (positions, triangles) = icosphere(4);
        let positions: Vec<_> = positions.iter().map(|&p| p * scale + shift).collect();
        let mut random = Random(2);
        let inside: Vec<_> = (0..20)
            .map(|_| shift + random.point() * 0.5 * scale)
            .collect();
        let (rays, leaks) = count_leaks(&positions, &triangles, &inside);
        assert!(
            rays > 600_000 && leaks == 0,
            "{leaks} of {rays} rays leak at scale {scale}"
        );
    }
}

#[test]
fn boxes_do_not_leak() {
    // A box of 12 n² triangles with axis-parallel faces: rays along faces, edges, diagonals.
    for (half, shift) in [
        (1.0, Vec3::ZERO),
        (3e-5, Vec3::ZERO),
        (1.0, Vec3::splat(1000.0)),
    ] {
        let n = 12u32;
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for face in 0..6 {
            let (axis, side) = (face % 3, if face < 3 { -1.0 } else { 1.0 });
            let first = positions.len() as u32;
            for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
                // The same arithmetic on every face, so that edges meet exactly.
                let at = |i: u32| (2 * i) as f32 / n as f32 - 1.0;
                let mut p = [0.0; 3];
                p[axis] = side;
                p[(axis + 1) % 3] = at(i);
                p[(axis + 2) % 3] = at(j);
                positions.push(Vec3::from(p) * half + shift);
            }
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let at = |i: u32, j: u32| first + i * (n + 1) + j;
                triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
        let mut random = Random(4);
        let mut inside: Vec<_> = (0..10)
            .map(|_| shift + random.point() * 0.9 * half)
            .collect();
        // Points whose rays run along the planes of the lattice.
        inside.extend([
            shift,
            shift + Vec3::splat(0.5 * half),
            shift + Vec3::X * 0.5 * half,
        ]);
        let (rays, leaks) = count_leaks(&positions, &triangles, &inside);
        assert!(
            rays > 100_000 && leaks == 0,
            "{leaks} of {rays} rays leak at {half}, {shift}"
        );
    }
}

#[test]
fn needles_do_not_leak() {
    // A closed double fan of 5,000 slivers around an axis.
    let n = 5000u32;
    let mut positions = vec![Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.0, 0.0, -1.0)];
    for i in 0..n {
        let (sin, cos) = etalon_math::float::sin_cos_turns(i as f32 / n as f32);
        positions.push(Vec3::new(cos, sin, 0.0));
    }
    let triangles: Vec<_> = (0..n)
        .flat_map(|i| {
            let (a, b) = (2 + i, 2 + (i + 1) % n);
            [[0, a, b], [1, b, a]]
        })
        .collect();
    let inside = [
        Vec3::ZERO,
        Vec3::new(0.1, -0.2, 0.3),
        Vec3::new(0.0, 0.5, -0.2),
    ];
    let (rays, leaks) = count_leaks(&positions, &triangles, &inside);
    assert!(rays > 100_000 && leaks == 0, "{leaks} of {rays} rays leak");
}
