//! Tails and quantiles against 40-digit computations (mpmath 1.3, `betainc`, `erfc`,
//! `gammainc`, `findroot`).

// Reference values keep the digits they were computed to.
#![allow(clippy::excessive_precision)]

use crate::checks::near;
use etalon_statistics::{chi_squared, normal, student_t};

#[test]
fn normal_tails() {
    for (z, tail) in [
        (0.1, 0.460_172_162_722_971_016_33),
        (1.0, 0.158_655_253_931_457_051_41),
        (1.96, 0.024_997_895_148_220_436_213),
        (8.0, 6.220_960_574_271_784_123_5e-16),
        (20.0, 2.753_624_118_606_233_695_1e-89),
        (37.0, 5.725_571_222_524_576_822_7e-300),
    ] {
        near(normal::sf(z), tail, 1e-13);
        near(normal::sf(-z), 1.0 - tail, 1e-15);
    }
}

#[test]
fn normal_quantiles() {
    for (tail, z) in [
        (0.4, 0.253_347_103_135_799_741_32),
        (0.025, 1.959_963_984_540_054_211_8),
        (1e-3, 3.090_232_306_167_813_535_4),
        (1e-10, 6.361_340_902_404_056_199_1),
        (1e-100, 21.273_453_560_965_324_294),
    ] {
        near(normal::upper_quantile(tail), z, 1e-14);
    }
    near(
        normal::upper_quantile(0.975),
        -1.959_963_984_540_054_2,
        1e-14,
    );
    assert_eq!(normal::upper_quantile(0.0), f64::INFINITY);
    assert_eq!(normal::upper_quantile(1.0), f64::NEG_INFINITY);
    assert_eq!(normal::upper_quantile(0.5).abs(), 0.0);
    assert!(normal::upper_quantile(-0.1).is_nan());
    assert!(normal::upper_quantile(f64::NAN).is_nan());
}

#[test]
fn student_tails() {
    for (t, df, tail, error) in [
        (1.0, 1.0, 0.25, 1e-13),
        (0.5, 2.5, 0.328_848_959_934_857_344_67, 1e-13),
        (2.5, 7.0, 0.020_496_109_292_876_448_445, 1e-13),
        (9.0, 63.0, 3.237_498_116_001_538_009_5e-13, 1e-12),
        (30.0, 3.7, 7.428_520_626_176_010_970_9e-6, 1e-13),
        (8.0, 1000.0, 1.713_330_741_195_737_198_7e-15, 1e-12),
        (12.0, 1e5, 1.872_252_905_978_175_473_1e-33, 1e-10),
        (8.0, 1e9, 6.220_967_140e-16, 2e-6),
    ] {
        near(student_t::sf(t, df), tail, error);
        near(student_t::sf(-t, df), 1.0 - tail, 1e-13);
        near(student_t::two_sided(-t, df), 2.0 * tail, error);
    }
    assert_eq!(student_t::sf(f64::INFINITY, 3.0), 0.0);
    assert_eq!(student_t::sf(f64::NEG_INFINITY, 3.0), 1.0);
    assert!(student_t::sf(f64::NAN, 3.0).is_nan());
    assert!(student_t::sf(1.0, 0.0).is_nan());
    assert!(student_t::sf(1.0, f64::NAN).is_nan());
}

#[test]
fn student_quantiles() {
    for (tail, df, t) in [
        (0.025, 1.0, 12.706_204_736_174_703_938),
        (0.025, 7.0, 2.364_624_251_592_785_303_9),
        (1e-6, 7.0, 14.241_469_651_981_445_972),
        (5e-7, 38.6, 5.805_046_874_884_828_1),
        (0.005, 2.2, 8.534_715_279_807_731_756_7),
        (1e-9, 1000.0, 6.053_690_272_079_833_574_6),
        (0.3, 4.0, 0.568_649_063_049_705_480_11),
        (1e-5, 1.0, 31_830.988_607_907_089_037),
    ] {
        near(student_t::upper_quantile(tail, df), t, 2e-12);
        // 1 − tail keeps enough digits of large tails only.
        if tail > 1e-3 {
            near(student_t::upper_quantile(1.0 - tail, df), -t, 1e-11);
        }
    }
    near(
        student_t::upper_quantile(0.025, f64::INFINITY),
        1.959_963_984_540_054,
        1e-14,
    );
    assert_eq!(student_t::upper_quantile(0.5, 3.0), 0.0);
    assert_eq!(student_t::upper_quantile(0.0, 3.0), f64::INFINITY);
    assert!(student_t::upper_quantile(0.1, -1.0).is_nan());
}

#[test]
fn chi_squared_tails() {
    for (x, df, tail) in [
        (1.0, 1.0, 0.317_310_507_862_914_102_83),
        (3.84, 1.0, 0.050_043_521_248_705_103_189),
        (20.0, 10.0, 0.029_252_688_076_961_072_673),
        (500.0, 255.0, 4.384_961_916_799_651_047_9e-18),
        (5.0, 30.0, 0.999_999_930_846_861_330_07),
        (1500.0, 1000.0, 1.045_464_038_597_965_729_4e-22),
    ] {
        near(chi_squared::sf(x, df), tail, 1e-12);
    }
    assert_eq!(chi_squared::sf(0.0, 3.0), 1.0);
    assert_eq!(chi_squared::sf(f64::INFINITY, 3.0), 0.0);
    assert!(chi_squared::sf(f64::NAN, 3.0).is_nan());
    assert!(chi_squared::sf(1.0, 0.0).is_nan());
}
