//! That a tree's promises bound what arrives, and that it chooses as it says.

use super::*;
use crate::{LightBounds, LightExtent, LightSet};
use etalon_math::DVec3;
use etalon_math::float64::{cos, sin};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn direction(z: f64, turn: f64) -> Vec3 {
    let r = (1.0 - z * z).max(0.0).sqrt();
    let angle = core::f64::consts::TAU * turn;
    DVec3::new(r * cos(angle), r * sin(angle), z)
        .as_vec3()
        .normalize()
}

pub(super) fn place() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-3.0_f32..3.0).prop_map(Vec3::from_array)
}

pub(super) fn unit() -> impl Strategy<Value = Vec3> {
    (-1.0..1.0_f64, 0.0..1.0_f64).prop_map(|(z, turn)| direction(z, turn))
}

/// Rectangles, and points among them.
fn scene(places: &[(Vec3, Vec3, f64)]) -> (SmallWorld, LightSet) {
    let mut world = SmallWorld::default();
    let mut descriptions = Vec::new();
    for (index, (position, normal, power)) in places.iter().enumerate() {
        let radiance = ("radiance", Value::Float(*power));
        if index % 3 == 0 {
            let position = ("position", Value::Vector(position.as_dvec3()));
            let intensity = ("intensity", Value::Float(*power));
            descriptions.push(light(&mut world, "point", vec![position, intensity]));
        } else {
            // The small world's rectangles keep x and y; what matters is their normal.
            let shape = world.rectangles.len() as u32;
            world.rectangles.push((*position, *normal));
            let mut description = light(&mut world, "area", vec![radiance]);
            if let Light::Area(area) = &mut description.light {
                area.shape = ShapeId(shape);
            }
            descriptions.push(description);
        }
    }
    let bounds = BoundingSphere::of_box(Vec3::splat(-4.0), Vec3::splat(4.0));
    let set = LightSet::new(descriptions, &world, bounds, LightSamplerKind::Tree);
    (world, set)
}

fn lights() -> impl Strategy<Value = Vec<(Vec3, Vec3, f64)>> {
    prop::collection::vec((place(), unit(), 0.01..100.0_f64), 1..24)
}

proptest! {
    #![proptest_config(ProptestConfig {
        rng_seed: RngSeed::Fixed(4),
        failure_persistence: None,
        cases: 200,
        ..ProptestConfig::default()
    })]

    /// Mutants rejected: a step of the trail read from the wrong end; the share of the other child.
    #[test]
    fn chosen_probabilities_are_what_the_tree_says(
        places in lights(), from in place(), normal in unit(), number in 0.0_f32..1.0,
    ) {
        let (_, set) = scene(&places);
        let from = LightSampleContext::on_surface(from, normal);
        let each = |i: usize| set.selector().probability(&from, LightId(i as u32));
        let sum: f32 = (0..set.len()).map(each).sum();
        // What a cluster promises and neither half keeps is lost.
        prop_assert!(sum < 1.0 + 1e-5, "{sum}");
        if let Some(choice) = set.selector().choose(&from, number) {
            let said = set.selector().probability(&from, choice.light);
            prop_assert_eq!(choice.probability.to_bits(), said.to_bits());
            prop_assert!((0.0..1.0).contains(&choice.rest));
        } else {
            prop_assert!(sum < 1.0 - 1e-5, "{sum}");
        }
    }

    /// Mutants rejected: the spread of the normals forgotten; the angle of the sphere subtracted twice.
    #[test]
    fn what_is_never_chosen_sends_nothing(
        places in lights(), from in place(), normal in unit(), u in 0.0_f32..1.0, v in 0.0_f32..1.0,
    ) {
        let (world, set) = scene(&places);
        let from = LightSampleContext::on_surface(from, normal);
        for index in 0..set.len() {
            let light = LightId(index as u32);
            if set.selector().probability(&from, light) > 0.0 {
                continue;
            }
            let sample = set.sample_one(&world, light, &from, &WAVELENGTHS, Vec2::new(u, v));
            let arrives = sample.map_or(Vec4::ZERO, |sample| sample.radiance * sample.cos.max(0.0));
            prop_assert!(arrives.max_element() <= 1e-4, "{arrives} of {light:?}");
        }
    }

    #[test]
    fn a_cluster_promises_no_less_where_a_part_does(
        a in place(), b in place(), from in place(), axis in unit(), normal in unit(),
    ) {
        let extent = |position: Vec3| LightExtent {
            low: position.as_dvec3(),
            high: position.as_dvec3() + 0.1,
            normals: DirectionCone::along(axis.as_dvec3().normalize()),
            cos_edge: 0.0,
            power: 1.0,
        };
        let from = LightSampleContext::on_surface(from, normal);
        let whole = LightBounds::new(&extent(a).union(extent(b))).at(&from.broadcast());
        let parts = [a, b].map(|p| LightBounds::new(&extent(p)).at(&from.broadcast()));
        prop_assert!(whole > 0.0 || parts == [0.0; 2], "{whole} of {parts:?}");
    }
}

/// Choices follow the probabilities: χ² over the lights, and near lights come first.
#[test]
fn near_lights_come_first() {
    let row = |i: u32| (Vec3::new(3.0 * i as f32, 0.0, 1.0), Vec3::NEG_Z, 1.0);
    let places: Vec<_> = (0..20).map(row).collect();
    let (_, set) = scene(&places);
    let from = receiver(Vec3::new(15.0, 0.0, 0.0), Vec3::Z);
    let probability = |i: u32| set.selector().probability(&from, LightId(i));
    assert!(probability(5) > 0.2 && probability(5) > 50.0 * probability(19));
    let mut counts = [0_u32; 20];
    let draws = 1 << 14;
    for i in 0..draws {
        let u = (i as f32 + 0.5) / draws as f32;
        let choice = set.selector().choose(&from, u).expect("all shine down");
        counts[choice.light.0 as usize] += 1;
    }
    for (i, &count) in counts.iter().enumerate() {
        let expected = probability(i as u32) * draws as f32;
        // Equidistant numbers: off by less than one per boundary of the tree.
        assert!(
            (count as f32 - expected).abs() < 8.0,
            "{i}: {count} for {expected}"
        );
    }
}

#[test]
fn lights_at_infinity_keep_their_half() {
    let mut world = SmallWorld::default();
    let point = |world: &mut SmallWorld, x: f64| {
        let position = ("position", Value::Vector(DVec3::new(x, 0.0, 1.0)));
        light(world, "point", vec![position])
    };
    let sky = light(&mut world, "constant", vec![]);
    let descriptions = vec![point(&mut world, 0.0), sky, point(&mut world, 1.0)];
    let bounds = BoundingSphere::of_box(Vec3::splat(-4.0), Vec3::splat(4.0));
    let set = LightSet::new(descriptions, &world, bounds, LightSamplerKind::Tree);
    let from = receiver(Vec3::ZERO, Vec3::Z);
    let each = [0, 1, 2].map(|i| set.selector().probability(&from, LightId(i)));
    assert_eq!(each[1], 0.5);
    assert!((each[0] + each[2] - 0.5).abs() < 1e-6 && each[0] > each[2]);
}

/// Mutant rejected: weights forgotten by one of the choosers.
#[test]
fn every_chooser_minds_the_sampling_weight() {
    for kind in LightSamplerKind::ALL {
        assert_eq!(LightSamplerKind::named(kind.name()), Some(kind));
        let mut world = SmallWorld::default();
        let mut point = |x: f64, weight: f64| {
            let position = ("position", Value::Vector(DVec3::new(x, 0.0, 1.0)));
            let weight = ("sampling_weight", Value::Float(weight));
            light(&mut world, "point", vec![position, weight])
        };
        let descriptions = vec![point(1.0, 3.0), point(-1.0, 1.0), point(0.0, 0.0)];
        let bounds = BoundingSphere::of_box(Vec3::splat(-4.0), Vec3::splat(4.0));
        let set = LightSet::new(descriptions, &world, bounds, kind);
        let from = receiver(Vec3::ZERO, Vec3::Z);
        for (index, expected) in [0.75, 0.25, 0.0].into_iter().enumerate() {
            let found = set.selector().probability(&from, LightId(index as u32));
            assert!((found - expected).abs() < 1e-6, "{kind:?}: {found}");
        }
    }
}
