//! Shares of successes: exact intervals, for false-alarm rates and coverages.

use crate::interval::Interval;
use statrs::function::beta::beta_reg;

/// The interval of Clopper and Pearson (1934) for the probability of success, given `successes`
/// of `trials`; it covers with probability at least `confidence`. `None` for no trials or more
/// successes than trials.
#[must_use]
pub fn interval(successes: u64, trials: u64, confidence: f64) -> Option<Interval> {
    if trials == 0 || successes > trials {
        return None;
    }
    let tail = 0.5 * (1.0 - confidence);
    let (x, n) = (successes as f64, trials as f64);
    let low = if successes == 0 {
        0.0
    } else {
        // P(X ≥ x | p) = tail.
        solve(|p| beta_reg(x, n - x + 1.0, p) - tail)
    };
    let high = if successes == trials {
        1.0
    } else {
        // P(X ≤ x | p) = 1 − P(X ≥ x + 1 | p) = tail, with the smaller of the two beta tails.
        solve(|p| tail - beta_reg(n - x, x + 1.0, 1.0 - p))
    };
    Some(Interval { low, high })
}

/// The p-value of the hypothesis that the probability of success lies in [`low`, `high`]: twice the
/// exact binomial tail beyond the nearer end, 1 if the share lies between them. `None` for no trials,
/// more successes than trials, or ends that are no probabilities in this order.
#[must_use]
pub fn p_outside(successes: u64, trials: u64, [low, high]: [f64; 2]) -> Option<f64> {
    if trials == 0 || successes > trials || !(0.0 <= low && low <= high && high <= 1.0) {
        return None;
    }
    let (x, n) = (successes as f64, trials as f64);
    let tail = if x < low * n {
        // P(X ≤ x | low) = 1 − P(X ≥ x + 1 | low).
        beta_reg(n - x, x + 1.0, 1.0 - low)
    } else if x > high * n {
        // P(X ≥ x | high).
        beta_reg(x, n - x + 1.0, high)
    } else {
        return Some(1.0);
    };
    Some((2.0 * tail).min(1.0))
}

/// The p in (0, 1) where an increasing function vanishes, by bisection.
fn solve(function: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    // Halved until no number lies between: at most 1,100 times, for a p near the smallest double.
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if function(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::p_outside;

    #[test]
    fn tails_are_sums_of_the_binomial() {
        // P(X ≤ 1 | n = 10, p = 0.4) = 0.6¹⁰ + 10 · 0.4 · 0.6⁹ = 0.046357, and
        // P(X ≥ 9 | n = 10, p = 0.6) the same by symmetry.
        let expected = 2.0 * 0.046_357_401_6;
        for successes in [1, 9] {
            let found = p_outside(successes, 10, [0.4, 0.6]).expect("a proportion");
            assert!((found - expected).abs() < 1e-12, "{found}");
        }
        assert_eq!(p_outside(5, 10, [0.4, 0.6]), Some(1.0));
        assert_eq!(p_outside(4, 10, [0.4, 0.6]), Some(1.0));
        assert_eq!(p_outside(0, 10, [0.0, 0.0]), Some(1.0));
        assert_eq!(p_outside(1, 10, [0.0, 0.0]), Some(0.0));
        // Mutant rejected: the normal approximation with the spread at 0.99, not at the nearest
        // probability in question, gives 1.1·10⁻⁸. Twice the binomial sum is 6.826·10⁻⁵.
        let found = p_outside(967, 1000, [0.985, 0.995]).expect("a proportion");
        assert!((found / 6.825_916e-5 - 1.0).abs() < 1e-6, "{found}");
        assert!(p_outside(3, 0, [0.1, 0.2]).is_none() && p_outside(3, 9, [0.3, 0.2]).is_none());
    }
}
