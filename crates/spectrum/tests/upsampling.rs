//! Smooth spectra for RGB colours: the fit, the table of the repository, and the round trip back to
//! RGB.

use etalon_spectrum::upsample::fit::Fitter;
use etalon_spectrum::upsample::table;
use etalon_spectrum::{RgbCoefficients, RgbSpectrum, Spectrum};
use glam::Vec4;
use proptest::prelude::*;

/// Linear Rec. 709 of the spectrum with these coefficients, lit by D65.
fn round_trip(fitter: &Fitter, coefficients: RgbCoefficients) -> [f64; 3] {
    fitter.rgb(coefficients.0.map(f64::from))
}

fn greatest_difference(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f64::max)
}

/// The cube of colours in steps of 1/n, corners and edges included.
fn cube(n: usize) -> impl Iterator<Item = [f32; 3]> {
    (0..(n + 1).pow(3)).map(move |i| {
        let at = |stride: usize| ((i / stride) % (n + 1)) as f32 / n as f32;
        [at(1), at(n + 1), at((n + 1) * (n + 1))]
    })
}

#[test]
fn every_colour_of_rec709_has_an_exact_spectrum() {
    let fitter = Fitter::new();
    for rgb in cube(6) {
        let rgb = rgb.map(f64::from);
        if rgb == [0.0; 3] || rgb == [1.0; 3] {
            continue;
        }
        let fit = fitter.fit(rgb, [0.0; 3]);
        assert!(fit.difference < 1e-6, "{rgb:?}: {fit:?}");
        assert!(greatest_difference(fitter.rgb(fit.coefficients), rgb) < 1e-8);
    }
}

#[test]
fn the_shipped_table_is_what_the_fit_gives() {
    let shipped: &[f32] = bytemuck::cast_slice(AlignedTable::BYTES);
    assert_eq!(shipped.len(), table::LENGTH);
    let fitter = Fitter::new();
    let n = table::RESOLUTION;
    let mut checked = 0;
    for brightest in 0..3 {
        // Below k = 3, under 10⁻⁵, the valley the fit follows is too flat for a second start.
        for k in (3..n).step_by(6) {
            for j in (0..n).step_by(7) {
                for i in (0..n).step_by(9) {
                    let rgb = table::node_colour(brightest, [k, j, i]);
                    let max = rgb[brightest];
                    let min = rgb[0].min(rgb[1]).min(rgb[2]);
                    // Look-ups only reach nodes near max + min ≤ 1.
                    if max + min > 1.1 {
                        continue;
                    }
                    let at = 3 * (((brightest * n + k) * n + j) * n + i);
                    let root = max.sqrt();
                    // The fit begun elsewhere must end in the same place.
                    let start = [shipped[at], shipped[at + 1], shipped[at + 2]]
                        .map(|c| f64::from(c) / root * 0.9);
                    let found = fitter.fit(rgb, start).coefficients;
                    for c in 0..3 {
                        let (a, b) = (f64::from(shipped[at + c]), found[c] * root);
                        assert!((a - b).abs() <= 1e-5 * (1.0 + b.abs()), "{rgb:?}: {a} {b}");
                    }
                    checked += 1;
                }
            }
        }
    }
    assert!(checked > 300, "{checked}");
}

/// The file of the repository, aligned to be read as numbers.
#[repr(C, align(4))]
struct AlignedTable<T: ?Sized>(T);

impl AlignedTable<[u8; 4 * table::LENGTH]> {
    const BYTES: &'static [u8] = {
        static TABLE: &AlignedTable<[u8; 4 * table::LENGTH]> =
            &AlignedTable(*include_bytes!("../data/rgb2spec.bin"));
        &TABLE.0
    };
}

#[test]
fn the_round_trip_is_close_for_every_colour() {
    let fitter = Fitter::new();
    let mut worst = 0.0_f64;
    let mut differences: Vec<f64> = cube(24)
        .map(|rgb| {
            let back = round_trip(&fitter, RgbCoefficients::from_rgb(rgb));
            let difference = greatest_difference(back, rgb.map(f64::from));
            worst = worst.max(difference);
            difference
        })
        .collect();
    differences.sort_by(f64::total_cmp);
    let typical = differences[differences.len() * 9 / 10];
    println!("round trip over the cube: worst {worst:.2e}, 90 % below {typical:.2e}");
    assert!(worst < 1.6e-3 && typical < 5e-6, "{worst} {typical}");
}

#[test]
fn dark_colours_keep_their_ratios() {
    // Errors relative to the brightest component; the last shade is the darkest of 8-bit sRGB.
    let fitter = Fitter::new();
    for (shade, bound) in [(1e-1, 1e-4), (1e-2, 1e-3), (1e-3, 2e-3), (3.035e-4, 1e-2)] {
        let mut worst = 0.0_f64;
        for rgb in cube(8) {
            let brightest = rgb[0].max(rgb[1]).max(rgb[2]);
            if brightest == 0.0 {
                continue;
            }
            let dark = rgb.map(|v| v / brightest * shade);
            let back = round_trip(&fitter, RgbCoefficients::from_rgb(dark));
            let error = greatest_difference(back, dark.map(f64::from)) / f64::from(shade);
            worst = worst.max(error);
        }
        println!("shade {shade}: {worst:.2e}");
        assert!(worst < bound, "{shade}: {worst}");
    }
}

#[test]
fn greys_are_constant_and_exact() {
    let lambda = Vec4::new(360.0, 444.4, 555.5, 830.0);
    for i in 0..=255 {
        let value = i as f32 / 255.0;
        let found = RgbCoefficients::from_rgb([value; 3]).eval(lambda);
        assert!(
            (found - value).abs().max_element() <= 1e-6 * value,
            "{found} {value}"
        );
    }
    assert_eq!(RgbCoefficients::from_rgb([0.0; 3]).eval(lambda), Vec4::ZERO);
    assert_eq!(RgbCoefficients::from_rgb([1.0; 3]).eval(lambda), Vec4::ONE);
    assert_eq!(
        RgbCoefficients::from_rgb([f32::NAN, -1.0, 0.0]).eval(lambda),
        Vec4::ZERO
    );
    assert_eq!(
        RgbCoefficients::from_rgb([2.0, 1.0, 1.0]).eval(lambda),
        Vec4::ONE
    );
    assert_eq!(RgbSpectrum::WHITE.eval(lambda), Vec4::ONE);
}

#[test]
fn unbounded_colours_scale() {
    let dim = RgbSpectrum::unbounded([0.5, 0.25, 0.1]).expect("components of 0 or more");
    let bright = RgbSpectrum::unbounded([500.0, 250.0, 100.0]).expect("components of 0 or more");
    let lambda = Vec4::new(400.0, 500.0, 600.0, 700.0);
    let ratio = bright.eval(lambda) / dim.eval(lambda);
    assert!((ratio - 1000.0).abs().max_element() < 0.01, "{ratio}");
    assert_eq!(bright.scale(), 1000.0);
    assert!(
        RgbSpectrum::unbounded([0.0; 3])
            .expect("black is a colour")
            .is_black()
    );
    assert!(!dim.is_black());
    for bad in [
        [-0.1, 0.0, 0.0],
        [0.0, f64::NAN, 0.0],
        [0.0, 0.0, f64::INFINITY],
    ] {
        assert!(RgbSpectrum::unbounded(bad).is_err() && RgbSpectrum::bounded(bad).is_err());
    }
    assert!(RgbSpectrum::bounded([0.0, 1.01, 0.0]).is_err());
}

#[test]
fn reflectances_match_those_of_mitsuba() {
    // `srgb` evaluated by Mitsuba 3.9.1 in `scalar_spectral`; its table interpolates linearly
    // and round-trips within 0.001, which bounds how near two correct tables can be.
    for (rgb, values) in MITSUBA {
        let spectrum = Spectrum::reflectance(rgb).expect("components in [0, 1]");
        for (i, value) in values.iter().enumerate() {
            let lambda = 400.0 + 50.0 * i as f64;
            let found = spectrum.eval_at(lambda);
            assert!(
                (found - value).abs() < 3e-3,
                "{rgb:?} at {lambda} nm: {found} {value}"
            );
        }
    }
}

/// Colours and Mitsuba's reflectances at 400, 450, … 700 nm.
const MITSUBA: [([f64; 3], [f64; 7]); 8] = [
    (
        [0.630000, 0.065000, 0.050000],
        [0.1193, 0.0595, 0.0548, 0.0876, 0.3275, 0.8980, 0.9817],
    ),
    (
        [0.140000, 0.450000, 0.091000],
        [0.0233, 0.0950, 0.3326, 0.4591, 0.2550, 0.0632, 0.0166],
    ),
    (
        [0.725000, 0.710000, 0.680000],
        [0.6613, 0.6827, 0.6992, 0.7112, 0.7193, 0.7236, 0.7243],
    ),
    (
        [0.100000, 0.200000, 0.900000],
        [0.9725, 0.8760, 0.4500, 0.1790, 0.1347, 0.1882, 0.4895],
    ),
    (
        [0.511822, 0.950464, 0.144160],
        [0.0123, 0.1131, 0.7887, 0.9028, 0.7959, 0.1202, 0.0127],
    ),
    (
        [0.948649, 0.311831, 0.423326],
        [0.8136, 0.4194, 0.2621, 0.3445, 0.7154, 0.9411, 0.9840],
    ),
    (
        [0.827703, 0.409199, 0.549594],
        [0.8083, 0.5481, 0.3980, 0.4347, 0.6551, 0.8795, 0.9612],
    ),
    (
        [0.027559, 0.753513, 0.538143],
        [0.1069, 0.5463, 0.7811, 0.7195, 0.2834, 0.0438, 0.0107],
    ),
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(3), ..ProptestConfig::default() })]

    #[test]
    fn spectra_stay_in_the_unit_interval(r in 0.0_f32..=1.0, g in 0.0_f32..=1.0, b in 0.0_f32..=1.0,
                                         lambda in 300.0_f32..900.0) {
        let value = RgbCoefficients::from_rgb([r, g, b]).eval(Vec4::splat(lambda));
        prop_assert!(value.min_element() >= 0.0 && value.max_element() <= 1.0);
    }

    #[test]
    fn complements_sum_to_one(r in 0.0_f32..=1.0, g in 0.0_f32..=1.0, b in 0.0_f32..=1.0) {
        let lambda = Vec4::new(380.0, 480.0, 580.0, 680.0);
        let here = RgbCoefficients::from_rgb([r, g, b]).eval(lambda);
        let there = RgbCoefficients::from_rgb([1.0 - r, 1.0 - g, 1.0 - b]).eval(lambda);
        prop_assert!((here + there - 1.0).abs().max_element() < 1e-4);
    }

    #[test]
    fn neighbouring_colours_have_neighbouring_spectra(r in 0.0_f32..0.99, g in 0.0_f32..0.99, b in 0.0_f32..0.99) {
        let lambda = Vec4::new(430.0, 500.0, 570.0, 640.0);
        let here = RgbCoefficients::from_rgb([r, g, b]).eval(lambda);
        let there = RgbCoefficients::from_rgb([r + 1e-4, g, b]).eval(lambda);
        prop_assert!((here - there).abs().max_element() < 0.02);
    }
}
