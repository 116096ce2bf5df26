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
