//! Powers.

use super::exp::{ROUNDING, exp_reduced, mantissa_and_exponent, scaled};
use super::{Lane, Select};
use core::f32::consts::LN_2;

/// `x` to the power `y`, within 1.6 ulp, for a base that is not negative; NaN for one that is, but 1 for `y` = 0.
/// Zeros, infinities and NaN as IEEE 754 has them for its `pow`, −0 as 0.
///
/// 2 to the power of y·log₂ x, with the logarithm and the product in two parts each.
#[inline(always)]
pub fn pow<F: Lane>(x: F, y: F) -> F {
    let (high, low) = log2(x);
    let infinity = F::splat(f32::INFINITY);
    let special = !(x.gt(F::ZERO) & x.lt(infinity));
    let of_special = x
        .eq(F::ZERO)
        .select(-infinity, x.eq(infinity).select(x, F::splat(f32::NAN)));
    let (high, low) = (
        special.select(of_special, high),
        special.select(F::ZERO, low),
    );

    let product = y * high;
    let error = y.mul_add(high, -product) + y * low;
    // Beyond, the result is 0 or infinite, and the error not a number where the product is infinite.
    let exponent = product.clamp(-160.0, 140.0);
    let error = exponent.eq(product).select(error, F::ZERO);
    let rounded = exponent + ROUNDING;
    let fraction = (exponent - (rounded - ROUNDING)) + error;
    let power = scaled(exp_reduced(fraction * LN_2), rounded);
    (y.eq(F::ZERO) | x.eq(F::ONE)).select(F::ONE, power)
}

/// The logarithm to base 2 of a positive number that is finite, in two parts: relative error below 2⁻³¹.
///
/// x = m · 2ⁿ, and ln m = 2 artanh s with s = (m − 1)/(m + 1), |s| ≤ 0.172.
#[inline(always)]
fn log2<F: Lane>(x: F) -> (F, F) {
    // 2/ln 2 in two parts.
    const HIGH: f32 = 2.885_39;
    const LOW: f32 = (2.0 * core::f64::consts::LOG2_E - HIGH as f64) as f32;
    const THIRD: f32 = 1.0 / 3.0;
    let (m, n) = mantissa_and_exponent(x);
    let (f, g) = (m - 1.0, m + 1.0);
    let inverse = F::ONE / g;
    let s = f * inverse;
    // What the sum and the quotient lost.
    let g_low = m - (g - 1.0);
    let remainder = (-s).mul_add(g_low, (-s).mul_add(g, f));
    let s_low = remainder * inverse;
    // artanh s = s + s z/3 + s z² Q(z), z = s², and its derivative is nearly 1 + z. What products lose counts too.
    let z = s * s;
    let third = z * THIRD;
    let lost = z.mul_add(F::splat(THIRD), -third) + s.mul_add(s, -z) * THIRD;
    let rest = (z * z).mul_add(
        z.polynomial([0.117_098_23, 0.142_735_45, 0.200_000_76]),
        lost,
    );
    let rest = s.mul_add(rest, s_low.mul_add(z, s_low));
    let cubic = s * third;
    let rest = s.mul_add(third, -cubic) + rest;
    let artanh = s + cubic;
    let rest = (s - artanh) + cubic + rest;
    let high = artanh * HIGH;
    let low = artanh.mul_add(F::splat(HIGH), -high);
    let low = low + artanh.mul_add(F::splat(LOW), rest * HIGH);
    // |n| ≥ |high| unless n = 0: nothing is lost.
    let sum = n + high;
    let low = high - (sum - n) + low;
    let total = sum + low;
    (total, low - (total - sum))
}
