//! An interval for a mean that does not assume normality if the sample contradicts it.
//!
//! A sample within the declared limits ([`crate::tails`]) is judged by Student's t. Beyond them an
//! interval takes over that needs no normal approximation:
//!
//! - [`Symmetry::Exchangeable`] (differences of two estimators' replicates, one to one): the interval
//!   of the sign-flip test, exact if the differences are symmetric about their mean;
//! - [`Symmetry::Unknown`] (differences from a known number, or of two unlike estimators): the
//!   studentised bootstrap, for at least 20 replicates;
//!
//! Where that cannot reach the level, for lack of replicates or of resamples, Student's t is used
//! at a level so much lower that skewness cannot raise it above the requested one ([`crate::lowered`]). If
//! there is none, or a single replicate makes most of the mean, the verdict is *undecided*. A tail whose
//! variance may not exist is undecided by any test.

use crate::bootstrap::Resampling;
use crate::estimate::Estimate;
use crate::interval::Interval;
use crate::lowered;
use crate::sign_flip;
use crate::studentised;
use crate::summary::Summary;
use crate::tails::{Limits, Refusal, Tails};
use crate::verdict::Verdict;

/// What is known of the sample's distribution beforehand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Symmetry {
    /// Differences of exchangeable numbers: symmetric about their mean.
    Exchangeable,
    /// Nothing.
    Unknown,
}

/// How an interval came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// Student's t.
    Student,
    /// Sign flips.
    SignFlip,
    /// The studentised bootstrap.
    Bootstrap,
    /// Student's t at a lower level, for the skewness.
    Lowered,
}

/// An interval with its reasons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judgement {
    /// The interval and how it came about; absent where no method reaches the level.
    pub interval: Option<(Interval, Method)>,
    /// Why Student's t was refused, if it was.
    pub refusal: Option<Refusal>,
}

impl Judgement {
    /// Whether the mean is within ±`margin`; undecided without an interval.
    #[must_use]
    pub fn verdict(&self, margin: f64) -> Verdict {
        self.interval
            .map_or(Verdict::Undecided, |(interval, _)| interval.verdict(margin))
    }

    /// The method, where there is an interval.
    #[must_use]
    pub fn method(&self) -> Option<Method> {
        self.interval.map(|(_, method)| method)
    }

    fn new(
        refusal: Option<Refusal>,
        student: Estimate,
        standardised: f64,
        alpha: f64,
        otherwise: impl FnOnce() -> Option<(Interval, Method)>,
    ) -> Self {
        let lowered = || {
            let level = 2.0 * lowered::level(standardised, 0.5 * alpha)?;
            Some((student.interval(1.0 - level), Method::Lowered))
        };
        let interval = match refusal {
            None => Some((student.interval(1.0 - alpha), Method::Student)),
            Some(Refusal::HeavyTail { .. }) => None,
            Some(Refusal::Energy { .. }) => otherwise(),
            Some(Refusal::Skewness { .. } | Refusal::Outlier { .. }) => {
                otherwise().or_else(lowered)
            }
        };
        Self { interval, refusal }
    }
}

/// The interval that misses a population's mean with probability at most `alpha`, from a sample of
/// independent numbers; `None` of fewer than three or of non-finite ones.
#[must_use]
pub fn judge(
    sample: &[f64],
    alpha: f64,
    symmetry: Symmetry,
    limits: &Limits,
    plan: &Resampling,
) -> Option<Judgement> {
    let tails = Tails::of(sample)?;
    let refusal = tails.refusal(0.5 * alpha, limits);
    let student = Estimate::mean(&Summary::of(sample)?);
    let standard = tails.standardised_skewness();
    let otherwise = || match symmetry {
        Symmetry::Exchangeable => flipped(sample, alpha, plan),
        Symmetry::Unknown => studentised::mean(sample, plan, 1.0 - alpha)
            .map(|interval| (interval, Method::Bootstrap)),
    };
    Some(Judgement::new(refusal, student, standard, alpha, otherwise))
}

/// As [`judge`], for the difference of the means of two independent samples, `a` − `b`. Within the
/// limits it is Welch's interval. Beyond, exchangeable replicates are paired in the order given, if
/// there are as many of each.
///
/// Skewness counts as far as it does not cancel: by the third cumulant of the difference. The other
/// limits hold for each sample.
#[must_use]
pub fn judge_difference(
    a: &[f64],
    b: &[f64],
    alpha: f64,
    symmetry: Symmetry,
    limits: &Limits,
    plan: &Resampling,
) -> Option<Judgement> {
    let (tails_a, tails_b) = (Tails::of(a)?, Tails::of(b)?);
    let (summary_a, summary_b) = (Summary::of(a)?, Summary::of(b)?);
    let student = Estimate::welch(&summary_a, &summary_b);
    let variance = student.standard_error() * student.standard_error();
    // Each skewness by its sample's share of the standard error.
    let weight = |summary: &Summary| {
        let share = if variance > 0.0 {
            summary.variance_of_mean() / variance
        } else {
            0.0
        };
        share * share.sqrt()
    };
    let (wa, wb) = (weight(&summary_a), weight(&summary_b));
    let standard = tails_a.standardised_skewness() * wa - tails_b.standardised_skewness() * wb;
    let level = 0.5 * alpha;
    let refusal = [&tails_a, &tails_b]
        .into_iter()
        .find_map(|tails| tails.refusal_given(standard, level, limits));
    let otherwise = || match symmetry {
        Symmetry::Exchangeable if a.len() == b.len() => {
            let differences: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
            flipped(&differences, alpha, plan)
        }
        _ => studentised::difference(a, b, plan, 1.0 - alpha)
            .map(|interval| (interval, Method::Bootstrap)),
    };
    Some(Judgement::new(refusal, student, standard, alpha, otherwise))
}

fn flipped(sample: &[f64], alpha: f64, plan: &Resampling) -> Option<(Interval, Method)> {
    sign_flip::interval(sample, 1.0 - alpha, plan.resamples, plan.seed)
        .map(|interval| (interval, Method::SignFlip))
}
