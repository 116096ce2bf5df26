//! The noncentral t distribution: the t statistic of an effect that exists.
//!
//! T = (Z + δ) / X with Z standard normal and X = √(χ²ᵥ / ν) independent of it, so
//!
//! P(T > t) = E Φ̄(t X − δ)
//!
//! (Johnson, Kotz & Balakrishnan 1995, eq. 31.11), integrated over the distribution of X. All
//! terms are positive: the error is below 10⁻¹² relative in either tail, down to 10⁻²⁰.

use crate::normal;
use crate::scale_error;

/// Above this many degrees of freedom T − δ is standard normal.
const NORMAL: f64 = 1e6;

/// Φ̄ falls from one to zero, to every digit, between minus and plus this.
const STEEP: f64 = 9.0;

/// The probability that a noncentral t number exceeds `t`; NaN for a NaN, for degrees of freedom
/// that are not positive, or for a noncentrality δ that is not finite.
#[must_use]
pub fn sf(t: f64, degrees_of_freedom: f64, noncentrality: f64) -> f64 {
    if t.is_nan() || !(degrees_of_freedom > 0.0) || !noncentrality.is_finite() {
        return f64::NAN;
    }
    if t.is_infinite() {
        return if t > 0.0 { 0.0 } else { 1.0 };
    }
    if degrees_of_freedom > NORMAL {
        return normal::sf(t - noncentrality);
    }
    let steep = if t == 0.0 {
        [0.0, 0.0]
    } else {
        let ends = [(noncentrality - STEEP) / t, (noncentrality + STEEP) / t];
        [ends[0].min(ends[1]), ends[0].max(ends[1])]
    };
    scale_error::mean(degrees_of_freedom, steep, f64::INFINITY, |x| {
        normal::sf(t * x - noncentrality)
    })
    .min(1.0)
}
