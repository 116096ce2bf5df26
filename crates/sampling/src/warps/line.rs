//! The tent and the linear density on a line.

use etalon_math::lane::Lane;

/// A number in [−1, 1] with density 1 − |x|.
#[inline]
pub fn interval_to_tent(u: f32) -> f32 {
    if u < 0.5 {
        (2.0 * u).sqrt() - 1.0
    } else {
        1.0 - (2.0 - 2.0 * u).sqrt()
    }
}

/// The inverse of [`interval_to_tent`].
#[inline]
pub fn tent_to_interval(x: f32) -> f32 {
    let rest = 1.0 - x.abs();
    let tail = 0.5 * rest * rest;
    if x < 0.0 { tail } else { 1.0 - tail }
}

/// The density of [`interval_to_tent`] per unit of length.
#[inline]
pub fn tent_density(x: f32) -> f32 {
    (1.0 - x.abs()).max(0.0)
}

/// A number in [0, 1] with density proportional to a line that is `a` at 0 and `b` at 1
/// (neither negative, nor both zero).
///
/// The root of (b − a)x²/2 + ax = u(a + b)/2, in a form without cancellation that includes
/// a = b.
#[inline]
pub fn interval_to_linear<F: Lane>(u: F, a: F, b: F) -> F {
    let root = (a * a + u * (b - a) * (b + a)).safe_sqrt();
    // a = 0 and u = 0 would be 0/0.
    (u * (a + b) / (a + root).max(F::splat(f32::MIN_POSITIVE))).min(F::ONE)
}

/// The inverse of [`interval_to_linear`].
#[inline]
pub fn linear_to_interval(x: f32, a: f32, b: f32) -> f32 {
    x * (2.0 * a + x * (b - a)) / (a + b)
}

/// The density of [`interval_to_linear`] per unit of length.
#[inline]
pub fn linear_density(x: f32, a: f32, b: f32) -> f32 {
    if (0.0..=1.0).contains(&x) {
        2.0 * (a + x * (b - a)) / (a + b)
    } else {
        0.0
    }
}
