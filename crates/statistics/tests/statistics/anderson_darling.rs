//! The Anderson–Darling test against 40-digit integrals, published points and simulation.

// Reference values keep the digits they were computed to.
#![allow(clippy::excessive_precision)]

use crate::checks::near;
use etalon_statistics::{anderson_darling, normal};

/// Smirnov's integrals by mpmath 1.4 (`quad`, 40 digits); Anderson & Darling (1954) give 1.933,
/// 2.492 and 3.857 for 10, 5 and 1 %.
#[test]
fn the_limit() {
    for (z, tail) in [
        (0.3, 0.938_157_636_057_123_047_39),
        (0.774, 0.500_160_751_784_866_103_82),
        (1.933, 0.099_994_623_208_223_498_656),
        (2.492, 0.050_022_186_359_607_866_155),
        (3.07, 0.025_218_271_136_978_747_272),
        (3.857, 0.010_241_153_229_861_210_098),
        (10.0, 1.381_503_541_068_586_412_8e-5),
        (25.0, 2.695_138_623_922_303_560_4e-12),
    ] {
        near(anderson_darling::limit_sf(z), tail, 1e-11);
    }
    assert_eq!(anderson_darling::limit_sf(0.0), 1.0);
    near(anderson_darling::limit_sf(0.04), 1.0, 1e-10);
}

/// Two million samples by NumPy's PCG64, seed 1: three standard errors, plus the correction's own
/// error. In the far tail the correction is good to its relative error of about 1/n.
#[test]
fn small_samples() {
    for (n, rows) in [
        (
            5,
            [
                (0.3, 0.937_282, 4e-4),
                (0.6, 0.638_701, 4e-4),
                (1.0, 0.352_762, 4e-4),
                (1.5, 0.177_147, 4e-4),
                (2.5, 0.052_036, 4e-4),
                (6.0, 1.1205e-3, 2e-4),
            ],
        ),
        (
            10,
            [
                (0.3, 0.937_299, 7e-4),
                (0.6, 0.643_740, 11e-4),
                (1.0, 0.355_061, 11e-4),
                (1.5, 0.176_689, 9e-4),
                (2.5, 0.050_685, 5e-4),
                (6.0, 1.0510e-3, 1e-4),
            ],
        ),
        (
            40,
            [
                (0.3, 0.937_991, 6e-4),
                (0.6, 0.646_959, 11e-4),
                (1.0, 0.356_262, 11e-4),
                (1.5, 0.176_165, 9e-4),
                (2.5, 0.049_715, 5e-4),
                (6.0, 9.615e-4, 7e-5),
            ],
        ),
    ] {
        for (z, tail, error) in rows {
            let actual = anderson_darling::sf(z, n);
            assert!((actual - tail).abs() <= error, "{n} {z}: {actual} {tail}");
        }
    }
    // One observation: P(A² > z) = 1 − √(1 − 4 e^(−1−z)).
    near(
        anderson_darling::sf(1.0, 1),
        0.322_756_419_702_962_978_01,
        1e-12,
    );
    assert_eq!(anderson_darling::sf(0.3, 1), 1.0);
}

#[test]
fn samples() {
    // −2 − ½ [ln ¼ + ln ¼ + 3 (ln ¾ + ln ¾)] = −2 + ln 4 − 3 ln ¾, by hand.
    let tested = anderson_darling::test_uniform(&[0.75, 0.25]).expect("in range");
    near(tested.statistic, 0.249_340_578_475_233_7, 1e-13);
    let impossible = anderson_darling::test_uniform(&[0.0, 0.5]).expect("in range");
    assert_eq!(impossible.statistic, f64::INFINITY);
    assert_eq!(impossible.p_value, 0.0);
    assert_eq!(anderson_darling::test_uniform(&[]), None);
    assert_eq!(anderson_darling::test_uniform(&[1.5]), None);
    assert_eq!(anderson_darling::test_uniform(&[f64::NAN]), None);

    // Nine standard deviations: 1 − Φ would be zero, the upper tail is not.
    let normals = [9.0, -0.5, 0.5];
    let tested =
        anderson_darling::test(&normals, |x| normal::sf(-x), normal::sf).expect("in range");
    assert!(tested.statistic.is_finite() && tested.p_value < 1e-3);
}

/// The test is calibrated (α = 0.01 in 4,000 samples of 100; binomial 99.9 % bounds 20 … 62), and
/// rejects the mutant "u is u^1.5" in at least half of the samples at the same level.
#[test]
fn false_alarms_and_a_mutant() {
    let mut state = 1_u64;
    let mut uniform = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (mut alarms, mut caught) = (0, 0);
    for _ in 0..4000 {
        let sample: Vec<f64> = (0..100).map(|_| uniform()).collect();
        let bent: Vec<f64> = sample.iter().map(|u| libm::pow(*u, 1.5)).collect();
        let p = |sample: &[f64]| {
            anderson_darling::test_uniform(sample)
                .expect("in range")
                .p_value
        };
        alarms += usize::from(p(&sample) <= 0.01);
        caught += usize::from(p(&bent) <= 0.01);
    }
    assert!((20..=62).contains(&alarms), "{alarms}");
    assert!(caught > 2000, "{caught}");
}
