//! Ambient occlusion beside a wall that stands at a right angle on the floor.
//!
//! From a point of the floor at the distance a, a ray along the unit vector ω meets the wall,
//! which has no end, within the distance D if ω·n ≥ s = a/D, with n horizontal toward the wall. By
//! projected solid angle (Nusselt's analogy) that is the part of the unit disk beyond the chord at
//! s,
//!
//! ```text
//! occluded(s) = (acos s − s √(1 − s²)) / π,   0 for s > 1
//! ```
//!
//! A pixel is its mean between two distances, for which
//! π ∫ occluded ds = s acos s − √(1 − s²) + (1 − s²)^(3/2) / 3.

use super::light::known;
use crate::claim::Claim;
use etalon_math::float64::acos;
use etalon_render::judge::ExactImage;
use std::f64::consts::PI;

/// The picture of the floor, the wall at its left edge.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let width = 2.0 * claim.number("half_width")?;
    let reach = claim.number("distance")?;
    let pixel = width / f64::from(size[0]);
    Ok(known(size, |column, _| {
        let near = pixel * f64::from(column);
        [1.0 - occluded([near / reach, (near + pixel) / reach]); 3]
    }))
}

/// The mean of the occluded part between two distances, in units of the reach.
fn occluded([from, to]: [f64; 2]) -> f64 {
    let integral = |s: f64| {
        if s >= 1.0 {
            return 0.0;
        }
        let square = 1.0 - s * s;
        s * acos(s) - square.sqrt() + square * square.sqrt() / 3.0
    };
    (integral(to) - integral(from)) / (PI * (to - from))
}

#[cfg(test)]
mod tests {
    use super::occluded;

    #[test]
    fn the_mean_is_that_of_the_chord() {
        // Beside the wall it takes one half; out of reach nothing; at s = 1/2, a third less √3/4π.
        let thin = |s: f64| occluded([s, s + 1e-6]);
        assert!((thin(0.0) - 0.5).abs() < 1e-6);
        assert_eq!(thin(1.5), 0.0);
        let expected = 1.0 / 3.0 - 3.0_f64.sqrt() / (4.0 * std::f64::consts::PI);
        assert!((thin(0.5) - expected).abs() < 1e-5, "{}", thin(0.5));
        // The mean over an interval is that of its parts.
        let parts = (occluded([0.2, 0.7]) * 0.5 + occluded([0.7, 1.3]) * 0.6) / 1.1;
        assert!((occluded([0.2, 1.3]) - parts).abs() < 1e-12);
    }
}
