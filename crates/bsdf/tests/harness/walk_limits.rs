//! Layered materials where their light is known: in closed form, or because none is lost.

use crate::directions::{self, Uniform};
use crate::scene::{Sample, WAVELENGTHS};
use crate::walks::{DISCRETE, Means, directions_of_light, evaluated, sampled};
use core::f32::consts::FRAC_1_PI;
use etalon_bsdf::quadrature::gauss_legendre;
use etalon_math::{Frame, fresnel};
use etalon_spectrum::Wavelengths;
use etalon_transport::{Bsdf, TransportMode};
use glam::{Vec3, Vec4};

/// Means and standard errors of the values of many estimates.
fn mean_value(sample: &Sample, wo: Vec3, wi: Vec3, draws: usize) -> (f32, f32) {
    let (mut sum, mut squares) = (0.0f64, 0.0f64);
    for i in 0..draws {
        let waves = Wavelengths {
            lambda: WAVELENGTHS.lambda + i as f32 * 1e-3,
            ..WAVELENGTHS
        };
        let bsdf = sample.resolve(wo, &waves, Frame::IDENTITY);
        let value = f64::from(bsdf.eval(wo, wi, TransportMode::Radiance).x);
        (sum, squares) = (sum + value, squares + value * value);
    }
    let n = draws as f64;
    let mean = sum / n;
    (
        mean as f32,
        ((squares / n - mean * mean).max(0.0) / n).sqrt() as f32,
    )
}

/// T(θo) T(θi) ρ cos θi / (π η² (1 − ρ R)), the closed form of `plastic`, with R integrated instead of fitted.
#[test]
fn a_smooth_coat_over_a_diffuse_base_is_plastic() {
    let eta = 1.5;
    let outside = |cos: f32| 1.0 - fresnel::dielectric(cos, eta).0;
    let critical = (1.0 - 1.0 / f64::from(eta * eta)).sqrt();
    let below: f64 = gauss_legendre(64)
        .into_iter()
        .map(|(x, weight)| {
            let mu = critical + (1.0 - critical) * x * x;
            let inside = f64::from(fresnel::dielectric(mu as f32, 1.0 / eta).0);
            2.0 * mu * inside * weight * 2.0 * x * (1.0 - critical)
        })
        .sum();
    let internal = (critical * critical + below) as f32;
    let common = "int_ior=f:1.5 ext_ior=f:1";
    for rho in [0.2f32, 0.8, 1.0] {
        let walked =
            format!("coateddiffuse {common} reflectance=f:{rho} thickness=f:0 max_depth=i:300");
        let closed = format!("plastic {common} diffuse_reflectance=f:{rho} nonlinear=b:true");
        let [walked, closed] = [walked, closed].map(|text| Sample::new(&text));
        for (wo, wi) in [(10.0, 40.0), (50.0, 20.0), (80.0, 70.0)] {
            let (wo, wi) = (directions::at(wo, 0.3), directions::at(wi, 2.0));
            let (mean, error) = mean_value(&walked, wo, wi, 40_000);
            let base = rho / (1.0 - rho * internal) * FRAC_1_PI / (eta * eta);
            let expected = base * outside(wo.z) * outside(wi.z) * wi.z;
            // α = 6 · 10⁻⁵ for each of nine; the walks of ρ = 1 scatter most.
            assert!(
                (mean - expected).abs() < 4.0 * error + 1e-6 && error < 4e-3 * expected,
                "{rho} {wo} {wi}: {mean} ± {error}, {expected}"
            );
            let plastic = closed.at(wo).eval(wo, wi, TransportMode::Radiance).x;
            assert!(
                (expected / plastic - 1.0).abs() < 0.02,
                "{expected} {plastic}"
            );
            let [a, b] = [&walked, &closed].map(|s| {
                let found = s.at(wo).discrete(wo, 0, TransportMode::Radiance);
                found.expect("a reflection").value.x
            });
            assert!((a - b).abs() < 1e-6, "{a} {b}");
        }
    }
}

/// Nothing is absorbed: with a smooth interface all light comes back, but for walks of more than `max_depth` events. Facets
/// that scatter once lose what others would have caught.
#[test]
fn white_layers_return_all_light() {
    let white = "thickness=f:0.7 albedo=f:1 g=f:0.4 max_depth=i:2000";
    for (text, least) in [
        (format!("coateddiffuse reflectance=f:1 {white}"), 0.9999),
        (format!("coatedconductor {white}"), 0.9999),
        (format!("coatedconductor base_alpha=f:0.05 {white}"), 0.99),
        (
            format!("coateddiffuse reflectance=f:1 alpha=f:0.03 {white}"),
            0.98,
        ),
    ] {
        let sample = Sample::new(&text);
        for wo in directions_of_light() {
            let bsdf = sample.at(wo);
            let discrete = bsdf.discrete(wo, 0, TransportMode::Radiance);
            let discrete = discrete.map_or(0.0, |s| s.value.x);
            let total = |means: &Means| {
                let all = (0..DISCRETE).map(|cell| means.of(cell));
                let (mean, variance) = all.fold((0.0, 0.0), |(a, b), (mean, variance)| {
                    (a + mean.x, b + variance.x)
                });
                (mean, variance.sqrt())
            };
            for means in [
                sampled(&sample, wo, 20_000, 3),
                evaluated(&sample, wo, 100_000, 4),
            ] {
                let (mean, error) = total(&means);
                let energy = mean + discrete;
                let slack = 4.0 * error + 1e-4;
                assert!(
                    energy > least - slack && energy < 1.0 + slack && error < 0.015,
                    "{text} {wo}: {energy} ± {error}"
                );
            }
        }
    }
}

#[test]
fn layers_that_do_nothing_leave_what_is_below_or_above() {
    let alike = [
        (
            "coateddiffuse int_ior=f:1.2 ext_ior=f:1.2 alpha=f:0.3 thickness=f:0 reflectance=t:400:0.2,700:0.9",
            "diffuse reflectance=t:400:0.2,700:0.9",
        ),
        (
            "coatedconductor int_ior=f:1.2 ext_ior=f:1.2 thickness=f:0 base_alpha_u=f:0.2 base_alpha_v=f:0.4 eta=u:0.2 k=u:3.9",
            "roughconductor masking=s:correlated alpha_u=f:0.2 alpha_v=f:0.4 distribution=s:ggx eta=u:0.2 k=u:3.9 ext_eta=f:1.2",
        ),
        (
            "coateddiffuse int_ior=f:1.5 ext_ior=f:1 alpha=f:0.3 thickness=f:200",
            "roughdielectric masking=s:correlated int_ior=f:1.5 ext_ior=f:1 alpha=f:0.3 distribution=s:ggx",
        ),
    ]
    .map(|(layered, plain)| [layered, plain].map(Sample::new));
    let mut uniform = Uniform::new(3);
    for [layered, plain] in &alike {
        for _ in 0..400 {
            let [wo, wi] = [uniform.direction(), uniform.direction()].map(|w| w.with_z(w.z.abs()));
            let [a, b] = [layered, plain].map(|s| s.at(wo).eval(wo, wi, TransportMode::Radiance));
            let near = (a - b).abs().cmple(1e-5 * b + 1e-6).all();
            assert!(near, "{} {wo} {wi}: {a} {b}", layered.text);
        }
    }
    let mirror = Sample::new("coatedconductor thickness=f:0 max_depth=i:1000");
    for wo in directions_of_light() {
        let found = mirror.at(wo).discrete(wo, 0, TransportMode::Radiance);
        let s = found.expect("a reflection");
        assert!((s.value - 1.0).abs().max_element() < 1e-5 && s.chance.lanes() == Vec4::ONE);
        assert!(!mirror.at(wo).has_continuous());
    }
}
