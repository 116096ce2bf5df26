//! Light through matter that only absorbs: exp(−σ s) of it is left after the way s (Bouguer, *Essai d'optique*, 1729).
//!
//! Through a slab of thickness d at the angle θ the way is d/cos θ; through a ball of radius r at the distance a from its
//! middle it is the chord 2 √(r² − a²).

use etalon_math::float64::exp;

/// What a slab leaves: absorption (1/m), thickness (m), cosine of the angle with its normal.
pub fn slab(absorption: f64, thickness: f64, cosine: f64) -> f64 {
    exp(-absorption * thickness / cosine)
}

/// What a ball of radius `r` (m) leaves of a ray at the distance `a` (m) from its middle; absorption in 1/m.
pub fn ball(absorption: f64, r: f64, a: f64) -> f64 {
    exp(-2.0 * absorption * (r * r - a * a).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::{ball, slab};

    /// Thin layers, each of which takes its share, along a ray of the direction (across, along) through (a, 0).
    fn in_steps(inside: impl Fn(f64) -> bool, absorption: f64) -> f64 {
        const STEP: f64 = 1e-5;
        let places = (0..400_000).map(|i| (f64::from(i) + 0.5) * STEP - 2.0);
        places.fold(1.0, |left, s| {
            // The middle rule, of second order.
            let half = 0.5 * absorption * STEP;
            if inside(s) {
                left * (1.0 - half) / (1.0 + half)
            } else {
                left
            }
        })
    }

    #[test]
    fn layers_take_their_shares() {
        let expected = in_steps(|s| (0.6 * s).abs() < 0.5, 1.3);
        assert!((slab(1.3, 1.0, 0.6) - expected).abs() < 2e-5);
        let expected = in_steps(|s| s * s + 0.09 < 1.0, 0.7);
        assert!((ball(0.7, 1.0, 0.3) - expected).abs() < 2e-5);
        assert_eq!(ball(0.7, 1.0, 1.5), 1.0);
    }
}
