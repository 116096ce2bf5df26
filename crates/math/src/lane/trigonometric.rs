//! Sine and cosine.

use super::exp::ROUNDING;
use super::{Int, Lane};
use core::f32::consts::{FRAC_2_PI, FRAC_PI_2};

/// Sine and cosine of `x` radians, within 1.6 ulp for |x| ≤ 2¹⁶. Beyond, digits are lost, all of them beyond 2²².
///
/// x = n·π/2 + r with |r| ≤ π/4.
#[inline(always)]
pub fn sin_cos<F: Lane>(x: F) -> (F, F) {
    let rounded = x.mul_add(F::splat(FRAC_2_PI), F::splat(ROUNDING));
    let n = rounded - ROUNDING;
    // π/2 in three parts; the first step is exact.
    let r = n.mul_add(F::splat(-FRAC_PI_2), x);
    let r = n.mul_add(F::splat(4.371_139e-8), r);
    let r = n.mul_add(F::splat(1.715_124_5e-15), r);
    let r2 = r * r;
    let sin = r.mul_add(
        r2 * r2.polynomial([-1.951_840_5e-4, 8.332_19e-3, -0.166_666_55]),
        r,
    );
    let cos = r2.polynomial([2.443_232_7e-5, -1.388_731e-3, 4.166_664_6e-2, -0.5, 1.0]);
    in_quadrant(sin, cos, rounded.to_bits())
}

/// Sine and cosine of `turns` whole turns, that is of 2π·`turns`, for |`turns`| < 2¹⁹: the bits of
/// [`crate::float::sin_cos_turns`], which see.
#[inline(always)]
pub fn sin_cos_turns<F: Lane>(turns: F) -> (F, F) {
    // The angle is (quarter + t)·π/2 with |t| ≤ ½; the subtraction is exact.
    let quarters = turns * 4.0;
    let rounded = quarters + ROUNDING;
    let t = quarters - (rounded - ROUNDING);
    let t2 = t * t;
    // sin(π/2 · t) = t·(π/2 + small), with π/2 in two parts.
    let tail = t2.polynomial([
        1.581_950_6e-4,
        -4.681_261e-3,
        7.969_258e-2,
        -0.645_964_1,
        -4.371_139e-8,
    ]);
    let sin = t.mul_add(F::splat(FRAC_PI_2), t * tail);
    let cos = t2.polynomial([
        9.037_666e-4,
        -2.086_016_5e-2,
        0.253_669_23,
        -1.233_700_5,
        1.0,
    ]);
    in_quadrant(sin, cos, rounded.to_bits())
}

/// Sine and cosine of an angle plus `quadrant` quarter turns, of which the two lowest bits count.
#[inline(always)]
fn in_quadrant<F: Lane>(sin: F, cos: F, quadrant: F::Int) -> (F, F) {
    let (sin, cos) = (sin.to_bits(), cos.to_bits());
    let odd = F::Int::splat(0).wrapping_sub(quadrant & 1);
    let exchanged = (sin ^ cos) & odd;
    let sign = |quadrant: F::Int| (quadrant & 2) << 30;
    let next = quadrant.wrapping_add(F::Int::splat(1));
    (
        F::from_bits(sin ^ exchanged ^ sign(quadrant)),
        F::from_bits(cos ^ exchanged ^ sign(next)),
    )
}
