//! Elementary functions in single precision, the same bits on every machine.
//!
//! The platform's own `sin`, `exp` or `pow` differ between operating systems and library
//! versions; an image that depends on them could not be reproduced. These are `libm`'s
//! portable implementations (errors below 1 ulp unless its documentation says otherwise).
//! Everything an image depends on calls these; a lint forbids the standard library's.

use glam::Vec4;

/// The largest number below one: what a random number in [0, 1) is clamped to after arithmetic.
pub const ONE_MINUS_EPSILON: f32 = 1.0 - f32::EPSILON / 2.0;

/// Sine of `x` radians.
#[inline]
pub fn sin(x: f32) -> f32 {
    libm::sinf(x)
}

/// Cosine of `x` radians.
#[inline]
pub fn cos(x: f32) -> f32 {
    libm::cosf(x)
}

/// Sine and cosine of `x` radians.
#[inline]
pub fn sin_cos(x: f32) -> (f32, f32) {
    libm::sincosf(x)
}

/// Sine and cosine of `turns` whole turns, that is of 2π·`turns`, for |`turns`| < 2¹⁹.
///
/// Faster than `sin_cos(2π · turns)`, having no branch, and more accurate, since the reduction
/// to an eighth of a turn is exact: the error is below 1.2 ulp of either result, and multiples
/// of a quarter turn are exact. Polynomials fitted by ourselves (minimax, relative error < 10⁻¹⁰).
#[inline]
pub fn sin_cos_turns(turns: f32) -> (f32, f32) {
    crate::lane::sin_cos_turns(turns)
}

/// Tangent of `x` radians.
#[inline]
pub fn tan(x: f32) -> f32 {
    libm::tanf(x)
}

/// Arc sine of `x`, with `x` brought into [−1, 1] first.
#[inline]
pub fn asin(x: f32) -> f32 {
    libm::asinf(x.clamp(-1.0, 1.0))
}

/// Arc cosine of `x`, with `x` brought into [−1, 1] first.
#[inline]
pub fn acos(x: f32) -> f32 {
    libm::acosf(x.clamp(-1.0, 1.0))
}

/// Arc tangent of `x`.
#[inline]
pub fn atan(x: f32) -> f32 {
    libm::atanf(x)
}

/// The angle of the point (`x`, `y`) in (−π, π].
#[inline]
pub fn atan2(y: f32, x: f32) -> f32 {
    libm::atan2f(y, x)
}

/// Inverse hyperbolic tangent.
#[inline]
pub fn atanh(x: f32) -> f32 {
    libm::atanhf(x)
}

/// Hyperbolic cosine.
#[inline]
pub fn cosh(x: f32) -> f32 {
    libm::coshf(x)
}

/// e to the power `x`.
#[inline]
pub fn exp(x: f32) -> f32 {
    libm::expf(x)
}

/// e to the power of each of four numbers, none above 88: 0 below −87, where results would lose digits.
///
/// All lanes at once, without a branch: the error is below 1.1 ulp. x = n·ln 2 + r with |r| ≤ ½ ln 2, and eʳ by a polynomial fitted
/// by ourselves (minimax, relative error 3·10⁻⁹).
#[inline]
pub fn exp4(x: Vec4) -> Vec4 {
    // Adding 1½·2²³ rounds to an integer and leaves it in the lowest bits.
    const ROUNDING: Vec4 = Vec4::splat(12_582_912.0);
    let rounded = x.mul_add(Vec4::splat(core::f32::consts::LOG2_E), ROUNDING);
    let n = rounded - ROUNDING;
    // ln 2 in two parts.
    let r = n.mul_add(Vec4::splat(-core::f32::consts::LN_2), x);
    let r = n.mul_add(Vec4::splat(1.904_654_2e-9), r);
    let tail = r
        .mul_add(Vec4::splat(1.381_454e-3), Vec4::splat(8.368_745e-3))
        .mul_add(r, Vec4::splat(4.166_839e-2))
        .mul_add(r, Vec4::splat(0.166_665_21))
        .mul_add(r, Vec4::splat(0.499_999_94));
    let mantissa = (r * r).mul_add(tail, r) + Vec4::ONE;
    // 2ⁿ by the exponent's bits.
    let power = rounded
        .to_array()
        .map(|n| f32::from_bits(n.to_bits().wrapping_add(127) << 23));
    let small = x.cmplt(Vec4::splat(-87.0));
    Vec4::select(small, Vec4::ZERO, mantissa * Vec4::from_array(power))
}

/// Natural logarithm.
#[inline]
pub fn ln(x: f32) -> f32 {
    libm::logf(x)
}

/// Logarithm to base 2.
#[inline]
pub fn log2(x: f32) -> f32 {
    libm::log2f(x)
}

/// `x` to the power `y`.
#[inline]
pub fn pow(x: f32, y: f32) -> f32 {
    libm::powf(x, y)
}

/// Cube root.
#[inline]
pub fn cbrt(x: f32) -> f32 {
    libm::cbrtf(x)
}

/// The error function.
#[inline]
pub fn erf(x: f32) -> f32 {
    libm::erff(x)
}

/// The complementary error function, 1 − erf(`x`), to full relative precision.
#[inline]
pub fn erfc(x: f32) -> f32 {
    libm::erfcf(x)
}

/// Square root of `x`, zero for negative `x` (which rounding alone produces here).
#[inline]
pub fn safe_sqrt(x: f32) -> f32 {
    x.max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Spacing of floats at `x`.
    fn ulp(x: f64) -> f64 {
        let x = (x.abs() as f32).max(f32::MIN_POSITIVE);
        f64::from(x.next_up()) - f64::from(x)
    }

    #[test]
    fn sine_and_cosine_of_turns_are_within_1_2_ulp() {
        let mut worst = 0.0f64;
        let mut check = |turns: f32| {
            let (s, c) = sin_cos_turns(turns);
            let angle = 2.0 * core::f64::consts::PI * (f64::from(turns) - f64::from(turns.round()));
            let (es, ec) = crate::float64::sin_cos(angle);
            // Near a multiple of π the true value in f64 is itself exact to 1e-16 only.
            worst = worst.max(((f64::from(s) - es).abs() - 3e-16).max(0.0) / ulp(es));
            worst = worst.max(((f64::from(c) - ec).abs() - 3e-16).max(0.0) / ulp(ec));
        };
        for i in 0..(1 << 21) {
            check(i as f32 / (1 << 21) as f32);
            check(-(i as f32) * 1.234_567e-4);
            check(i as f32 * 1e-12);
        }
        assert!(worst < 1.2, "{worst} ulp");
    }

    #[test]
    fn quarter_turns_are_exact() {
        let exact = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)];
        for quarter in -40i32..40 {
            let expected = exact[quarter.rem_euclid(4) as usize];
            assert_eq!(sin_cos_turns(quarter as f32 * 0.25), expected);
        }
    }

    #[test]
    fn exponentials_of_four_are_within_1_1_ulp() {
        let mut worst = 0.0f64;
        for i in 0..(1 << 22) {
            let x = 88.0 - 175.0 * i as f32 / (1 << 22) as f32;
            let exact = crate::float64::exp(f64::from(x));
            let all = exp4(Vec4::new(x, 0.0, -100.0, f32::NEG_INFINITY));
            assert_eq!(all.to_array()[1..], [1.0, 0.0, 0.0]);
            worst = worst.max((f64::from(all.x) - exact).abs() / ulp(exact));
        }
        assert!(worst < 1.1, "{worst} ulp");
    }
}
