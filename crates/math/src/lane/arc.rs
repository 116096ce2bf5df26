//! Inverse trigonometric functions.

use super::{Lane, Select};
use core::f32::consts::{FRAC_PI_2, PI};

/// What π/2 as an `f32` lacks; π lacks twice that.
const FRAC_PI_2_LOW: f32 = -4.371_139e-8;

/// Arc tangent of `x`, within 1.6 ulp.
#[inline(always)]
pub fn atan<F: Lane>(x: F) -> F {
    let a = x.abs();
    let large = a.gt(F::ONE);
    let ratio = large.select(-F::ONE, a) / large.select(a, F::ONE);
    let quarter = F::splat(FRAC_PI_2);
    angle(ratio, large.select(quarter, F::ZERO)).copysign(x)
}

/// The angle of the point (`x`, `y`) in [−π, π], within 1.7 ulp; zeros and infinities as IEEE 754 has them.
#[inline(always)]
pub fn atan2<F: Lane>(y: F, x: F) -> F {
    let (ax, ay) = (x.abs(), y.abs());
    let steep = ay.gt(ax);
    let (lesser, greater) = (steep.select(ax, ay), steep.select(ay, ax));
    // Not 0/0 nor ∞/∞.
    let of_equals = greater.gt(F::ZERO).select(F::ONE, F::ZERO);
    let ratio = ax.eq(ay).select(of_equals, lesser / greater);
    let quarter = F::splat(FRAC_PI_2);
    let behind = F::ONE.copysign(x).lt(F::ZERO);
    let base = steep.select(quarter, behind.select(F::splat(PI), F::ZERO));
    // The angle falls as the ratio grows where only one of the two is exchanged.
    let ratio = (steep ^ behind).select(-ratio, ratio);
    angle(ratio, base).copysign(y)
}

/// `base`, a multiple of π/2, plus the arc tangent of `t`, |t| ≤ 1.
///
/// atan t = t + t³P(t²); the polynomial's relative error is below 4·10⁻⁹.
#[inline(always)]
fn angle<F: Lane>(t: F, base: F) -> F {
    let t2 = t * t;
    let tail = t2.polynomial([
        -1.806_346_6e-3,
        1.095_241_8e-2,
        -3.121_426_9e-2,
        5.796_317e-2,
        -8.402_257e-2,
        0.109_513_92,
        -0.142_640_47,
        0.199_985_3,
        -0.333_333,
    ]);
    let base_low = base * (FRAC_PI_2_LOW / FRAC_PI_2);
    base + (t + (t * t2).mul_add(tail, base_low))
}

/// Arc sine of `x`, within 1.8 ulp, with `x` brought into [−1, 1] first.
#[inline(always)]
pub fn asin<F: Lane>(x: F) -> F {
    let (large, s, tail) = half_arc(x);
    // s + tail, or π/2 − 2 (s + tail).
    let factor = large.select(F::splat(-2.0), F::ONE);
    let base = large.select(F::splat(FRAC_PI_2), F::ZERO);
    summed(base, factor, s, tail).copysign(x)
}

/// Arc cosine of `x`, within 1.8 ulp, with `x` brought into [−1, 1] first.
#[inline(always)]
pub fn acos<F: Lane>(x: F) -> F {
    let (large, s, tail) = half_arc(x);
    let negative = x.lt(F::ZERO);
    // π/2 ∓ (s + tail), 2 (s + tail) or π − 2 (s + tail).
    let factor = large.select(F::splat(2.0), F::ONE);
    let factor = (large ^ negative).select(factor, -factor);
    let base = large.select(negative.select(F::splat(PI), F::ZERO), F::splat(FRAC_PI_2));
    summed(base, factor, s, tail)
}

/// `base`, a multiple of π/2, plus `factor`, 1 or 2 or their opposites, times (`s` + `tail`).
#[inline(always)]
fn summed<F: Lane>(base: F, factor: F, s: F, tail: F) -> F {
    let base_low = base * (FRAC_PI_2_LOW / FRAC_PI_2);
    base + s.mul_add(factor, tail.mul_add(factor, base_low))
}

/// Whether a = |x| exceeds ½, and in two summands the arc sine of a, or of √((1 − a)/2) where it does, that is ½ acos a.
///
/// asin s = s + s³P(s²); the polynomial's relative error is below 6·10⁻⁹.
#[inline(always)]
fn half_arc<F: Lane>(x: F) -> (F::Mask, F, F) {
    let a = x.abs().min(F::ONE);
    let large = a.gt(F::splat(0.5));
    let s2 = large.select((F::ONE - a) * 0.5, a * a);
    let s = large.select(s2.sqrt(), a);
    let tail = s2.polynomial([
        4.215_829e-2,
        2.418_478_2e-2,
        4.546_915e-2,
        7.495_309_4e-2,
        0.166_667_52,
    ]);
    (large, s, s * s2 * tail)
}
