//! The choice among few lights of all kinds.

use super::tree::{place, unit};
use super::*;
use crate::LightSet;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// A light of each kind, of what `places` says, `count` of them in all.
fn scene(places: &[(Vec3, Vec3, f64)]) -> (SmallWorld, LightSet) {
    let mut world = SmallWorld::default();
    let mut descriptions = Vec::new();
    for (index, &(position, normal, power)) in places.iter().enumerate() {
        let (position, along) = (position.as_dvec3(), normal.as_dvec3());
        let at = ("position", Value::Vector(position));
        descriptions.push(match index % 5 {
            0 => {
                world.rectangles.push((position.as_vec3(), normal));
                light(&mut world, "area", vec![("radiance", Value::Float(power))])
            }
            1 => light(
                &mut world,
                "point",
                vec![at, ("intensity", Value::Float(power))],
            ),
            2 => light(
                &mut world,
                "constant",
                vec![("radiance", Value::Float(power))],
            ),
            3 => {
                let direction = ("direction", Value::Vector(along));
                let irradiance = ("irradiance", Value::Float(power));
                light(&mut world, "directional", vec![direction, irradiance])
            }
            _ => light(&mut world, "spot", vec![("intensity", Value::Float(power))]),
        });
    }
    let bounds = BoundingSphere::of_box(Vec3::splat(-4.0), Vec3::splat(4.0));
    let set = LightSet::new(descriptions, &world, bounds, LightSamplerKind::Automatic);
    (world, set)
}

proptest! {
    #![proptest_config(ProptestConfig {
        rng_seed: RngSeed::Fixed(5),
        failure_persistence: None,
        cases: 400,
        ..ProptestConfig::default()
    })]

    /// Probabilities sum to one, are those with which lights are chosen, and are zero only where nothing arrives; none
    /// is below half of that among equals. Rejects a light that is left out because it is on the other side of a
    /// surface that receives on both, and the estimate without its uniform half.
    #[test]
    fn chosen_by_what_arrives(
        places in prop::collection::vec((place(), unit(), 0.01..100.0_f64), 2..=8),
        at in place(), normal in unit(), one_sided: bool,
        number in 0.0_f32..1.0, u in 0.0_f32..1.0, v in 0.0_f32..1.0,
    ) {
        let (world, set) = scene(&places);
        let mut from = LightSampleContext::on_surface(at, normal);
        from.one_sided = one_sided;
        let probability = |i: usize| set.selector().probability(&from, LightId(i as u32));
        let sum: f32 = (0..set.len()).map(probability).sum();
        match set.selector().choose(&from, number) {
            Some(choice) => {
                let said = probability(choice.light.0 as usize);
                prop_assert_eq!(choice.probability.to_bits(), said.to_bits());
                prop_assert!((0.0..1.0).contains(&choice.rest));
                prop_assert!((sum - 1.0).abs() < 1e-5, "{}", sum);
            }
            None => prop_assert_eq!(sum, 0.0),
        }
        for i in 0..set.len() {
            let light = LightId(i as u32);
            if probability(i) > 0.0 {
                prop_assert!(probability(i) >= 0.499 / set.len() as f32);
                continue;
            }
            let sample = set.sample_one(&world, light, &from, &WAVELENGTHS, Vec2::new(u, v));
            let arrives = sample.is_some_and(|sample| {
                let cos = sample.direction.dot(normal);
                let cos = if one_sided { cos } else { cos.abs() };
                sample.radiance.max_element() * sample.cos > 1e-4 && cos > 1e-4
            });
            prop_assert!(!arrives, "{:?}", light);
        }
    }
}

/// A lamp close by is not starved by a large sky, nor by the sun. Rejects half of the choices for lights at
/// infinity, then by power.
#[test]
fn near_lights_are_not_starved() {
    let (_, set) = scene(&[
        (Vec3::new(0.0, 0.0, 2.0), Vec3::NEG_Z, 20.0),
        (Vec3::new(3.9, 0.0, 3.0), Vec3::Z, 1.0),
        (Vec3::ZERO, Vec3::Z, 0.1),
        (Vec3::ZERO, Vec3::NEG_Z, 0.1),
    ]);
    let from = receiver(Vec3::ZERO, Vec3::Z);
    let probability = |i: u32| set.selector().probability(&from, LightId(i));
    assert!(probability(0) > 0.5, "{}", probability(0));
    assert!(set.selector().probability_to_emit(LightId(0)) < 0.5);
    // What shines from behind the only side that counts is left out.
    let mut below = receiver(Vec3::ZERO, Vec3::NEG_Z);
    below.one_sided = true;
    let probability = |i: u32| set.selector().probability(&below, LightId(i));
    assert_eq!([0, 1, 3].map(probability), [0.0; 3]);
    assert!((probability(2) - 1.0).abs() < 1e-6);
}
