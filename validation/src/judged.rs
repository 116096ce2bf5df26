//! A picture against its oracle: etalon's decision, and whether the replicates allow it.
//!
//! [`etalon::judge`] decides by Student's t. Where the replicates of a mean are too far from normal
//! for that (`etalon_statistics::tails`, with the declared limits), the bias of the image is judged
//! by the studentised bootstrap instead, and where that cannot reach the level, it is undecided. A
//! whole run's levels, below 10⁻⁶ for each question, are beyond it; what is [`stated`] of a row by
//! itself, with 99 % confidence, is not. A
//! tile that t would call different keeps that verdict only if some such tile is within the limits
//! or the bootstrap agrees.

use etalon::judge::{self, Judgement, Known, Rules, TileRow};
use etalon::tolerance::Tolerance;
use etalon_film::{Developed, Metadata};
use etalon_statistics::bootstrap::Plan;
use etalon_statistics::robust::{self, Method, Symmetry};
use etalon_statistics::tails::Limits;
use etalon_statistics::{Estimate, Interval, Replicates, Summary, Verdict};

/// The most resamples of a bootstrap: enough for levels of 10⁻⁶, beyond which tails of 32 replicates are
/// not to be believed.
const RESAMPLES: f64 = 2e7;

/// What a picture is held against.
#[derive(Clone, Copy)]
pub enum Against<'a> {
    /// A formula.
    Known(&'a Known),
    /// Another picture with replicates.
    Picture(&'a Developed),
}

/// A judgement with its p-value.
pub struct Judged {
    /// The decision of this look.
    pub judgement: Judgement,
    /// The p-value of "no fault": of equality for exact oracles, of a bias within the bounds for
    /// others; corrected over all questions of the comparison.
    pub p: f64,
    /// Where the normal approximation was refused, and what took its place.
    pub refusals: Vec<String>,
}

/// Judges a picture. `exact` claims equality, not only equivalence.
///
/// # Errors
/// One sentence, if the two cannot be compared.
pub fn judge(
    picture: &Developed,
    against: Against<'_>,
    rules: Rules,
    exact: bool,
) -> Result<Judged, String> {
    let mut judgement = match against {
        Against::Known(known) => judge::judge_known(picture, known, rules)?,
        Against::Picture(other) => judge::judge(picture, other, rules)?,
    };
    let questions = (judgement.images.len() + judgement.tiles.len()) as f64;
    let alpha = rules.alpha / questions;
    let metadata = picture.metadata.as_ref().ok_or("there are no statistics")?;
    let mut refusals = Vec::new();
    let mut smallest = 1.0_f64;
    let mut scales = Vec::new();
    for row in &mut judgement.images {
        let scale = scale_of(row.bias, row.mean - row.other_mean, row.other_mean);
        scales.push((row.channel.clone(), scale));
        let samples = Samples::of(metadata, against, &row.channel, None, 0)?;
        // Deviations that do not matter need no distribution.
        let harmless = samples.all_within(rules.rounding * scale);
        let refused = if harmless { None } else { samples.judge(alpha) };
        let own = match refused {
            Some((refusal, interval)) => {
                refusals.push(format!("{}: {refusal}", row.channel));
                let interval = interval.unwrap_or(Interval {
                    low: f64::NEG_INFINITY,
                    high: f64::INFINITY,
                });
                row.interval = [interval.low / scale, interval.high / scale];
                row.verdict = interval.verdict(rules.image_bound * scale);
                let shown = |tolerance| interval.verdict(tolerance) == Verdict::Differs;
                row.p_exact = p_of(shown(rules.rounding * scale), alpha);
                p_of(row.verdict == Verdict::Differs, alpha)
            }
            None => samples.p_differs(scale * rules.image_bound),
        };
        smallest = smallest.min(if exact { row.p_exact } else { own });
    }
    for row in &mut judgement.tiles {
        let of_image = (scales.iter()).find_map(|(name, x)| (*name == row.channel).then_some(*x));
        let of_image = of_image.unwrap_or(0.0);
        let (p, tolerance) = if exact {
            (row.p_exact, Tolerance::exact(rules, of_image))
        } else {
            (row.p_differs, Tolerance::bounded(rules, of_image))
        };
        if p <= alpha && !confirmed(metadata, against, row, alpha, tolerance)? {
            refusals.push(format!(
                "{} tiles of {}²: those off are too far from normal",
                row.channel, row.side
            ));
            row.verdict = Verdict::Undecided;
            (row.p_exact, row.p_differs) = (1.0, 1.0);
            continue;
        }
        smallest = smallest.min(p);
    }
    judgement.verdict = verdict(&judgement);
    let p = (smallest * questions).min(1.0);
    if exact {
        judgement.p_exact = p;
    }
    Ok(Judged {
        judgement,
        p,
        refusals,
    })
}

/// What is said of a picture by itself, at a level of its own ([`crate::tier::STATED`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stated {
    /// The greatest relative bias of an image's mean that is not excluded: the upper bound of the
    /// greatest |bias| among the channels.
    pub bias: f64,
    /// Whether equality may be believed, where it is claimed: every channel of which nobody could
    /// ask it at the run's level has an interval here that does not exclude it.
    pub equal: bool,
}

impl Stated {
    /// The verdict of a run that asks each row by itself for the bound of its rules. What differs at
    /// the run's level differs, and tiles keep their say.
    pub fn verdict(&self, judgement: &Judgement) -> Verdict {
        if judgement.verdict == Verdict::Differs {
            return Verdict::Differs;
        }
        let own = if self.bias < judgement.rules.image_bound && self.equal {
            Verdict::Agrees
        } else {
            Verdict::Undecided
        };
        let tiles = judgement.tiles.iter().map(|row| row.verdict);
        tiles.fold(own, Verdict::and)
    }
}

/// What can be said of a picture by itself at the level `alpha`. `exact` claims equality.
///
/// No correction is due over the channels for the bias. The bound is exceeded only if the worst
/// channel's bias is outside of that channel's own interval, whichever it is. Equality is not
/// rejected here: what speaks against it only leaves the row undecided.
///
/// # Errors
/// One sentence, if the two cannot be compared.
pub fn stated(
    picture: &Developed,
    against: Against<'_>,
    judgement: &Judgement,
    exact: bool,
    alpha: f64,
) -> Result<Stated, String> {
    let metadata = picture.metadata.as_ref().ok_or("there are no statistics")?;
    let mut stated = Stated {
        bias: 0.0,
        equal: true,
    };
    for row in &judgement.images {
        let scale = scale_of(row.bias, row.mean - row.other_mean, row.other_mean);
        let rounding = judgement.rules.rounding * scale;
        let samples = Samples::of(metadata, against, &row.channel, None, 0)?;
        let harmless = samples.all_within(rounding);
        let refused = if harmless { None } else { samples.judge(alpha) };
        let interval = match refused {
            Some((_, interval)) => interval,
            None => samples
                .estimate()
                .map(|estimate| estimate.interval(1.0 - alpha)),
        };
        let unasked = exact && row.interval.iter().any(|end| end.is_infinite());
        let excluded = |i: Interval| i.verdict(rounding) == Verdict::Differs;
        stated.equal &= !(unasked && interval.is_none_or(excluded));
        let reach = interval.map_or(f64::INFINITY, |i| i.low.abs().max(i.high.abs()));
        // Nothing at all is no bias, whatever it is relative to.
        let bias = if reach == 0.0 { 0.0 } else { reach / scale };
        stated.bias = stated.bias.max(bias);
    }
    Ok(stated)
}

/// The p-value that an interval at `alpha` stands for: 1, or a hair below `alpha` if it rejects. The
/// corrections divide and multiply it by shares and numbers of hypotheses, and what rounding does to
/// `alpha` itself on that way would take some rejections back.
fn p_of(rejects: bool, alpha: f64) -> f64 {
    if rejects { alpha * (1.0 - 1e-12) } else { 1.0 }
}

/// All means must agree, and no tile may differ or be in doubt.
fn verdict(judgement: &Judgement) -> Verdict {
    let images = judgement.images.iter().map(|row| row.verdict);
    let tiles = judgement.tiles.iter().map(|row| row.verdict);
    images.chain(tiles).fold(Verdict::Agrees, Verdict::and)
}

/// What a relative bias was divided by.
fn scale_of(bias: f64, difference: f64, mean: f64) -> f64 {
    let scale = difference / bias;
    if scale > 0.0 && scale.is_finite() {
        scale
    } else {
        mean.abs()
    }
}

/// Whether any tile that t calls off by more than its tolerance is so without a normal
/// approximation, or allows it.
fn confirmed(
    metadata: &Metadata,
    against: Against<'_>,
    row: &TileRow,
    alpha: f64,
    tolerance: Tolerance,
) -> Result<bool, String> {
    let each = alpha / row.tiles as f64;
    for tile in 0..row.tiles {
        let samples = Samples::of(metadata, against, &row.channel, Some(row.side), tile)?;
        let tolerance = tolerance.at(samples.truth());
        // Holm's first step, in the form that `row`'s own p-values have.
        if samples.p_differs(tolerance) * row.tiles as f64 > alpha {
            continue;
        }
        match samples.judge(each) {
            None => return Ok(true),
            Some((_, Some(interval))) if interval.verdict(tolerance) == Verdict::Differs => {
                return Ok(true);
            }
            Some(_) => {}
        }
    }
    Ok(false)
}

/// The replicates of one mean, and of what it is held against.
struct Samples {
    own: Vec<f64>,
    other: Other,
}

enum Other {
    Known(f64),
    Replicates(Vec<f64>),
}

impl Samples {
    fn of(
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
            Against::Known(known) => Other::Known(tile_mean(known, channel, side, tile)?),
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
    fn all_within(&self, tolerance: f64) -> bool {
        match &self.other {
            Other::Known(known) => self.own.iter().all(|x| (x - known).abs() <= tolerance),
            Other::Replicates(_) => false,
        }
    }

    /// What the mean ought to be.
    fn truth(&self) -> f64 {
        match &self.other {
            Other::Known(known) => *known,
            Other::Replicates(other) => other.iter().sum::<f64>() / other.len() as f64,
        }
    }

    /// The difference of the means.
    fn estimate(&self) -> Option<Estimate> {
        Summary::of(&self.own).and_then(|own| match &self.other {
            Other::Known(known) => Some(Estimate::excess(&own, *known)),
            Other::Replicates(other) => Some(Estimate::welch(&own, &Summary::of(other)?)),
        })
    }

    /// The p-value, by Student's t, of a difference within ±`tolerance`.
    fn p_differs(&self, tolerance: f64) -> f64 {
        let estimate = self.estimate();
        estimate.map_or(1.0, |estimate| estimate.p_differs(tolerance))
    }

    /// Why a normal approximation is refused, if it is, and the interval of the difference that
    /// misses it with probability `alpha` at most, if there is one.
    fn judge(&self, alpha: f64) -> Option<(String, Option<Interval>)> {
        let resamples = (25.0 / alpha).clamp(9_999.0, RESAMPLES) as u32;
        let plan = Plan::independent(resamples, 1);
        let limits = &Limits::DECLARED;
        let judged = match &self.other {
            Other::Known(known) => {
                let excess: Vec<f64> = self.own.iter().map(|x| x - known).collect();
                robust::judge(&excess, alpha, Symmetry::Unknown, limits, &plan)
            }
            Other::Replicates(other) => {
                robust::judge_difference(&self.own, other, alpha, Symmetry::Unknown, limits, &plan)
            }
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

/// The mean of a known picture over one tile of `side` pixels, or over the whole image.
///
/// # Errors
/// If it has no such channel.
pub(crate) fn tile_mean(
    known: &Known,
    channel: &str,
    side: Option<u32>,
    tile: usize,
) -> Result<f64, String> {
    let missing = || format!("nothing is known of channel `{channel}`");
    let found = known.channels.iter().find(|(name, _)| name == channel);
    let (_, pixels) = found.ok_or_else(missing)?;
    let [width, height] = known.size.map(|n| n as usize);
    let side = side.map_or(width.max(height), |side| side as usize);
    let columns = width.div_ceil(side);
    let (left, top) = (tile % columns * side, tile / columns * side);
    let (right, bottom) = ((left + side).min(width), (top + side).min(height));
    let sum: f64 = (top..bottom)
        .map(|y| {
            pixels[y * width + left..y * width + right]
                .iter()
                .sum::<f64>()
        })
        .sum();
    Ok(sum / ((bottom - top) * (right - left)) as f64)
}

#[cfg(test)]
mod tests {
    use super::p_of;
    use crate::decision::ALPHA;
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
