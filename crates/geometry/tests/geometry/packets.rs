//! Rays in packets against the same rays one by one: the same hits, to the last bit, whatever they are packed with.

use crate::accelerators::{lattice, mixture, soup};
use crate::things::{Random, geometry_of, icosphere, mesh_of};
use etalon_geometry::{AcceleratorKind, Geometry, GeometryBuilder, Shape};
use etalon_transport::{Hit, LightId, MaterialId, Ray};
use glam::Vec3;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// All of a hit in integers.
type Bits = Option<([u32; 3], [u32; 4])>;

fn bits(hit: Option<Hit>) -> Bits {
    let hit = hit?;
    let numbers = [hit.t, hit.parameters.x, hit.parameters.y].map(f32::to_bits);
    Some((
        numbers,
        [hit.shape.0, hit.primitive, hit.instance.0, hit.slot],
    ))
}

/// A batch agrees with its rays one by one. Returns how many hit something.
fn agree(geometry: &Geometry, rays: &[Ray]) -> usize {
    let mut hits = vec![None; rays.len()];
    geometry.intersect_batch(rays, &mut hits);
    let mut occluded = vec![false; rays.len()];
    geometry.occluded_batch(rays, |ray| ray, &mut occluded);
    for ((ray, &hit), occluded) in rays.iter().zip(&hits).zip(occluded) {
        assert_eq!(bits(hit), bits(geometry.intersect(ray)), "{ray:?}");
        assert_eq!(occluded, geometry.occluded(ray), "{ray:?}");
    }
    hits.iter().flatten().count()
}

/// A batch agrees, and so do its rays as segments that end at, just before and just after what they hit, and far away.
fn agree_also_short(geometry: &Geometry, rays: &[Ray]) -> usize {
    let segments: Vec<Ray> = (rays.iter().enumerate())
        .map(|(i, ray)| {
            let t = geometry.intersect(ray).map_or(1.0, |hit| hit.t);
            let ends = [t, t.next_down(), t.next_up(), 2.0 * t, f32::MAX];
            Ray {
                t_max: ends[i % ends.len()],
                ..*ray
            }
        })
        .collect();
    agree(geometry, &segments);
    agree(geometry, rays)
}

/// Rays from one place into a cone around a direction: so similar that every tree takes packets of them. All but the
/// first few may be odd.
fn bundle(random: &mut Random, from: Vec3, along: Vec3, width: f32, odd: bool) -> Vec<Ray> {
    (0..100)
        .map(|i| {
            let direction = (along + random.point() * width).normalize();
            let ray = Ray::new(from + random.point() * 0.01, direction, random.number());
            match i % 10 {
                9 if odd && i > 10 => self::odd(random, ray),
                _ => ray,
            }
        })
        .collect()
}

/// A ray with something unusual.
fn odd(random: &mut Random, ray: Ray) -> Ray {
    let numbers = [
        0.0,
        -0.0,
        1e-40,
        -1e-30,
        1e30,
        1e38,
        f32::INFINITY,
        f32::NAN,
    ];
    let mut pick = |count: usize| (random.number() * count as f32) as usize;
    let mut ray = ray;
    match pick(4) {
        0 => ray.direction[pick(3)] = numbers[pick(numbers.len())],
        1 => ray.origin[pick(3)] = numbers[pick(numbers.len())],
        2 => ray.t_max = [-1.0, 0.0, -0.0, 1e-30, f32::NAN][pick(5)],
        _ => ray.direction = [Vec3::X, Vec3::NEG_Y, Vec3::new(0.0, -0.0, -1.0)][pick(3)],
    }
    ray
}

fn built(shape: Shape) -> Geometry {
    geometry_of([shape])
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 64,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(0x8ac4e7),
        ..ProptestConfig::default()
    })]

    #[test]
    fn soups(
        seed in any::<u64>(),
        // Trees of one block, of one node, and of several.
        count in prop_oneof![1usize..9, 9usize..80, 80usize..2000],
        size in 0.01f32..1.0,
        rays in 1usize..300,
    ) {
        let geometry = built(soup(seed, count, size, 1.0, Vec3::ZERO));
        let mut random = Random(seed ^ 1);
        let scattered: Vec<Ray> = (0..rays)
            .map(|i| {
                let ray = Ray::new(random.point() * 2.0, random.direction(), 0.0);
                if i % 7 == 6 { odd(&mut random, ray) } else { ray }
            })
            .collect();
        agree_also_short(&geometry, &scattered);
        for width in [0.001, 0.03, 0.2] {
            let from = random.direction() * 3.0;
            agree_also_short(&geometry, &bundle(&mut random, from, -from / 3.0, width, true));
        }
    }
}

#[test]
fn grids_met_in_their_corners_edges_and_planes() {
    // Rays along axes and diagonals from a lattice of points: ties of coplanar triangles at every hit.
    let geometry = built(lattice());
    let mut hits = 0;
    for direction in [
        Vec3::NEG_Z,
        Vec3::new(-0.0, 0.0, 1.0),
        Vec3::X,
        Vec3::new(0.0, -1.0, -0.0),
        Vec3::ONE.normalize(),
        Vec3::new(1.0, -1.0, 0.5).normalize(),
        Vec3::new(1.0, 1.0, 0.0).normalize(),
    ] {
        let mut rays = Vec::new();
        for (i, j) in (-2..=20).flat_map(|i| (-2..=20).map(move |j| (i, j))) {
            let at = Vec3::new(i as f32, j as f32, (i + j) as f32 * 0.5) * 0.5;
            rays.push(Ray::new(at - direction * 20.0, direction, 0.0));
        }
        hits += agree_also_short(&geometry, &rays);
    }
    assert!(hits > 1000, "{hits}");
}

#[test]
fn of_equal_hits_the_first_primitive_wins() {
    // So many copies of a triangle that they fill several blocks, and trees with several nodes.
    for copies in [3u32, 20, 700] {
        let mut random = Random(u64::from(copies));
        let mut positions = [Vec3::ZERO, Vec3::X, Vec3::Y].repeat(copies as usize);
        // Those in between stand elsewhere, so that copies are in different leaves.
        for i in (0..copies as usize).filter(|i| i % 3 == 1) {
            let shift = random.point();
            positions[3 * i..3 * i + 3]
                .iter_mut()
                .for_each(|p| *p += shift);
        }
        let triangles = (0..copies).rev().map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
        let geometry = built(mesh_of(positions, triangles.collect()));
        let from = Vec3::new(0.3, 0.3, 4.0);
        let rays = bundle(&mut random, from, Vec3::NEG_Z, 0.05, false);
        assert!(agree_also_short(&geometry, &rays) > 50);
    }
}

#[test]
fn rays_that_leave_what_they_hit() {
    // Where the error of a distance decides.
    for level in [1, 5] {
        let (positions, triangles) = icosphere(level);
        let geometry = built(mesh_of(positions, triangles));
        let mut random = Random(u64::from(level));
        for _ in 0..20 {
            let from = random.direction() * 3.0;
            let rays = bundle(&mut random, from, -from / 3.0, 0.02, false);
            let onward: Vec<Ray> = rays
                .iter()
                .filter_map(|ray| {
                    let hit = geometry.intersect(ray)?;
                    let vertex = geometry.vertex(ray, &hit);
                    let way = (ray.direction + random.point() * 0.05).normalize();
                    // From the point itself too, not only from beside it.
                    match random.number() < 0.5 {
                        true => Some(vertex.spawn(way)),
                        false => Some(Ray::new(vertex.position, way, 0.0)),
                    }
                })
                .collect();
            assert!(agree(&geometry, &onward) > 50);
        }
    }
}

#[test]
fn shapes_and_instances_among_triangles() {
    let mut builder = GeometryBuilder::new();
    mixture(&mut builder);
    let geometry = builder.build();
    let mut random = Random(5);
    let mut hits = 0;
    for _ in 0..60 {
        let from = random.direction() * 8.0;
        let along = (random.point() * 4.0 - from).normalize();
        let rays = bundle(&mut random, from, along, 0.1, true);
        hits += agree_also_short(&geometry, &rays);
        // And onward from where they are.
        let onward: Vec<Ray> = rays
            .iter()
            .filter_map(|ray| {
                let vertex = geometry.vertex(ray, &geometry.intersect(ray)?);
                Some(vertex.spawn((along + random.point() * 0.1).normalize()))
            })
            .collect();
        agree_also_short(&geometry, &onward);
    }
    assert!(hits > 1000, "{hits}");
}

#[test]
fn rays_from_farther_away_than_packets_take() {
    let geometry = built(mesh_of(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]));
    let rays: Vec<Ray> = (0..40)
        .map(|i| {
            let height = if i % 4 == 0 { 1e30 } else { 10.0 };
            let at = Vec3::new(i as f32 * 0.01, 0.2, height);
            Ray::new(at, Vec3::NEG_Z, 0.0)
        })
        .collect();
    assert_eq!(agree(&geometry, &rays), 40);
}

#[test]
fn other_accelerators_take_batches_too() {
    for kind in AcceleratorKind::ALL {
        let mut builder = GeometryBuilder::new();
        builder.add_shape(lattice(), MaterialId(0), LightId::NONE);
        let geometry = builder.build_with(kind);
        let from = Vec3::new(3.0, 3.0, -9.0);
        let rays = bundle(&mut Random(9), from, Vec3::Z, 0.2, true);
        assert!(agree_also_short(&geometry, &rays) > 20);
        assert_eq!(agree(&geometry, &[]), 0);
    }
}
