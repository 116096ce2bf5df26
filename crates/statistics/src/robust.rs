//! A verdict on a mean that does not lean on normality where the sample speaks against it.
//!
//! A sample within the declared limits ([`crate::tails`]) is judged by Student's t. Beyond them a
//! test takes over that needs no normal approximation:
//!
//! - [`Symmetry::Exchangeable`] (differences of two estimators' replicates, one to one): sign flips of
//!   x ∓ margin, exact if the differences are symmetric about their mean;
//! - [`Symmetry::Unknown`] (differences from a known number): the studentised bootstrap, for at least
//!   20 replicates;
//!
//! and where that cannot reach the level, for lack of replicates or of resamples, the verdict is
//! *undecided*. A tail whose variance may not exist is undecided whatever the test.

use crate::bootstrap::{self, Plan};
use crate::estimate::Estimate;
use crate::resampling_test::ResamplingTest;
use crate::sign_flip::{self, Side};
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

/// How a verdict came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// Student's t.
    Student,
    /// Sign flips.
    SignFlip,
    /// The studentised bootstrap.
    Bootstrap,
    /// No test could reach the level.
    None,
}

/// A verdict with its reasons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judgement {
    /// Whether the mean is within ±margin.
    pub verdict: Verdict,
    /// The test that was used.
    pub method: Method,
    /// Why Student's t was refused, if it was.
    pub refusal: Option<Refusal>,
}

/// Judges whether the mean of a population is within ±`margin`, from a sample of independent
/// numbers, each answer false with probability at most `alpha`; `None` of a sample of fewer than
/// three or of non-finite numbers.
#[must_use]
pub fn judge(
    sample: &[f64],
    margin: f64,
    alpha: f64,
    symmetry: Symmetry,
    limits: &Limits,
    plan: &Plan,
) -> Option<Judgement> {
    let tails = Tails::of(sample)?;
    let refusal = tails.refusal(0.5 * alpha, limits);
    let (verdict, method) = match (refusal, symmetry) {
        (None, _) => {
            let estimate = Estimate::mean(&Summary::of(sample)?);
            (estimate.verdict(margin, 1.0 - alpha), Method::Student)
        }
        (Some(Refusal::HeavyTail { .. }), _) => (Verdict::Undecided, Method::None),
        (Some(_), Symmetry::Exchangeable) => flip(sample, margin, alpha, plan)?,
        (Some(_), Symmetry::Unknown) => match bootstrap::studentised(sample, plan, 1.0 - alpha) {
            Some(interval) => (interval.verdict(margin), Method::Bootstrap),
            None => (Verdict::Undecided, Method::None),
        },
    };
    Some(Judgement {
        verdict,
        method,
        refusal,
    })
}

/// Two one-sided tests at each edge of the margin, each at half of `alpha` so that the same
/// interval stands behind both answers, as in the other methods.
fn flip(sample: &[f64], margin: f64, alpha: f64, plan: &Plan) -> Option<(Verdict, Method)> {
    let one_sided = |edge: f64, side: Side| -> Option<ResamplingTest> {
        let shifted: Vec<f64> = sample.iter().map(|x| x - edge).collect();
        sign_flip::test(&shifted, side, plan.resamples, plan.seed)
    };
    let level = 0.5 * alpha;
    let above = one_sided(margin, Side::Greater)?;
    if above.least > level {
        return Some((Verdict::Undecided, Method::None));
    }
    let rejects = |tested: ResamplingTest| tested.p_value <= level;
    let verdict = if rejects(above) || rejects(one_sided(-margin, Side::Less)?) {
        Verdict::Differs
    } else if rejects(one_sided(margin, Side::Less)?) && rejects(one_sided(-margin, Side::Greater)?)
    {
        Verdict::Agrees
    } else {
        Verdict::Undecided
    };
    Some((verdict, Method::SignFlip))
}
