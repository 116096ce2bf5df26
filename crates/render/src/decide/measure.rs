//! A number that a claim is about, with its interval and what is accepted.

use etalon_statistics::{Estimate, Verdict};
use serde::Serialize;

/// A number with its interval.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Measure {
    /// What was measured.
    pub name: String,
    /// The number.
    pub value: f64,
    /// Its confidence interval at this look's level.
    pub interval: [f64; 2],
    /// Between which numbers it must lie.
    pub accepted: [f64; 2],
    /// The p-value of "it lies there".
    pub p: f64,
    /// Whether the interval lies within what is accepted, outside, or neither.
    #[serde(serialize_with = "as_text")]
    pub verdict: Verdict,
}

fn as_text<S: serde::Serializer>(verdict: &Verdict, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(verdict)
}

impl Measure {
    /// An estimate, judged at level `alpha`.
    pub fn new(name: String, estimate: &Estimate, accepted: [f64; 2], alpha: f64) -> Self {
        let interval = estimate.interval(1.0 - alpha);
        let [low, high] = accepted;
        let half = 0.5 * (high - low);
        let centred = Estimate::new(
            estimate.value() - (low + half),
            estimate.standard_error(),
            estimate.degrees_of_freedom(),
        );
        Self {
            name,
            value: estimate.value(),
            interval: [interval.low, interval.high],
            accepted,
            p: centred.map_or(1.0, |centred| centred.p_differs(half)),
            verdict: verdict([interval.low, interval.high], accepted),
        }
    }

    /// A number between two bounds, with the p-value of "what is accepted".
    pub fn bounded(name: &str, value: f64, interval: [f64; 2], accepted: [f64; 2], p: f64) -> Self {
        Self {
            name: name.to_owned(),
            value,
            interval,
            accepted,
            p,
            verdict: verdict(interval, accepted),
        }
    }

    /// A number without chance: how many things differ that must be equal.
    pub fn certain(name: String, differing: usize) -> Self {
        let value = differing as f64;
        let equal = differing == 0;
        Self {
            name,
            value,
            interval: [value, value],
            accepted: [0.0, 0.0],
            p: if equal { 1.0 } else { 0.0 },
            verdict: if equal {
                Verdict::Agrees
            } else {
                Verdict::Differs
            },
        }
    }

    /// The verdict on all, and their p-value (Bonferroni).
    pub fn together(measures: &[Self]) -> (Verdict, f64) {
        let verdict = measures
            .iter()
            .fold(Verdict::Agrees, |all, measure| all.and(measure.verdict));
        let smallest = measures.iter().map(|m| m.p).fold(1.0, f64::min);
        (verdict, (smallest * measures.len() as f64).min(1.0))
    }
}

/// Whether an interval lies inside another, apart from it, or neither.
pub fn verdict([low, high]: [f64; 2], [least, most]: [f64; 2]) -> Verdict {
    if least <= low && high <= most {
        Verdict::Agrees
    } else if low > most || high < least {
        Verdict::Differs
    } else {
        Verdict::Undecided
    }
}
