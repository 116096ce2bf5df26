//! The replicates of one mean and of its reference, and their comparison by Student's t where that is valid.

use crate::judge::{self, ExactImage};
use etalon_film::{Metadata, RenderedImage};
use etalon_statistics::bootstrap::Resampling;
use etalon_statistics::judgement::{self, Method, Symmetry};
use etalon_statistics::tails::Limits;
use etalon_statistics::{Estimate, Interval, Replicates, Summary, Verdict};

/// What a picture is held against.
#[derive(Clone, Copy)]
pub enum Against<'a> {
    /// A formula.
    ExactImage(&'a ExactImage),
    /// Another picture with replicates.
    Picture(&'a RenderedImage),
}

/// The most resamples of a bootstrap: enough for levels of 10⁻⁶, beyond which tails of 32 replicates are
/// not to be believed.
const RESAMPLES: f64 = 2e7;

/// The replicates of one mean, and of its reference.
pub(super) struct Samples {
    own: Vec<f64>,
    other: Other,
}

pub(super) enum Other {
    ExactImage(f64),
    Replicates(Vec<f64>),
}

impl Samples {
    pub(super) fn of(
        metadata: &Metadata,
        against: Against<'_>,
        channel: &str,
        side: Option<u32>,
        tile: usize,
    ) -> Result<Self, String> {
        let of = |metadata: &Metadata| -> Result<Vec<f64>, String> {
            let (means, tiles) = judge::replicates(metadata, channel, side)?;
            let replicates = Replicates::new(&means, tiles).map_err(|e| e.to_string())?;
            Ok(replicates.tile(tile).collect())
        };
        let other = match against {
            Against::ExactImage(known) => Other::ExactImage(known.tile_mean(channel, side, tile)?),
            Against::Picture(picture) => {
                let metadata = picture.metadata.as_ref().ok_or("there are no statistics")?;
                Other::Replicates(of(metadata)?)
            }
        };
        Ok(Self {
            own: of(metadata)?,
            other,
        })
    }

    /// Whether no replicate is farther than this from what it ought to be.
    pub(super) fn all_within(&self, tolerance: f64) -> bool {
        match &self.other {
            Other::ExactImage(known) => self.own.iter().all(|x| (x - known).abs() <= tolerance),
            Other::Replicates(_) => false,
        }
    }

    /// What the mean ought to be.
    pub(super) fn truth(&self) -> f64 {
        match &self.other {
            Other::ExactImage(known) => *known,
            Other::Replicates(other) => other.iter().sum::<f64>() / other.len() as f64,
        }
    }

    /// The difference of the means.
    pub(super) fn estimate(&self) -> Option<Estimate> {
        Summary::of(&self.own).and_then(|own| match &self.other {
            Other::ExactImage(known) => Some(Estimate::excess(&own, *known)),
            Other::Replicates(other) => Some(Estimate::welch(&own, &Summary::of(other)?)),
        })
    }

    /// The p-value, by Student's t, of a difference within ±`tolerance`.
    pub(super) fn p_differs(&self, tolerance: f64) -> f64 {
        let estimate = self.estimate();
        estimate.map_or(1.0, |estimate| estimate.p_differs(tolerance))
    }

    /// What is left of `p`, which shows a difference beyond ±`tolerance` at the first of two levels, if
    /// the second and lower one is asked: there a normal approximation may be refused that the first
    /// allows, and another interval can show what an interval at the first could not.
    pub(super) fn alarming(&self, p: f64, tolerance: f64, [alpha, alarm]: [f64; 2]) -> f64 {
        match self.judge(alarm) {
            None => p,
            Some((_, Some(interval))) if interval.verdict(tolerance) == Verdict::Differs => {
                p_of(true, alarm)
            }
            Some(_) => p.max(p_of(true, alpha)),
        }
    }

    /// Why a normal approximation is refused, if it is, and the interval of the difference that
    /// misses it with probability `alpha` at most, if there is one.
    pub(super) fn judge(&self, alpha: f64) -> Option<(String, Option<Interval>)> {
        let resamples = (25.0 / alpha).clamp(9_999.0, RESAMPLES) as u32;
        let plan = Resampling::independent(resamples, 1);
        let limits = &Limits::DECLARED;
        let judged = match &self.other {
            Other::ExactImage(known) => {
                let excess: Vec<f64> = self.own.iter().map(|x| x - known).collect();
                judgement::judge(&excess, alpha, Symmetry::Unknown, limits, &plan)
            }
            Other::Replicates(other) => judgement::judge_difference(
                &self.own,
                other,
                alpha,
                Symmetry::Unknown,
                limits,
                &plan,
            ),
        }?;
        let refusal = judged.refusal?;
        let instead = match judged.method() {
            Some(Method::Lowered) => "Student's t at a lower level",
            Some(_) => "bootstrap",
            None => "undecided",
        };
        Some((
            format!("{refusal} ({instead})"),
            judged.interval.map(|(interval, _)| interval),
        ))
    }
}

/// The p-value of an interval at `alpha`: 1, or slightly below `alpha` if it rejects. Corrections divide
/// and multiply it by shares and numbers of hypotheses, whose rounding could otherwise revert some
/// rejections.
pub(super) fn p_of(rejects: bool, alpha: f64) -> f64 {
    if rejects { alpha * (1.0 - 1e-12) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::p_of;
    use crate::decide::decision::ALPHA;
    use etalon_statistics::Family;

    #[test]
    fn a_rejected_interval_stays_rejected_through_every_correction() {
        for size in 1_u32..300 {
            for share in [0.23, 0.31, 0.41, 0.5, 0.77, 1.0] {
                for questions in [3.0, 6.0, 9.0, 12.0] {
                    let mut family = Family::new(ALPHA).expect("a level");
                    (0..size).for_each(|i| {
                        family.declare(i.to_string());
                    });
                    let level = family.level_of_each();
                    let granted = level * share;
                    // As `judge` and `decision` do. Mutant rejected: `alpha` itself, which one
                    // combination in fifteen loses.
                    let p = (p_of(true, granted / questions) * questions).min(1.0);
                    let recorded = family.record(0, p / (granted / level));
                    assert!(recorded.is_ok());
                    assert!(family.decide()[0].rejected, "{size} {share} {questions}");
                }
            }
        }
    }
}
