//! The distribution of Henyey & Greenstein (1941, eq. 2), of which media and layered materials scatter.
//!
//! ```text
//! p(μ) = (1 − g²) / (4π · (1 + g² − 2gμ)^{3/2})
//! ```
//!
//! with μ the cosine between the direction of travel and the scattered one, and g ∈ (−1, 1) its mean. Near g = 0 the
//! inverse distribution function loses digits: pass 0 there.

use std::f32::consts::PI;

/// p(μ), per steradian.
#[inline]
pub fn henyey_greenstein_density(g: f32, mu: f32) -> f32 {
    let d = 1.0 + g * g - 2.0 * g * mu;
    (1.0 - g * g) / (4.0 * PI * d * d.sqrt())
}

/// The μ below which the share `u` of the light is scattered.
#[inline]
pub fn interval_to_henyey_greenstein(g: f32, u: f32) -> f32 {
    if g == 0.0 {
        return 2.0 * u - 1.0;
    }
    let q = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
    (1.0 + g * g - q * q) / (2.0 * g)
}
