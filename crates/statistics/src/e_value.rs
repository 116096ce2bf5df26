//! Evidence that a mean is larger than claimed, whatever the distribution.
//!
//! Of independent numbers X ≥ 0 with E X ≤ μ the product
//!
//! ```text
//! K(λ) = Π (1 + λ (Xᵢ/μ − 1)),        0 ≤ λ ≤ 1
//! ```
//!
//! has an expectation of 1 at most, after any number of them, and so has a mean over λ. So it ever
//! exceeds 1/α with a probability of α at most (Ville 1939, *Étude critique de la notion de
//! collectif*; Waudby-Smith and Ramdas 2024, "Estimating means of bounded random variables by
//! betting"). No tail is too heavy for it. Nothing of the kind shows that a mean is smaller: a rare large number
//! may still be to come.

/// The λ over which the mean is taken.
const BETS: [f64; 4] = [0.25, 0.5, 0.75, 1.0];

/// K for the hypothesis that the mean of numbers that cannot be negative is `most` at most; 0 if one is negative or NaN, so that
/// nothing is shown then.
#[must_use]
pub fn exceeds(sample: &[f64], most: f64) -> f64 {
    if !(most > 0.0) || sample.iter().any(|x| !(*x >= 0.0)) {
        return 0.0;
    }
    let product = |bet: f64| -> f64 {
        let logarithm: f64 = sample
            .iter()
            .map(|x| libm::log1p(bet * (x / most - 1.0)))
            .sum();
        libm::exp(logarithm)
    };
    BETS.iter().map(|bet| product(*bet)).sum::<f64>() / BETS.len() as f64
}

#[cfg(test)]
mod tests {
    use super::exceeds;
    use crate::random::SplitMix64;

    /// How many of 20,000 samples of 32 such numbers exceed 1/α = 100 for the hypothesis of this mean.
    fn alarms(most: f64, draw: fn(&mut SplitMix64) -> f64) -> u32 {
        let mut random = SplitMix64::new(3);
        let sample =
            |random: &mut SplitMix64| -> [f64; 32] { std::array::from_fn(|_| draw(random)) };
        (0..20_000)
            .map(|_| u32::from(exceeds(&sample(&mut random), most) >= 100.0))
            .sum()
    }

    /// Of numbers whose mean is 1, even ones of which one in a hundred is 99, 1 % exceed at most: 200 of 20,000, and more than 274 with a
    /// probability below 10⁻⁶. Mutant rejected: K for a mean of 0.7.
    #[test]
    fn a_true_mean_is_rarely_called_too_small() {
        let rare = |random: &mut SplitMix64| match random.below(100) {
            0 => 99.0,
            _ => 1.0 / 99.0,
        };
        let even = |random: &mut SplitMix64| 2.0 * random.below(2) as f64;
        assert!(alarms(1.0, rare) <= 274);
        assert!(alarms(1.0, even) <= 274);
        assert!(alarms(0.7, even) > 274);
    }

    #[test]
    fn what_is_twice_as_bright_is_found() {
        let sample: Vec<f64> = (0..32).map(|i| 1.5 + f64::from(i % 3) * 0.5).collect();
        assert!(exceeds(&sample, 1.0) > 1e7);
        assert!(exceeds(&sample, 2.5) < 1.0);
        assert_eq!(exceeds(&[1.0, -1.0], 1.0), 0.0);
        assert_eq!(exceeds(&[1.0, f64::NAN], 1.0), 0.0);
        assert_eq!(exceeds(&[0.0, 3.0], 0.0), 0.0);
        assert_eq!(exceeds(&[f64::INFINITY], 1.0), f64::INFINITY);
    }
}
