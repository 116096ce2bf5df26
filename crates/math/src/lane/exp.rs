//! The exponential function.

use super::{Int, Lane, Select};

/// 1½·2²³: adding it rounds to an integer and leaves that in the lowest bits.
pub(super) const ROUNDING: f32 = 12_582_912.0;

/// e to the power `x`, within 1.1 ulp for every `x`: 0 below −104, infinite above 88.8, subnormal numbers between.
///
/// x = n·ln 2 + r with |r| ≤ ½ ln 2.
#[inline(always)]
pub fn exp<F: Lane>(x: F) -> F {
    let x = x.clamp(-104.0, 89.0);
    let rounded = x.mul_add(F::splat(core::f32::consts::LOG2_E), F::splat(ROUNDING));
    let n = rounded - ROUNDING;
    // ln 2 in two parts.
    let r = n.mul_add(F::splat(-core::f32::consts::LN_2), x);
    let r = n.mul_add(F::splat(1.904_654_2e-9), r);
    scaled(exp_reduced(r), rounded)
}

/// e to the power `r` for |r| ≤ ½ ln 2; the polynomial's relative error is below 3·10⁻⁹.
#[inline(always)]
pub(super) fn exp_reduced<F: Lane>(r: F) -> F {
    let tail = r.polynomial([
        1.381_454e-3,
        8.368_745e-3,
        4.166_839e-2,
        0.166_665_21,
        0.499_999_94,
    ]);
    (r * r).mul_add(tail, r) + 1.0
}

/// `x` · 2ⁿ, rounded once, where n + [`ROUNDING`] is `rounded`, and |n| ≤ 250: by two factors, both in range where the
/// result is not.
#[inline(always)]
pub(super) fn scaled<F: Lane>(x: F, rounded: F) -> F {
    let n = (rounded.to_bits()).wrapping_sub(F::Int::splat(ROUNDING.to_bits()));
    let half = n.shift_right_signed(1);
    let power = |n: F::Int| F::from_bits(n.wrapping_add(F::Int::splat(127)) << 23);
    x * power(half) * power(n.wrapping_sub(half))
}

/// A positive number, infinity excepted, as m · 2ⁿ with m in [√½, √2): m and n.
#[inline(always)]
pub(super) fn mantissa_and_exponent<F: Lane>(x: F) -> (F, F) {
    let subnormal = x.lt(F::splat(f32::MIN_POSITIVE));
    let bits = subnormal.select(x * 8_388_608.0, x).to_bits();
    let n = bits
        .wrapping_sub(F::Int::splat(core::f32::consts::FRAC_1_SQRT_2.to_bits()))
        .shift_right_signed(23);
    let mantissa = F::from_bits(bits.wrapping_sub(n << 23));
    let n = F::from_int(n);
    (mantissa, subnormal.select(n - 23.0, n))
}
