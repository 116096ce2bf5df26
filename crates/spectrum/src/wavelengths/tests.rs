//! Tests of wavelength sampling.

use super::*;
use crate::{RgbSpectrum, illuminants, sensor, sensor_response};
use etalon_math::float64;
use proptest::prelude::*;

/// Draws at the centres of `count` equal intervals of [0, ¼): with the four lanes, all of [0, 1).
fn stratified(distribution: &WavelengthDistribution, count: usize) -> Vec<Wavelengths> {
    (0..count)
        .map(|i| distribution.sample((i as f32 + 0.5) / (4 * count) as f32))
        .collect()
}

#[test]
fn draws_have_the_density_they_claim() {
    for (min, max) in [
        (360.0, 830.0),
        (400.0, 700.0),
        (300.0, 1000.0),
        (550.0, 551.0),
    ] {
        let distribution = WavelengthDistribution::new(min, max).expect("a valid range");
        // ∫ p dλ over each cell is exactly one cell's probability, and the cells tile the range.
        let mut end = min as f32;
        for [low, width] in &distribution.cells {
            assert!(
                (low - end).abs() <= 1e-4 && *width > 0.0,
                "{low} {end} {width}"
            );
            end = low + width;
        }
        assert!((f64::from(end) - max).abs() < 1e-3);
        for w in stratified(&distribution, 5000) {
            let looked_up = distribution.density(w.lambda);
            for j in 0..4 {
                let (lambda, density) = w.lane(j);
                assert!(f64::from(lambda) >= min && f64::from(lambda) <= max + 1e-4);
                let ratio = density / looked_up[j];
                // At a cell's edge the look-up may answer with its neighbour.
                assert!(
                    (0.4..2.5).contains(&ratio),
                    "{lambda}: {density} {looked_up}"
                );
            }
        }
    }
}

#[test]
fn the_distribution_function_follows_the_importance() {
    // Kolmogorov's distance between draws at equal steps of u and the integral of the importance:
    // a deterministic bound of two cells. Sampling uniformly (a mutant) is off by 0.3.
    let distribution = WavelengthDistribution::default();
    let count = 4096;
    let mut lambdas: Vec<f64> = stratified(&distribution, count / 4)
        .iter()
        .flat_map(|w| w.lambda.to_array())
        .map(f64::from)
        .collect();
    lambdas.sort_by(f64::total_cmp);
    let steps = 47_000;
    let width = (LAMBDA_MAX - LAMBDA_MIN) / steps as f64;
    let weights: Vec<f64> = (0..steps)
        .map(|i| importance(LAMBDA_MIN + (i as f64 + 0.5) * width))
        .collect();
    let total: f64 = weights.iter().sum();
    let (mut below, mut next) = (0.0, 0);
    for (i, weight) in weights.iter().enumerate() {
        below += weight / total;
        let lambda = LAMBDA_MIN + (i + 1) as f64 * width;
        while next < count && lambdas[next] <= lambda {
            next += 1;
        }
        let distance = (next as f64 / count as f64 - below).abs();
        assert!(distance < 2.0 / CELLS as f64, "{lambda}: {distance}");
    }
}

#[test]
fn lanes_are_quarter_turns_of_one_draw() {
    let distribution = WavelengthDistribution::default();
    for i in 0..64 {
        let u = i as f32 / 256.0;
        let w = distribution.sample(u);
        for k in 0..4 {
            assert_eq!(distribution.sample(u + k as f32 / 4.0), w.rotated(k));
        }
    }
    let w = distribution.sample(0.3);
    assert_eq!(w.rotated(1).rotated(3), w);
}

#[test]
fn the_whole_unit_interval_is_safe() {
    let distribution = WavelengthDistribution::default();
    for u in [
        0.0,
        f32::MIN_POSITIVE,
        0.249_999_99,
        0.25,
        0.75,
        1.0 - f32::EPSILON / 2.0,
        1.0,
    ] {
        let w = distribution.sample(u);
        assert!(w.density.min_element() > 0.0, "{u}");
        assert!(
            w.lambda.min_element() >= 360.0 && w.lambda.max_element() <= 830.001,
            "{u}"
        );
    }
}

#[test]
fn bad_ranges_are_refused() {
    for (min, max) in [
        (0.0, 830.0),
        (-1.0, 2.0),
        (500.0, 500.0),
        (600.0, 500.0),
        (f64::NAN, 1.0),
        (1.0, f64::INFINITY),
    ] {
        assert!(
            WavelengthDistribution::new(min, max).is_err(),
            "{min} {max}"
        );
    }
}

/// Mean over (R, G, B) of variance/(mean² + 0.01) of one draw, for the radiance `spectrum`.
fn relative_variance(draws: &[Wavelengths], spectrum: impl Fn(f64) -> f64) -> f64 {
    let mut sum = [0.0; 3];
    let mut squares = [0.0; 3];
    for w in draws {
        let radiance = w
            .lambda
            .to_array()
            .map(|l| spectrum(f64::from(l)) as f32 / 4.0);
        let rgb = sensor_response(w).rgb(Vec4::from_array(radiance));
        for c in 0..3 {
            sum[c] += f64::from(rgb[c]);
            squares[c] += f64::from(rgb[c]) * f64::from(rgb[c]);
        }
    }
    let n = draws.len() as f64;
    (0..3)
        .map(|c| {
            let mean = sum[c] / n;
            (squares[c] / n - mean * mean) / (mean * mean + 0.01) / 3.0
        })
        .sum()
}

#[test]
fn noise_is_far_below_that_of_the_common_choice() {
    // The common choice is p ∝ sech²(0.0072 (λ − 538)) (Radziszewski et al. 2009), drawn by the
    // inverse of its distribution function.
    let end = |lambda: f64| {
        let e = float64::exp(2.0 * 0.0072 * (lambda - 538.0));
        (e - 1.0) / (e + 1.0)
    };
    let (low, high) = (end(360.0), end(830.0));
    let common: Vec<Wavelengths> = (0..4096)
        .map(|i| {
            let u = (f64::from(i) + 0.5) / 16384.0;
            let lanes: [[f64; 2]; 4] = std::array::from_fn(|j| {
                let tanh = low + (high - low) * (u + 0.25 * j as f64);
                let lambda = 538.0 + float64::atanh(tanh) / 0.0072;
                [lambda, 0.0072 * (1.0 - tanh * tanh) / (high - low)]
            });
            Wavelengths {
                lambda: Vec4::from_array(lanes.map(|l| l[0] as f32)),
                density: Vec4::from_array(lanes.map(|l| l[1] as f32)),
            }
        })
        .collect();
    let ours = stratified(&WavelengthDistribution::default(), 4096);
    let surface = |rgb: [f64; 3]| RgbSpectrum::bounded(rgb).expect("components in [0, 1]");
    let mut sums = [0.0; 2];
    for rgb in [
        [1.0; 3],
        [0.63, 0.065, 0.05],
        [0.14, 0.45, 0.091],
        [0.725, 0.71, 0.68],
        [0.1, 0.2, 0.9],
    ] {
        let colour = surface(rgb);
        for light in [illuminants::d65, illuminants::a] {
            let seen =
                |lambda: f64| light(lambda) * f64::from(colour.eval(Vec4::splat(lambda as f32)).x);
            sums[0] += relative_variance(&common, seen);
            sums[1] += relative_variance(&ours, seen);
        }
    }
    println!(
        "relative variance: sech² {}, ours {}",
        sums[0] / 10.0,
        sums[1] / 10.0
    );
    assert!(sums[1] < 0.15 * sums[0], "{sums:?}");
}

#[test]
fn the_response_integrates_to_the_colour_of_the_light() {
    let draws = stratified(&WavelengthDistribution::default(), 1 << 14);
    let mut mean = glam::DVec3::ZERO;
    for w in &draws {
        let light = w
            .lambda
            .to_array()
            .map(|l| illuminants::d65(f64::from(l)) as f32 / 4.0);
        mean += sensor_response(w).rgb(Vec4::from_array(light)).as_dvec3() / draws.len() as f64;
    }
    assert!(
        (mean - glam::DVec3::ONE).abs().max_element() < 1e-4,
        "{mean}"
    );
    assert_eq!(
        sensor::response(Vec4::new(359.0, 831.0, f32::NAN, -1.0)),
        [Vec4::ZERO; 4]
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn any_range_is_tiled(min in 1.0_f64..2000.0, width in 0.1_f64..3000.0, u in 0.0_f32..1.0) {
        let distribution = WavelengthDistribution::new(min, min + width).expect("a valid range");
        let w = distribution.sample(u);
        prop_assert!(w.density.is_finite() && w.density.min_element() > 0.0);
        prop_assert!(w.lambda.min_element() >= min as f32);
        prop_assert!(f64::from(w.lambda.max_element()) <= (min + width) * 1.000_001);
    }
}
