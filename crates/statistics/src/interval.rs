//! Confidence intervals.

use crate::verdict::Verdict;

/// All numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The smallest.
    pub low: f64,
    /// The greatest.
    pub high: f64,
}

impl Interval {
    /// Whether it holds `x`.
    #[must_use]
    pub fn contains(&self, x: f64) -> bool {
        self.low <= x && x <= self.high
    }

    /// From the lowest to the highest number.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.high - self.low
    }

    /// The greatest distance of any of its numbers from zero: the bound it puts on a bias.
    #[must_use]
    pub fn bound(&self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// Whether it lies inside ±`tolerance`, outside, or neither.
    #[must_use]
    pub fn verdict(&self, tolerance: f64) -> Verdict {
        if -tolerance <= self.low && self.high <= tolerance {
            Verdict::Agrees
        } else if self.low > tolerance || self.high < -tolerance {
            Verdict::Differs
        } else {
            Verdict::Undecided
        }
    }
}
