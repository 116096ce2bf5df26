//! The greatest error of each elementary function, beside double precision.

use etalon_math::lane::*;
use etalon_math::{float, float64};

/// Every how manieth encoding is tried: a prime, so that all lowest bits occur.
const STRIDE: usize = 509;

/// Numbers from all over `f32`, except NaN.
fn numbers() -> impl Iterator<Item = f32> {
    (0..=u32::MAX)
        .step_by(STRIDE)
        .map(f32::from_bits)
        .filter(|x| !x.is_nan())
}

/// How many units in the last place `got` is away from `exact`. Infinity counts as 2¹²⁸.
fn error(got: f32, exact: f64) -> f64 {
    let bounded = |x: f64| x.clamp(-f64::powi(2.0, 128), f64::powi(2.0, 128));
    let error = (bounded(got.into()) - bounded(exact)).abs() / ulp(exact);
    if error.is_nan() { f64::INFINITY } else { error }
}

/// The spacing of single-precision numbers at `x`.
fn ulp(x: f64) -> f64 {
    let x = x
        .abs()
        .clamp(f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX));
    f64::from_bits(((x.to_bits() >> 52) - 23) << 52)
}

/// The greatest error of `function` over `numbers`, and where.
fn worst(
    numbers: impl Iterator<Item = f32>,
    function: impl Fn(f32) -> f32,
    exact: impl Fn(f64) -> f64,
) -> (f64, f32) {
    numbers
        .map(|x| (error(function(x), exact(f64::from(x))), x))
        .fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a })
}

#[track_caller]
fn assert_within(bound: f64, (error, x): (f64, f32)) {
    assert!(error < bound, "{error} ulp at {x:e}, not {bound}");
}

#[test]
fn exponentials() {
    assert_within(1.1, worst(numbers(), exp, float64::exp));
    assert!(exp(f32::NAN).is_nan());
}

#[test]
fn exponentials_are_those_of_four() {
    for i in 0..1 << 20 {
        let x = -87.0 + 175.0 * (i as f32 / (1 << 20) as f32);
        let four = float::exp4(glam::Vec4::splat(x)).x;
        assert_eq!(exp(x).to_bits(), four.to_bits(), "{x:e}");
    }
}

#[test]
fn logarithms() {
    let positive = || numbers().filter(|&x| x > 0.0 && x.is_finite());
    assert_within(1.1, worst(positive(), ln, float64::ln));
    assert_eq!([0.0, -0.0].map(ln), [f32::NEG_INFINITY; 2]);
    assert_eq!(ln(f32::INFINITY), f32::INFINITY);
    assert!(
        [-1.0, -1e-45, f32::NEG_INFINITY, f32::NAN]
            .iter()
            .all(|&x| ln(x).is_nan())
    );
}

#[test]
fn error_function() {
    assert_within(1.3, worst(numbers(), erf, float64::erf));
    let near_the_seam = || (0..1 << 20).map(|i| 4.5 * (i as f32 / (1 << 20) as f32));
    assert_within(1.3, worst(near_the_seam(), erf, float64::erf));
    assert_eq!([f32::INFINITY, f32::NEG_INFINITY].map(erf), [1.0, -1.0]);
    assert!(erf(f32::NAN).is_nan());
}

#[test]
fn powers() {
    // Exponents that are common, and those that bring the result near the ends of the range.
    let exponents = [
        0.5,
        2.0,
        5.0,
        -1.0,
        1.0 / 3.0,
        22.0,
        1e-3,
        250.0,
        -37.5,
        1e4,
    ];
    let positive = || numbers().step_by(29).filter(|&x| x > 0.0 && x.is_finite());
    for y in exponents {
        assert_within(
            1.6,
            worst(positive(), |x| pow(x, y), |x| libm::pow(x, y.into())),
        );
    }
    for target in [-149.5, -126.0, -90.0, 63.0, 127.9, 128.0] {
        let y = |x: f32| (target / libm::log2(f64::from(x))) as f32;
        let exact = |x: f64| libm::pow(x, y(x as f32).into());
        assert_within(1.6, worst(positive(), |x| pow(x, y(x)), exact));
    }
}

#[test]
fn special_powers() {
    let infinity = f32::INFINITY;
    let special = [0.0, 1.0, 0.5, 2.0, infinity, f32::NAN];
    for x in special {
        for y in special
            .into_iter()
            .chain([-0.5, -2.0, -infinity, 1e-45, f32::MAX])
        {
            let exact = libm::pow(x.into(), y.into()) as f32;
            let got = pow(x, y);
            let close = got == exact || (got - exact).abs() < 1e-7 * exact;
            assert!(close || got.is_nan() && exact.is_nan(), "{x}^{y} = {got}");
        }
    }
    assert!(pow(-2.0, 2.0).is_nan());
}

#[test]
fn sines_and_cosines() {
    let moderate = || numbers().filter(|x| x.abs() <= 65_536.0);
    assert_within(1.6, worst(moderate(), |x| sin_cos(x).0, float64::sin));
    assert_within(1.6, worst(moderate(), |x| sin_cos(x).1, float64::cos));
    // Nearest to multiples of a quarter turn, where digits cancel.
    let near = || {
        (-40_000..40_000).flat_map(|n| {
            let x = (f64::from(n) * core::f64::consts::FRAC_PI_2) as f32;
            [x.next_down(), x, x.next_up()]
        })
    };
    assert_within(1.6, worst(near(), |x| sin_cos(x).0, float64::sin));
    assert_within(1.6, worst(near(), |x| sin_cos(x).1, float64::cos));
    for x in [f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
        assert!(sin_cos(x).0.is_nan() && sin_cos(x).1.is_nan());
    }
}

#[test]
fn sines_and_cosines_of_turns_are_the_scalar_ones() {
    for x in numbers().filter(|x| x.abs() < 524_288.0) {
        let (a, b) = (sin_cos_turns(x), float::sin_cos_turns(x));
        assert_eq!(
            [a.0, a.1].map(f32::to_bits),
            [b.0, b.1].map(f32::to_bits),
            "{x:e}"
        );
    }
}

#[test]
fn arc_tangents() {
    assert_within(1.6, worst(numbers(), atan, libm::atan));
    // All ratios, in all quadrants.
    for (x, y) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
        for scale in [1.0, 0.77, 1.99] {
            let (x, y) = (x * scale, y * scale);
            let ratio = |r: f32| (r / (1.0 + r.abs()), 1.0 - (r / (1.0 + r.abs())).abs());
            let got = |r: f32| atan2(ratio(r).0 * y, ratio(r).1 * x);
            let exact = |r: f64| {
                let (a, b) = ratio(r as f32);
                libm::atan2((a * y).into(), (b * x).into())
            };
            assert_within(
                1.7,
                worst(numbers().filter(|r| r.is_finite()).step_by(7), got, exact),
            );
        }
    }
}

#[test]
fn special_angles() {
    let special = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        f32::INFINITY,
        f32::NEG_INFINITY,
        1e-45,
        f32::MAX,
    ];
    for y in special {
        for x in special {
            let exact = libm::atan2(y.into(), x.into()) as f32;
            let got = atan2(y, x);
            assert!(
                (got - exact).abs() <= 1e-7 * exact.abs(),
                "atan2({y}, {x}) = {got}"
            );
            assert_eq!(
                got.is_sign_negative(),
                exact.is_sign_negative(),
                "atan2({y}, {x})"
            );
        }
        assert!(atan2(y, f32::NAN).is_nan() && atan2(f32::NAN, y).is_nan());
    }
}

#[test]
fn arc_sines_and_cosines() {
    let inside = || {
        let even = (0..1 << 20).map(|i| i as f32 / (1 << 19) as f32 - 1.0);
        numbers().filter(|x| x.abs() <= 1.0).chain(even)
    };
    assert_within(1.8, worst(inside(), asin, libm::asin));
    assert_within(1.8, worst(inside(), acos, libm::acos));
    for x in [1.0, 1.5, f32::INFINITY] {
        assert_eq!(asin(x), core::f32::consts::FRAC_PI_2);
        assert_eq!(asin(-x), -core::f32::consts::FRAC_PI_2);
        assert_eq!([acos(x), acos(-x)], [0.0, core::f32::consts::PI]);
    }
    assert!(asin(f32::NAN).is_nan() && acos(f32::NAN).is_nan());
}
