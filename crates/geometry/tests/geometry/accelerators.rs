//! Every accelerator against the linear scan: the same hits, to the last bit.

use crate::things::{Random, convex_shapes, icosphere, mesh_of, moved};
use etalon_geometry::{AcceleratorKind, Geometry, GeometryBuilder, Shape};
use etalon_transport::{Hit, LightId, MaterialId, Ray};
use glam::Vec3;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// The same geometry with every accelerator, the linear scan's first.
pub(crate) fn every(make: impl Fn(&mut GeometryBuilder)) -> Vec<Geometry> {
    let kinds = AcceleratorKind::ALL.into_iter();
    let geometries = kinds.map(|kind| {
        let mut builder = GeometryBuilder::new();
        make(&mut builder);
        builder.build_with(kind)
    });
    geometries.collect()
}

fn every_of(shapes: impl Fn() -> Vec<Shape>) -> Vec<Geometry> {
    every(|builder| {
        for shape in shapes() {
            builder.add_shape(shape, MaterialId(0), LightId::NONE);
        }
    })
}

/// A hit without where the accelerator keeps the primitive, which is its own affair.
fn placeless(hit: Option<Hit>) -> Option<Hit> {
    hit.map(|hit| Hit { slot: 0, ..hit })
}

/// Hits of a ray and of the segment up to its hit agree, and the points hit. Returns whether there
/// was one.
pub(crate) fn agree(all: &[Geometry], ray: &Ray) -> bool {
    let linear = &all[0];
    let expected = linear.intersect(ray);
    assert_eq!(linear.occluded(ray), expected.is_some(), "{ray:?}");
    for (geometry, kind) in all.iter().zip(AcceleratorKind::ALL).skip(1) {
        let found = geometry.intersect(ray);
        assert_eq!(placeless(expected), placeless(found), "{kind:?} {ray:?}");
        if let (Some(expected), Some(found)) = (expected, found) {
            let [a, b] = [linear.vertex(ray, &expected), geometry.vertex(ray, &found)];
            assert_eq!((a.position, a.normal), (b.position, b.normal), "{ray:?}");
        }
        assert_eq!(
            linear.occluded(ray),
            geometry.occluded(ray),
            "{kind:?} {ray:?}"
        );
        if let Some(hit) = expected {
            // A segment that ends exactly at the hit does not reach it.
            let short = Ray {
                t_max: hit.t,
                ..*ray
            };
            assert_eq!(
                placeless(linear.intersect(&short)),
                placeless(geometry.intersect(&short)),
                "{kind:?} {short:?}"
            );
            assert_eq!(
                linear.occluded(&short),
                geometry.occluded(&short),
                "{short:?}"
            );
        }
    }
    expected.is_some()
}

/// Random triangles; every fifth without area, every seventh a copy of the one before.
pub(crate) fn soup(seed: u64, count: usize, size: f32, scale: f32, center: Vec3) -> Shape {
    let mut random = Random(seed);
    let mut positions: Vec<Vec3> = Vec::new();
    for i in 0..count {
        let at = random.point();
        let mut corners = [at; 3].map(|p| center + (p + random.point() * size) * scale);
        if i % 5 == 4 {
            corners[2] = corners[0];
        }
        if i % 7 == 6 {
            let from = positions.len() - 3;
            corners.copy_from_slice(&positions[from..]);
        }
        positions.extend(corners);
    }
    let triangles = (0..count as u32)
        .map(|i| [3 * i, 3 * i + 1, 3 * i + 2])
        .collect();
    mesh_of(positions, triangles)
}

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(0x7ab1e),
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(config(48))]

    #[test]
    fn soups(
        seed in any::<u64>(),
        count in 1usize..400,
        size in 0.01f32..1.0,
        exponent in -12i32..12,
        far in 0usize..3,
    ) {
        let scale = 10f32.powi(exponent);
        // Up to a thousand of its own sizes away from the origin of space.
        let center = Vec3::new(1.0, -0.5, 0.25) * scale * [0.0, 30.0, 1000.0][far];
        let pair = every_of(|| vec![soup(seed, count, size, scale, center)]);
        let mut random = Random(seed ^ 1);
        for i in 0..300 {
            // From inside, from near, from far.
            let reach = [1.0, 4.0, 3e4][i % 3];
            let from = center + random.direction() * reach * scale;
            let to = center + random.point() * scale;
            let Some(direction) = (to - from).try_normalize() else { continue };
            agree(&pair, &Ray::new(from, direction, 0.0));
        }
    }
}

/// A square grid of triangles in each of three planes, with all coordinates small integers.
pub(crate) fn lattice() -> Shape {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for plane in 0..3 {
        for (i, j) in (0..8).flat_map(|i| (0..8).map(move |j| (i, j))) {
            let corner = |a: i32, b: i32| {
                let mut p = [0.0; 3];
                p[plane] = 4.0;
                p[(plane + 1) % 3] = a as f32;
                p[(plane + 2) % 3] = b as f32;
                Vec3::from(p)
            };
            let first = positions.len() as u32;
            positions.extend([
                corner(i, j),
                corner(i + 1, j),
                corner(i + 1, j + 1),
                corner(i, j + 1),
            ]);
            triangles.extend([[0, 1, 2], [0, 2, 3]].map(|t| t.map(|k: u32| k + first)));
        }
    }
    mesh_of(positions, triangles)
}

#[test]
fn rays_along_axes_and_in_planes() {
    let pair = every_of(|| vec![lattice()]);
    let mut hits = 0;
    for axis in 0..3 {
        for sign in [1.0f32, -1.0] {
            for zeros in 0..4 {
                let mut d = [if zeros & 1 == 0 { 0.0 } else { -0.0 }; 3];
                d[(axis + 1) % 3] = if zeros & 2 == 0 { 0.0 } else { -0.0 };
                d[axis] = sign;
                for i in -2..=20 {
                    for j in -2..=20 {
                        // On vertices, on edges, within faces, within the planes themselves.
                        let mut o = [0.0; 3];
                        o[axis] = -sign * 20.0;
                        o[(axis + 1) % 3] = i as f32 * 0.5;
                        o[(axis + 2) % 3] = j as f32 * 0.5;
                        let ray = Ray::new(o.into(), d.into(), 0.0);
                        let hit = agree(&pair, &ray);
                        let inside = (0..=16).contains(&i) && (0..=16).contains(&j);
                        assert!(hit || !inside, "{ray:?} leaks");
                        hits += u32::from(hit);
                    }
                }
            }
        }
    }
    assert!(hits >= 6 * 4 * 17 * 17, "{hits}");
}

#[test]
fn diagonals_through_vertices_and_edges() {
    let pair = every_of(|| vec![lattice()]);
    for i in -8..16 {
        for j in -8..16 {
            for d in [
                Vec3::ONE,
                Vec3::new(1.0, 1.0, 0.0),
                Vec3::new(1.0, -1.0, 0.5),
            ] {
                let o = Vec3::new(-6.0, i as f32, j as f32);
                agree(&pair, &Ray::new(o, d.normalize(), 0.0));
            }
        }
    }
}

#[test]
fn of_equal_hits_the_first_primitive_wins() {
    // Twelve copies of one triangle in two meshes, the same rectangle twice.
    let copies = |count: u32| {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y].repeat(count as usize);
        mesh_of(
            positions,
            (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        )
    };
    let pair = every_of(|| vec![copies(5), copies(7)]);
    let ray = Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z, 0.0);
    assert!(agree(&pair, &ray));
    let hit = pair[1].intersect(&ray).expect("hit");
    assert_eq!((hit.shape.0, hit.primitive), (0, 0));
}

#[test]
fn many_equal_boxes_do_not_take_long() {
    // Clustering them one by one would be quadratic: minutes.
    let count = 200_000u32;
    let mut random = Random(3);
    let make = |count: u32, random: &mut Random| {
        let mut positions = [Vec3::ZERO, Vec3::X, Vec3::Y].repeat(count as usize);
        for i in 0..count / 10 {
            let at = 30 * i as usize;
            let shift = random.point() * 5.0;
            positions[at..at + 3].iter_mut().for_each(|p| *p += shift);
        }
        (
            positions,
            (0..count)
                .map(|i| [3 * i, 3 * i + 1, 3 * i + 2])
                .collect::<Vec<_>>(),
        )
    };
    let (positions, triangles) = make(count, &mut random);
    let pair = every_of(|| vec![mesh_of(positions.clone(), triangles.clone())]);
    for _ in 0..20 {
        let (from, to) = (random.point() * 8.0, random.point());
        agree(&pair, &Ray::new(from, (to - from).normalize(), 0.0));
    }
}

#[test]
fn lopsided_trees_are_no_deeper_than_the_stack() {
    // Each triangle is ten times as large as the one before, from 1e-18 to 1e18, many times.
    let mut positions = Vec::new();
    for i in 0..2000u32 {
        let size = power_of_ten(i % 37);
        let shift = Vec3::splat(size * (1.0 + 1e-3 * (i / 37) as f32));
        positions.extend([Vec3::ZERO, Vec3::X * size, Vec3::Y * size].map(|p| p + shift));
    }
    let triangles: Vec<_> = (0..2000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let pair = every_of(|| vec![mesh_of(positions.clone(), triangles.clone())]);
    let mut random = Random(8);
    for i in 0..400 {
        let size = power_of_ten(i % 37);
        let from = Vec3::new(1.2, 1.3, 3.0) * size;
        let direction = (Vec3::new(1.1, 1.2, 1.0) * size - from).normalize();
        agree(
            &pair,
            &Ray::new(from + random.point() * size * 0.1, direction, 0.0),
        );
    }
}

/// 10^(n − 18).
fn power_of_ten(n: u32) -> f32 {
    10f32.powi(n as i32 - 18)
}

/// Everything at once: smooth shapes, meshes, instances, overlapping.
pub(crate) fn mixture(builder: &mut GeometryBuilder) {
    let mut random = Random(11);
    for i in 0..6 {
        for (_, shape) in convex_shapes(random.point() * 4.0, f64::from(i), 0.3 + random.number()) {
            builder.add_shape(shape, MaterialId(i), LightId::NONE);
        }
    }
    let (positions, triangles) = icosphere(2);
    let group = builder.add_group(
        convex_shapes(Vec3::ZERO, 0.4, 0.8)
            .into_iter()
            .map(|(_, shape)| (shape, MaterialId(9)))
            .chain([(mesh_of(positions, triangles), MaterialId(10))]),
    );
    for i in 0..40 {
        let scale = Vec3::new(0.2, 0.5, 0.3) + random.point().abs();
        let placement = moved(
            random.point() * 5.0,
            f64::from(i),
            scale * if i % 3 == 0 { -1.0 } else { 1.0 },
        );
        builder.add_instance(group, placement);
        if i % 10 == 0 {
            builder.add_instance(group, placement);
        }
    }
}

#[test]
fn mixtures_of_shapes_and_instances() {
    let pair = every(mixture);
    let mut random = Random(5);
    let mut hits = 0;
    for _ in 0..3000 {
        let from = random.point() * 6.0;
        let ray = Ray::new(from, random.direction(), 0.0);
        hits += u32::from(agree(&pair, &ray));
        // And onward from the surface, on either side.
        if let Some(hit) = pair[0].intersect(&ray) {
            let vertex = pair[0].vertex(&ray, &hit);
            agree(&pair, &vertex.spawn(random.direction()));
        }
    }
    assert!(hits > 500, "{hits}");
}

#[test]
fn nothing_is_hit_where_nothing_is() {
    let pair = every_of(Vec::new);
    assert!(!agree(&pair, &Ray::new(Vec3::ZERO, Vec3::X, 0.0)));
    assert!(pair[1].bounds().is_empty());
    let pair = every_of(|| vec![mesh_of(Vec::new(), Vec::new())]);
    assert!(!agree(&pair, &Ray::new(Vec3::ZERO, Vec3::X, 0.0)));
}

#[test]
fn what_is_beyond_all_numbers_does_no_harm() {
    // Twenty triangles: nodes with empty places.
    let pair = every_of(|| vec![soup(7, 20, 0.5, 1e37, Vec3::ZERO)]);
    let mut random = Random(12);
    for _ in 0..200 {
        let ray = Ray::new(random.point(), random.direction(), 0.0);
        for geometry in &pair[1..] {
            assert!(geometry.intersect(&ray).is_none() && !geometry.occluded(&ray));
        }
    }
}

#[test]
fn rays_that_make_no_sense_do_no_harm() {
    let pair = every(mixture);
    let odd = [
        0.0,
        -0.0,
        1.0,
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MIN_POSITIVE,
        1e-40,
        1e38,
    ];
    for x in odd {
        for y in odd {
            for z in odd {
                for geometry in &pair {
                    let p = Vec3::new(x, y, z);
                    for ray in [
                        Ray::new(p, Vec3::X, 0.0),
                        Ray::new(Vec3::ONE, p, 0.0),
                        Ray {
                            t_max: x,
                            ..Ray::new(p, p, 0.0)
                        },
                    ] {
                        geometry.occluded(&ray);
                        geometry
                            .intersect(&ray)
                            .map(|hit| geometry.vertex(&ray, &hit));
                    }
                }
            }
        }
    }
}
