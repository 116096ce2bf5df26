//! Which light is chosen, and that densities say so.

use super::*;
use crate::LightSet;
use etalon_params::DVec3;
use etalon_transport::SamplePdf;

fn bounds() -> BoundingSphere {
    BoundingSphere::of_box(Vec3::splat(-1.0), Vec3::splat(1.0))
}

fn point(world: &mut SmallWorld, intensity: f64, weight: f64) -> LightDescription {
    let position = Value::Vector(DVec3::new(0.0, 0.0, 2.0));
    let properties = vec![
        ("position", position),
        ("intensity", Value::Float(intensity)),
        ("sampling_weight", Value::Float(weight)),
    ];
    light(world, "point", properties)
}

fn sky(world: &mut SmallWorld, radiance: f64) -> LightDescription {
    light(
        world,
        "constant",
        vec![("radiance", Value::Float(radiance))],
    )
}

fn probabilities(set: &LightSet) -> Vec<f32> {
    (0..set.len())
        .map(|i| {
            set.selector()
                .probability(&LightSampleContext::in_space(Vec3::ZERO), LightId(i as u32))
        })
        .collect()
}

#[test]
fn lights_are_chosen_by_power_and_weight() {
    let mut world = SmallWorld::default();
    let descriptions = [(1.0, 1.0), (3.0, 1.0), (0.0, 1.0), (5.0, 0.0), (2.0, 2.0)]
        .map(|(intensity, weight)| point(&mut world, intensity, weight));
    let set = LightSet::new(
        descriptions.to_vec(),
        &world,
        bounds(),
        LightSamplerKind::Power,
    );
    let expected = [0.125, 0.375, 0.0, 0.0, 0.5];
    for (found, expected) in probabilities(&set).into_iter().zip(expected) {
        assert!((found - expected).abs() < 1e-6);
    }
    let mut counts = [0_u32; 5];
    for i in 0..4096 {
        let u = (i as f32 + 0.5) / 4096.0;
        let choice = set.selector().choose_to_emit(u).expect("there are lights");
        assert_eq!(choice.probability, expected[choice.light.0 as usize]);
        assert!((0.0..1.0).contains(&choice.rest));
        counts[choice.light.0 as usize] += 1;
    }
    assert_eq!(counts, [512, 1536, 0, 0, 2048]);
}

#[test]
fn near_and_infinite_lights_share_equally() {
    let mut world = SmallWorld::default();
    let descriptions = vec![
        point(&mut world, 1.0, 1.0),
        sky(&mut world, 1000.0),
        point(&mut world, 3.0, 1.0),
    ];
    let set = LightSet::new(descriptions, &world, bounds(), LightSamplerKind::Power);
    let found = probabilities(&set);
    for (found, expected) in found.into_iter().zip([0.125, 0.5, 0.375]) {
        assert!((found - expected).abs() < 1e-6, "{found}");
    }
}

#[test]
fn without_light_nothing_is_chosen() {
    let mut world = SmallWorld::default();
    let dark = vec![point(&mut world, 0.0, 1.0), sky(&mut world, 0.0)];
    for descriptions in [vec![], dark] {
        let set = LightSet::new(descriptions, &world, bounds(), LightSamplerKind::Power);
        let from = receiver(Vec3::ZERO, Vec3::Z);
        let u = Vec2::splat(0.5);
        assert!(set.sample(&world, &from, &WAVELENGTHS, 0.5, u).is_none());
        assert!(set.emit(&world, &WAVELENGTHS, 0.5, u, u, 0.0).is_none());
        let density = set.background_density(&LightSampleContext::in_space(Vec3::ZERO), Vec3::Z);
        assert_eq!(density.hero(), 0.0);
    }
}

/// Whatever is sampled has the density that a ray which arrives there would compute; several
/// skies count as one.
#[test]
fn sampled_density_equals_hit_density() {
    let mut world = SmallWorld::default();
    world
        .rectangles
        .push((Vec3::new(0.3, 0.2, 2.0), Vec3::NEG_Z));
    let area = light(&mut world, "area", vec![("radiance", texture("ramp"))]);
    add_file(
        &mut world,
        "sky.pfm",
        4,
        &[0.5, 2.0, 1.0, 0.1, 3.0, 0.0, 1.0, 7.0, 0.2, 0.3, 0.4, 0.5].map(|x| [x, 0.5 * x, x]),
    );
    let image = vec![("filename", Value::String("sky.pfm".into()))];
    let descriptions = vec![
        area,
        point(&mut world, 1.0, 1.0),
        sky(&mut world, 0.3),
        light(&mut world, "envmap", image),
    ];
    let set = LightSet::new(descriptions, &world, bounds(), LightSamplerKind::Power);
    assert!(set.has_background());
    let mut random = numbers(1);
    let mut seen = [0; 4];
    for _ in 0..2000 {
        let from = receiver(Vec3::new(0.1, -0.2, 0.3), Vec3::Z);
        let (u_light, u) = (random.next_1d(), random.next_2d());
        let Some(sample) = set.sample(&world, &from, &WAVELENGTHS, u_light, u) else {
            continue;
        };
        seen[sample.light.0 as usize] += 1;
        assert!((sample.direction.length() - 1.0).abs() < 1e-5);
        assert!(sample.radiance.is_finite() && sample.radiance.min_element() >= 0.0);
        let (density, radiance) = match (sample.chance, sample.target) {
            (SamplePdf::Discrete(p), Some(_)) => {
                assert_eq!(
                    p.0.x,
                    set.selector()
                        .probability(&LightSampleContext::in_space(Vec3::ZERO), sample.light)
                );
                continue;
            }
            (SamplePdf::Continuous(density), Some(target)) => {
                // The offset of the target is far below the tolerances.
                let uv = (target - Vec3::new(0.3, 0.2, 2.0)).truncate() * 0.5 + 0.5;
                let vertex = world.vertex(ShapeId(0), uv);
                let hit = set.density(&world, &from, &vertex);
                assert!((density.hero() / hit.hero() - 1.0).abs() < 1e-4);
                let radiance = set.emitted(&world, &vertex, -sample.direction, &WAVELENGTHS);
                (hit, radiance)
            }
            (SamplePdf::Continuous(density), None) => {
                let hit = set.background_density(&from, sample.direction);
                assert!((density.hero() / hit.hero() - 1.0).abs() < 1e-3);
                (
                    hit,
                    set.background(&world, sample.direction, 0.0, &WAVELENGTHS),
                )
            }
            other => panic!("{other:?}"),
        };
        assert!(density.hero() > 0.0);
        let difference = (radiance - sample.radiance).abs().max_element();
        assert!(difference <= 1e-3 * radiance.max_element(), "{difference}");
    }
    assert!(seen.iter().all(|&count| count > 50), "{seen:?}");
}

#[test]
fn surfaces_emit_on_their_outer_side_only() {
    let mut world = SmallWorld::default();
    world
        .rectangles
        .push((Vec3::new(0.0, 0.0, 2.0), Vec3::NEG_Z));
    let area = light(&mut world, "area", vec![]);
    let set = LightSet::new(vec![area], &world, bounds(), LightSamplerKind::Power);
    let vertex = world.vertex(ShapeId(0), Vec2::splat(0.5));
    let emitted = |wo| set.emitted(&world, &vertex, wo, &WAVELENGTHS);
    assert_eq!(emitted(Vec3::NEG_Z), white());
    assert_eq!(emitted(Vec3::Z), Vec4::ZERO);
    let behind = receiver(Vec3::new(0.0, 0.0, 3.0), Vec3::NEG_Z);
    let u = Vec2::splat(0.5);
    assert!(set.sample(&world, &behind, &WAVELENGTHS, 0.5, u).is_none());
    let no_light = upward(Vec3::ZERO, Vec3::Z);
    assert_eq!(
        set.emitted(&world, &no_light, Vec3::Z, &WAVELENGTHS),
        Vec4::ZERO
    );
    assert_eq!(
        set.density(&world, &LightSampleContext::in_space(Vec3::ONE), &no_light)
            .hero(),
        0.0
    );
}
