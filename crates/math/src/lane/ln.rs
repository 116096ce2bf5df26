//! The natural logarithm.

use super::exp::mantissa_and_exponent;
use super::{Lane, Select};
use core::f32::consts::LN_2;

/// The natural logarithm of `x`, within 1.1 ulp; −∞ at ±0, NaN below.
///
/// x = m · 2ⁿ with m in [√½, √2), and ln(1 + f) = f − f²/2 + f³P(f); the polynomial's relative error is below 10⁻⁸.
#[inline(always)]
pub fn ln<F: Lane>(x: F) -> F {
    let (m, n) = mantissa_and_exponent(x);
    let f = m - 1.0;
    let f2 = f * f;
    let cubic = f2
        * f
        * f.polynomial([
            -0.076_259_88,
            0.127_727_79,
            -0.131_649_69,
            0.142_004_88,
            -0.166_230_6,
            0.200_012_61,
            -0.250_008_23,
            0.333_333_3,
        ]);
    let tail = f2.mul_add(F::splat(-0.5), cubic);
    // ln 2 in two parts.
    let tail = n.mul_add(F::splat(-1.904_654_2e-9), tail);
    let ln = n.mul_add(F::splat(LN_2), f + tail);
    let positive = x.gt(F::ZERO);
    // Of infinity: itself; of NaN and what is negative: NaN.
    let ln = x.lt(F::splat(f32::INFINITY)).select(ln, x);
    let zero = x.eq(F::ZERO);
    let other = zero.select(F::splat(f32::NEG_INFINITY), F::splat(f32::NAN));
    positive.select(ln, other)
}
