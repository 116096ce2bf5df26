//! What must hold at every single direction: a sample's value and density are those of its
//! direction, lanes do not depend on which of them chooses, nothing is negative or not a number.

use crate::directions::Uniform;
use crate::scene::Sample;
use crate::statistical::unturn;
use etalon_transport::{Bsdf, SamplePdf, TransportMode};
use glam::{Vec2, Vec3, Vec4};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn close(a: Vec4, b: Vec4) -> bool {
    (a - b)
        .abs()
        .cmple(2e-4 * a.abs().max(b.abs()) + 1e-6)
        .all()
}

/// What is wrong with samples from `wo`: their value and density must be those of their direction.
pub(crate) fn inconsistency(bsdf: &impl Bsdf, wo: Vec3, seed: u64) -> Option<String> {
    let mut uniform = Uniform::new(seed);
    for mode in [TransportMode::Radiance, TransportMode::Importance] {
        for _ in 0..100 {
            let Some(s) = bsdf.sample(wo, uniform.next(), uniform.pair(), mode) else {
                continue;
            };
            let SamplePdf::Continuous(sampled) = s.chance else {
                if !s.is_null && !bsdf.has_discrete() {
                    return Some(format!("{s:?} is discrete, and nothing should be"));
                }
                continue;
            };
            for wi in [s.wi, uniform.direction()] {
                let value = bsdf.eval(wo, wi, mode);
                let frame = bsdf.hemisphere();
                if value != Vec4::ZERO && frame.is_some_and(|f| wo.dot(f.n) * wi.dot(f.n) <= 0.0) {
                    return Some(format!("{value} toward {wi}, outside of the hemisphere"));
                }
            }
            let (value, density) = bsdf.eval_and_density(wo, s.wi, mode);
            if !close(value, s.value) || !close(density.lanes(), sampled.lanes()) {
                return Some(format!("{s:?} but {value} and {density:?}"));
            }
            if bsdf.eval(wo, s.wi, mode) != value || bsdf.density(wo, s.wi) != density {
                return Some(format!(
                    "eval and density differ from both at once at {}",
                    s.wi
                ));
            }
        }
    }
    None
}

#[test]
fn samples_have_the_value_and_density_of_their_direction() {
    for sample in Sample::with_equations() {
        let mut uniform = Uniform::new(3);
        for seed in 0..40 {
            let wo = uniform.direction();
            let wrong = inconsistency(&sample.at(wo), wo, seed);
            assert_eq!(wrong, None, "{} from {wo}", sample.text);
        }
    }
}

/// What is wrong with lanes of a model resolved with each of the lanes choosing in turn: value and
/// density of each must be the same.
pub(crate) fn lane_dependence<B: Bsdf>(
    turned: impl Fn(usize) -> B,
    wo: Vec3,
    seed: u64,
) -> Option<String> {
    let mut uniform = Uniform::new(seed);
    let hero = turned(0);
    for _ in 0..10 {
        // Half of the directions where the light goes, half anywhere.
        let sampled = hero.sample(wo, uniform.next(), uniform.pair(), TransportMode::Radiance);
        for wi in [uniform.direction()]
            .into_iter()
            .chain(sampled.map(|s| s.wi))
        {
            let (value, density) = hero.eval_and_density(wo, wi, TransportMode::Radiance);
            for turn in 1..4 {
                let (v, d) = turned(turn).eval_and_density(wo, wi, TransportMode::Radiance);
                if !close(unturn(v, turn), value)
                    || !close(unturn(d.lanes(), turn), density.lanes())
                {
                    return Some(format!("{wi} {turn}: {v} {value} {d:?} {density:?}"));
                }
            }
        }
    }
    None
}

#[test]
fn lanes_do_not_depend_on_which_of_them_chooses() {
    for sample in Sample::test_materials() {
        let mut uniform = Uniform::new(5);
        for seed in 0..40 {
            let wo = uniform.direction();
            let wrong = lane_dependence(|turn| sample.rotated(wo, turn), wo, seed);
            assert_eq!(wrong, None, "{} from {wo}", sample.text);
        }
    }
}

#[test]
fn discrete_directions_have_the_same_probability_whichever_lane_chooses() {
    for sample in Sample::test_materials() {
        let mut uniform = Uniform::new(6);
        for _ in 0..100 {
            let wo = uniform.direction();
            let u = uniform.pair();
            let discrete = |turn: usize| {
                (0..64)
                    .filter_map(|i| {
                        let u_lobe = (i as f32 + 0.5) / 64.0;
                        sample
                            .rotated(wo, turn)
                            .sample(wo, u_lobe, u, TransportMode::Radiance)
                    })
                    .filter(|s| s.chance.is_delta())
                    .collect::<Vec<_>>()
            };
            for s in discrete(0) {
                for turn in 1..4 {
                    let lanes = s.chance.lanes();
                    let other = discrete(turn)
                        .into_iter()
                        .find(|t| (t.wi - s.wi).length() < 1e-6);
                    match other {
                        Some(t) => assert!(
                            close(unturn(t.chance.lanes(), turn), lanes)
                                && close(unturn(t.value, turn), s.value),
                            "{} {wo}: {s:?} {t:?}",
                            sample.text
                        ),
                        // The lane that now chooses goes elsewhere (or is too rare to be met):
                        // then it must have had no share in the first one's direction.
                        None => assert!(lanes[turn] < 1.0 / 32.0, "{} {s:?}", sample.text),
                    }
                }
            }
        }
    }
}

/// Directions with a liking for the awkward: axes, the horizon, just above and below it.
fn direction() -> impl Strategy<Value = Vec3> {
    let component = prop_oneof![
        Just(0.0f32),
        Just(-0.0),
        Just(1.0),
        Just(-1.0),
        Just(1e-30),
        Just(1e-7),
        Just(-1e-7),
        -1.0f32..1.0
    ];
    (component.clone(), component.clone(), component)
        .prop_map(|(x, y, z)| Vec3::new(x, y, z).try_normalize().unwrap_or(Vec3::Z))
}

/// Numbers in [0, 1) with a liking for the ends.
fn number() -> impl Strategy<Value = f32> {
    prop_oneof![Just(0.0f32), Just(1.0 - f32::EPSILON / 2.0), 0.0f32..1.0]
}

fn sound(v: Vec4) -> bool {
    v.is_finite() && v.min_element() >= 0.0
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 1500,
        rng_seed: RngSeed::Fixed(20),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn nothing_is_ever_negative_or_not_a_number(
        wo in direction(), wi in direction(), x in number(), y in number(), u_lobe in number(),
        importance in any::<bool>(),
    ) {
        let mode = if importance { TransportMode::Importance } else { TransportMode::Radiance };
        let shading = etalon_math::Frame::from_normal(Vec3::new(0.1, -0.2, 1.0).normalize());
        EXEMPLARS.with(|test_materials| {
            for sample in test_materials {
                for frame in [etalon_math::Frame::IDENTITY, shading] {
                    let bsdf = sample.resolve(wo, &crate::scene::WAVELENGTHS, frame);
                    let (value, density) = bsdf.eval_and_density(wo, wi, mode);
                    prop_assert!(sound(value) && sound(density.lanes()), "{}", sample.text);
                    prop_assert!(sound(bsdf.null_transmittance()) && sound(bsdf.albedo(wo)), "{}", sample.text);
                    if let Some(s) = bsdf.sample(wo, u_lobe, Vec2::new(x, y), mode) {
                        let lanes = s.chance.lanes();
                        prop_assert!(
                            sound(s.value) && sound(lanes) && lanes.x > 0.0 && s.eta > 0.0
                                && (s.wi.length() - 1.0).abs() < 1e-4,
                            "{} {s:?}", sample.text
                        );
                    }
                }
            }
            Ok(())
        })?;
    }
}

thread_local! {
    static EXEMPLARS: Vec<Sample> = Sample::test_materials()
        .into_iter()
        .chain(EXTREMES.iter().map(|text| Sample::new(text)))
        .collect();
}

/// Parameters at the ends of what is accepted.
const EXTREMES: [&str; 14] = [
    "diffuse reflectance=u:0",
    "dielectric int_ior=f:1 ext_ior=f:1",
    "dielectric int_ior=f:1000 ext_ior=f:0.001",
    "thindielectric int_ior=f:1 ext_ior=f:1",
    "roughconductor alpha=f:0",
    "roughconductor alpha=f:0 distribution=s:ggx eta=u:1 k=u:0",
    "roughconductor alpha_u=f:0 alpha_v=f:50 eta=u:1000 k=u:1000",
    "roughdielectric alpha=f:0 int_ior=f:1.00001 ext_ior=f:1",
    "roughdielectric alpha=f:50 int_ior=f:100 distribution=s:ggx",
    "roughdielectric alpha=f:3 int_ior=f:0.01 sample_visible=b:false",
    "plastic int_ior=f:1 ext_ior=f:1 specular_reflectance=u:0 diffuse_reflectance=u:0",
    "plastic int_ior=f:50 nonlinear=b:true diffuse_reflectance=u:1",
    "roughplastic alpha=f:0 int_ior=f:50 diffuse_reflectance=u:1",
    "roughplastic alpha=f:5 distribution=s:ggx int_ior=f:0.1",
];
