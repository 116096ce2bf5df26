//! What becomes of an error with four times the samples.
//!
//! A wrong formula stays wrong; what a consistent method adds falls as 1/n or as n^−½; what rounding or a heavy tail adds may grow.
//! Decided by replicates at both: ρ = 1, ½ and ¼ of the first error are each compared with the second by Welch's interval of 95 %.

use etalon_statistics::Summary;
use etalon_statistics::estimate::Estimate;
use serde::{Deserialize, Serialize};

/// How many pictures have four times the samples.
pub const PICTURES: u32 = 8;

/// By how much samples grow.
pub const FACTOR: u32 = 4;

/// Differences that are no more than this share of the first error do not matter.
const SMALL: f64 = 0.05;

/// The confidence with which there is an error whose trend may be asked for.
const SEEN: f64 = 0.999;

/// Relative errors below this are of single precision.
const ROUNDING: f64 = 1e-5;

/// How an error changes with the number n of samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Trend {
    /// Not at all.
    Constant,
    /// As n^−½.
    FallsAsRoot,
    /// As 1/n, or faster.
    FallsAsInverse,
    /// It grows.
    Grows,
}

impl Trend {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Constant => "the error stays the same",
            Self::FallsAsRoot => "the error falls as one over the root of the samples",
            Self::FallsAsInverse => "the error falls as one over the samples, or faster",
            Self::Grows => "the error grows",
        }
    }
}

/// What was found with four times the samples.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Refinement {
    /// Mean over truth, less 1.
    pub bias: f64,
    /// Its interval of 95 %.
    pub interval: [f64; 2],
    /// How the error changed, where that can be told.
    pub trend: Option<Trend>,
}

impl Refinement {
    /// Of the deviations of pictures with the samples of a question, and of those with more; `None` if these are too few.
    pub fn of(before: &[f64], after: &[f64]) -> Option<Self> {
        let summary = Summary::of(after).filter(|_| after.len() >= 3)?;
        let interval = Estimate::mean(&summary).interval(0.95);
        Some(Self {
            bias: summary.mean(),
            interval: [interval.low, interval.high],
            trend: trend(before, after),
        })
    }
}

fn trend(before: &[f64], after: &[f64]) -> Option<Trend> {
    let (first, second) = (Summary::of(before)?, Summary::of(after)?);
    let is_seen = !Estimate::mean(&first).interval(SEEN).contains(0.0);
    if !is_seen || first.mean().abs() < ROUNDING {
        return None;
    }
    // The second error less this share of the first.
    let left = |share: f64| {
        let scaled: Vec<f64> = before.iter().map(|bias| share * bias).collect();
        Summary::of(&scaled).map(|scaled| Estimate::welch(&second, &scaled).interval(0.95))
    };
    let grown = left(1.0)?;
    let sign = first.mean().signum();
    let small = SMALL * first.mean().abs();
    if (sign * grown.low).min(sign * grown.high) > small {
        return Some(Trend::Grows);
    }
    let known = [
        (1.0, Trend::Constant),
        (0.5, Trend::FallsAsRoot),
        (0.25, Trend::FallsAsInverse),
    ];
    let fits = |share: f64| {
        left(share).is_some_and(|interval| interval.low <= small && interval.high >= -small)
    };
    let fitting: Vec<Trend> = (known.iter())
        .filter(|(share, _)| fits(*share))
        .map(|(_, trend)| *trend)
        .collect();
    let far = |share: f64| (second.mean() - share * first.mean()).abs();
    match fitting[..] {
        [only] => Some(only),
        [] => (known.iter().min_by(|a, b| far(a.0).total_cmp(&far(b.0)))).map(|(_, trend)| *trend),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::{Refinement, Trend};

    /// Deviations around a mean, as far as 1.2 times this from it.
    fn around(mean: f64, noise: f64, count: u32) -> Vec<f64> {
        (0..count)
            .map(|i| mean + noise * (f64::from(i * 7 % 13) / 5.0 - 1.2))
            .collect()
    }

    #[test]
    fn trends_are_told() {
        let of = |after: f64, noise: f64| {
            let found = Refinement::of(&around(0.01, noise, 26), &around(after, noise / 2.0, 13));
            found.and_then(|found| found.trend)
        };
        assert_eq!(of(0.01, 1e-4), Some(Trend::Constant));
        assert_eq!(of(0.005, 1e-4), Some(Trend::FallsAsRoot));
        assert_eq!(of(0.0025, 1e-4), Some(Trend::FallsAsInverse));
        assert_eq!(of(0.0, 1e-4), Some(Trend::FallsAsInverse));
        assert_eq!(of(0.03, 1e-4), Some(Trend::Grows));
        // A negative error grows as well.
        let darker = Refinement::of(&around(-0.01, 1e-4, 26), &around(-0.03, 1e-4, 13));
        assert_eq!(darker.and_then(|found| found.trend), Some(Trend::Grows));
        // With so much noise several fit, and of no error no trend is told.
        assert_eq!(of(0.006, 0.02), None);
        let none = Refinement::of(&around(0.0, 1e-3, 26), &around(0.0, 1e-3, 13));
        assert_eq!(none.expect("enough pictures").trend, None);
        // Without noise it is told as well; of two pictures nothing is.
        assert_eq!(of(0.0025, 0.0), Some(Trend::FallsAsInverse));
        assert_eq!(Refinement::of(&[0.1; 8], &[0.1; 2]), None);
    }
}
