//! Spectra, illuminants and colour spaces against published numbers, and the radiometric scale
//! against values measured with Mitsuba 3.9.1 (a constant emitter seen directly; ± 0.001, and rounded
//! to 0.001).

use etalon_spectrum::{Spectrum, blackbody, cie, colour_space, illuminants};

/// Chromaticity (x, y) of a radiance.
fn chromaticity(spectrum: impl Fn(f64) -> f64) -> [f64; 2] {
    let [x, y, _] = colour_space::xyz_to_xyy(cie::xyz(spectrum));
    [x, y]
}

fn assert_near(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (f, e) in found.iter().zip(expected) {
        assert!(
            (f - e).abs() <= tolerance,
            "{found:?} instead of {expected:?}"
        );
    }
}

#[test]
fn illuminants_have_their_published_chromaticities() {
    // CIE 015:2018, tables of chromaticities for the 2° observer.
    assert_near(&chromaticity(illuminants::d65), &[0.312_72, 0.329_03], 2e-5);
    assert_near(&chromaticity(illuminants::a), &[0.447_58, 0.407_45], 2e-5);
    assert_near(&chromaticity(illuminants::e), &[0.333_31, 0.333_29], 4e-5);
    let published = [
        [0.3131, 0.3371],
        [0.3721, 0.3751],
        [0.4091, 0.3941],
        [0.4402, 0.4031],
        [0.3138, 0.3452],
        [0.3779, 0.3882],
        [0.3129, 0.3292],
        [0.3458, 0.3586],
        [0.3741, 0.3727],
        [0.3458, 0.3588],
        [0.3805, 0.3769],
        [0.4370, 0.4042],
    ];
    for (i, expected) in published.iter().enumerate() {
        let spectrum = Spectrum::from(illuminants::fluorescent(i + 1).expect("F1 to F12 exist"));
        let found = chromaticity(|lambda| spectrum.eval_at(lambda));
        assert_near(&found, expected, 3e-4);
        assert_near(&[spectrum.luminance()], &[1.0], 1e-5);
    }
    assert!(illuminants::fluorescent(0).is_none() && illuminants::fluorescent(13).is_none());
}

#[test]
fn illuminants_have_unit_luminance() {
    for light in [illuminants::d65, illuminants::a, illuminants::e] {
        assert_near(&[cie::luminance(light)], &[1.0], 1e-9);
    }
    // The shape of D65 is the table's: 100 at 560 nm, 63.3828 at 780 nm.
    let ratio = illuminants::d65(780.0) / illuminants::d65(560.0);
    assert_near(&[ratio], &[0.633_828], 1e-9);
    assert_eq!(illuminants::d65(359.9), 0.0);
    assert_eq!(illuminants::d65(830.1), 0.0);
}

#[test]
fn black_bodies_follow_planck() {
    // Chromaticities of the Planckian locus (Wyszecki and Stiles 1982, table 1(3.11)).
    for (temperature, expected) in [
        (2000.0, [0.5267, 0.4133]),
        (3000.0, [0.4369, 0.4041]),
        (5000.0, [0.3451, 0.3516]),
        (10000.0, [0.2807, 0.2884]),
    ] {
        let found = chromaticity(|lambda| blackbody::radiance(lambda, temperature));
        assert_near(&found, &expected, 2e-4);
    }
    // Wien: the maximum of the radiance per wavelength lies at 2 897 771.955 nm K / T.
    let peak = 2_897_771.955 / 6000.0;
    let at = |lambda: f64| blackbody::radiance(lambda, 6000.0);
    assert!(at(peak) > at(peak - 0.5) && at(peak) > at(peak + 0.5));
    // Stefan and Boltzmann: ∫ L dλ = σ T⁴ / π, here to 100 µm.
    let integral: f64 = (0..1_000_000)
        .map(|i| blackbody::radiance(0.05 + 0.1 * f64::from(i), 6000.0) * 0.1)
        .sum();
    let expected = 5.670_374_419e-8 * 6000.0_f64.powi(4) / std::f64::consts::PI;
    assert!((integral / expected - 1.0).abs() < 1e-5);
}

#[test]
fn the_table_of_a_black_body_is_fine_enough() {
    for temperature in [500.0, 1000.0, 6000.0, 20_000.0] {
        let body = Spectrum::blackbody(temperature).expect("a valid temperature");
        for i in 0..4699 {
            let lambda = 360.0 + 0.1 * f64::from(i);
            let exact = blackbody::radiance(f64::from(lambda as f32), temperature);
            let ratio = body.eval_at(lambda) / exact;
            assert!(
                (ratio - 1.0).abs() < 1e-4,
                "{temperature} K, {lambda} nm: {ratio}"
            );
        }
        assert_eq!(body.eval_at(359.0), 0.0);
        assert_eq!(body.eval_at(831.0), 0.0);
    }
}

#[test]
fn radiances_have_mitsubas_scale() {
    let emission = |rgb| Spectrum::emission(rgb).expect("components of 0 or more");
    let uniform = Spectrum::uniform(1.0).expect("a finite value");
    let irregular = Spectrum::irregular(&[400.0, 500.0, 600.0, 700.0], &[0.0, 8.0, 15.6, 18.4])
        .expect("increasing wavelengths");
    let d65 = Spectrum::d65(1.0).expect("a finite scale");
    assert_near(&d65.rgb(), &[1.0, 1.0, 1.0], 1e-6);
    assert_near(&emission([1.0; 3]).rgb(), &[1.0, 1.0, 0.999], 1.5e-3);
    assert_near(&emission([0.2, 0.5, 0.8]).rgb(), &[0.2, 0.5, 0.799], 1.5e-3);
    assert_near(
        &emission([2.0, 0.1, 0.1]).rgb(),
        &[2.0, 0.099, 0.099],
        1.5e-3,
    );
    assert_near(&uniform.rgb(), &[1.206, 0.949, 0.910], 1e-3);
    // The last two are larger numbers: a thousandth of their largest component.
    assert_near(&irregular.rgb(), &[20.734, 10.865, 2.772], 0.02);
    let body = Spectrum::blackbody(6000.0).expect("a valid temperature");
    assert_near(&body.rgb(), &[32721.0, 29404.0, 28631.0], 33.0);
}

#[test]
fn matrices_are_those_of_the_standards() {
    // IEC 61966-2-1, XYZ to linear sRGB, rounded there to four digits.
    let published = [
        [3.2406, -1.5372, -0.4986],
        [-0.9689, 1.8758, 0.0415],
        [0.0557, -0.2040, 1.0570],
    ];
    for (row, expected) in colour_space::XYZ_TO_RGB.iter().zip(&published) {
        assert_near(row, expected, 4e-4);
    }
    assert_near(
        &colour_space::LUMINANCE_WEIGHTS,
        &[0.2126, 0.7152, 0.0722],
        1e-4,
    );
    assert_near(&colour_space::WHITE, &[0.9505, 1.0, 1.0890], 5e-4);
    assert_near(
        &colour_space::xyz_to_rgb(colour_space::WHITE),
        &[1.0; 3],
        1e-14,
    );
    for (i, primary) in colour_space::PRIMARIES.iter().enumerate() {
        let mut rgb = [0.0; 3];
        rgb[i] = 0.7;
        let xyz = colour_space::rgb_to_xyz(rgb);
        let [x, y, _] = colour_space::xyz_to_xyy(xyz);
        assert_near(&[x, y], primary, 1e-12);
        assert_near(&colour_space::xyz_to_rgb(xyz), &rgb, 1e-12);
    }
    assert_eq!(colour_space::xyz_to_xyy([0.0; 3])[2], 0.0);
}

#[test]
fn the_curve_of_srgb_is_continuous_and_inverts() {
    assert_near(&[colour_space::srgb_to_linear(0.5)], &[0.214_041_14], 1e-8);
    assert_near(&[colour_space::linear_to_srgb(0.5)], &[0.735_356_98], 1e-8);
    for i in -100..=150 {
        let encoded = f64::from(i) / 100.0;
        let back = colour_space::linear_to_srgb(colour_space::srgb_to_linear(encoded));
        assert_near(&[back], &[encoded], 1e-7);
    }
}
