//! Multiple importance sampling over techniques *and* wavelengths.
//!
//! A path carries four wavelengths; any lane k could have been the one that chose, by any
//! technique t, with density p(t, k). The estimator of lane j's value is, with the balance
//! heuristic (Veach 1997, §9.2; Wilkie et al. 2014),
//!
//! ```text
//! fⱼ / Σₜ Σₖ p(t, k)        ( · 1/p(λⱼ), once, at the camera)
//! ```
//!
//! and with the power heuristic across techniques, β = 2, the balance among lanes kept,
//!
//! ```text
//! fⱼ · Sₜ / Σₛ Sₛ²,        Sₜ = Σₖ p(t, k)
//! ```
//!
//! for a path made by technique t. Either is unbiased, since the weights of all (t, k) at one
//! path sum to one.

use glam::Vec4;

/// The factor to multiply a path's contribution with under the balance heuristic: one over
/// the sum of all lanes of both techniques. `own` are the densities of the technique that
/// made the path, `other` the sum of those of all other techniques that could have.
/// Zero if the sum is zero or infinite (no technique could have made the path).
#[inline]
pub fn balance(own: Vec4, other: Vec4) -> f32 {
    let sum = (own + other).element_sum();
    if sum > 0.0 { sum.recip() } else { 0.0 }
}

/// The factor to multiply a path's contribution with under the power heuristic (β = 2) for
/// two techniques: Sₜ / (Sₜ² + Sₒ²). Zero if the path's own density is.
#[inline]
pub fn power(own: Vec4, other: Vec4) -> f32 {
    let own = own.element_sum();
    if !(own > 0.0) {
        return 0.0;
    }
    // By the ratio, so that no square can overflow.
    let ratio = other.element_sum() / own;
    (own * (1.0 + ratio * ratio)).recip()
}

/// The weight p / (p + q) of a technique with density `own` against one with density `other`,
/// for densities that do not depend on wavelength.
#[inline]
pub fn balance_weight(own: f32, other: f32) -> f32 {
    if own > 0.0 {
        1.0 / (1.0 + other / own)
    } else {
        0.0
    }
}

/// The weight p² / (p² + q²) of a technique with density `own` against one with density
/// `other`, for densities that do not depend on wavelength.
#[inline]
pub fn power_weight(own: f32, other: f32) -> f32 {
    if own > 0.0 {
        let ratio = other / own;
        1.0 / (1.0 + ratio * ratio)
    } else {
        0.0
    }
}
