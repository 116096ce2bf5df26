//! Power against 40-digit quadrature (mpmath 1.4, `quad` of the integrals in the
//! modules' heads, quantiles by `findroot`) and published values.

// Reference values keep the digits they were computed to.
#![allow(clippy::excessive_precision)]

use crate::checks::near;
use etalon_statistics::{Estimate, noncentral_t, normal, power, student_t};
use proptest::prelude::*;

#[test]
fn noncentral_t_tails() {
    for (t, df, delta, tail) in [
        (2.0, 7.0, 1.0, 0.205_494_988_338_983_237_37),
        (
            2.364_624_251_592_785,
            7.0,
            3.0,
            0.730_628_288_626_270_944_27,
        ),
        (-1.0, 7.0, 2.0, 0.997_972_284_008_350_72),
        (5.0, 3.0, 0.5, 0.017_844_831_755_383_096),
        (2.0, 1.0, 1.0, 0.377_128_035_539_718_35),
        (3.0, 30.0, 2.0, 0.181_512_050_012_040_45),
        (3.5, 30.7, -1.0, 1.987_912_910_766_854_8e-5),
        (4.0, 200.0, 5.0, 0.837_812_218_179_876_68),
        (12.706_204_736_174_705, 1.0, 20.0, 0.883_394_442_933_034_8),
    ] {
        near(noncentral_t::sf(t, df, delta), tail, 1e-12);
    }
    // No effect: Student's t, into the tails.
    for (t, df) in [
        (0.0, 4.0),
        (2.0, 7.0),
        (9.0, 63.0),
        (-3.0, 2.5),
        (700.0, 2.0),
    ] {
        near(noncentral_t::sf(t, df, 0.0), student_t::sf(t, df), 1e-11);
    }
    near(noncentral_t::sf(0.0, 5.0, 1.5), normal::sf(-1.5), 1e-12);
    near(noncentral_t::sf(2.0, 1e9, 1.0), normal::sf(1.0), 1e-12);
    near(noncentral_t::sf(2.0, 9e5, 1.0), normal::sf(1.0), 1e-5);
    assert_eq!(noncentral_t::sf(f64::INFINITY, 3.0, 1.0), 0.0);
    assert!(noncentral_t::sf(f64::NAN, 3.0, 1.0).is_nan());
    assert!(noncentral_t::sf(1.0, 0.0, 1.0).is_nan());
}

#[test]
fn power_of_the_t_test() {
    // R's `power.t.test(n = 20, delta = 1, sd = 1)` documents 0.8689528.
    near(
        power::two_sided(10.0_f64.sqrt(), 38.0, 0.05),
        0.868_953_027_723_989_724_92,
        1e-12,
    );
    // Cohen (1988): d = 0.5 needs 64 on each side, or 34 pairs, for a power of 0.80.
    near(
        power::two_sided(0.5 * 32.0_f64.sqrt(), 126.0, 0.05),
        0.801_459_557_922_254_08,
        1e-12,
    );
    near(
        power::two_sided(0.5 * 34.0_f64.sqrt(), 33.0, 0.05),
        0.807_777_501_279_273_906_38,
        1e-12,
    );
    near(
        power::two_sided(15.0, 7.0, 1e-5),
        0.905_322_495_340_933_815_21,
        1e-11,
    );
    // Nothing there: the power is the level.
    near(power::two_sided(0.0, 9.0, 0.01), 0.01, 1e-11);
}

#[test]
fn detectable_effects() {
    for (df, alpha, wanted, effect) in [
        (7.0, 0.01, 0.9, 5.129_937_964_726_588_367_9),
        (14.0, 1e-5, 0.9, 8.662_160_917_304_984_621),
        (62.0, 0.05, 0.8, 2.845_919_744_346_232_236_9),
        (3.0, 0.01, 0.5, 5.217_818_192_487_677_453_8),
    ] {
        near(power::detectable(df, alpha, wanted), effect, 1e-10);
    }
    // Known errors: z₀.₀₀₅ + z₀.₁, but for the far side's 10⁻¹⁰.
    near(
        power::detectable(f64::INFINITY, 0.01, 0.9),
        2.575_829_303_548_900_8 + 1.281_551_565_544_600_5,
        1e-9,
    );
    let estimate = Estimate::new(0.0, 0.5, 7.0).expect("finite");
    near(
        estimate.smallest_detectable(0.01, 0.9),
        0.5 * 5.129_937_964_726_588_367_9,
        1e-10,
    );
    assert!(power::detectable(7.0, 0.9, 0.5).is_nan());
    assert!(power::detectable(0.0, 0.01, 0.5).is_nan());
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 64,
        rng_seed: proptest::test_runner::RngSeed::Fixed(17),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// More effect, more degrees of freedom or a laxer level: more power.
    #[test]
    fn power_grows(delta in 0.0..8.0_f64, df in 1.0..60.0_f64, alpha in 1e-4..0.2_f64) {
        let base = power::two_sided(delta, df, alpha);
        prop_assert!(power::two_sided(delta + 0.5, df, alpha) > base);
        prop_assert!(power::two_sided(delta, df, alpha * 1.1) > base);
        prop_assert!(power::two_sided(delta + 1.0, df * 2.0, alpha) > base);
        let mirrored = 1.0 - noncentral_t::sf(-1.0, df, -delta);
        prop_assert!((noncentral_t::sf(1.0, df, delta) - mirrored).abs() < 1e-12);
    }
}
