//! A picture against its oracle: etalon's decision, and whether the replicates allow it.
//!
//! [`crate::judge`] decides by Student's t. Where the replicates of a mean are too far from normal
//! for that (`etalon_statistics::tails`, with the declared limits), the bias of the image is judged
//! by the studentised bootstrap instead, and where that cannot reach the level, it is undecided. A
//! whole run's levels, below 10⁻⁶ for each question, are beyond it; what is [`stated`] of a row by
//! itself, with 99 % confidence, is not. A
//! tile that t would call different keeps that verdict only if some such tile is within the limits
//! or the bootstrap agrees.
//!
//! Two levels are asked at ([`super::decision`]): that of the intervals, and the much lower one at which
//! a failure is shown. A distribution that t may be trusted with at one can be too skewed for the other.

pub use super::samples::Against;
use super::samples::{Samples, p_of};
use crate::judge::{self, ImageComparison, TileRow, Tolerances};
use crate::tolerance::Tolerance;
use etalon_film::{Metadata, RenderedImage};
use etalon_statistics::{Interval, Verdict};

/// What is asked of a picture beyond its rules.
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    /// Whether equality is claimed, and not only equivalence.
    pub exact: bool,
    /// The level at which a p-value shows a failure; that of the rules at most.
    pub alarm: f64,
}

/// A judgement with its p-value.
pub struct Judged {
    /// The decision of this look.
    pub judgement: ImageComparison,
    /// The p-value of "no fault": of equality for exact oracles, of a bias within the bounds for
    /// others; corrected over all questions of the comparison.
    pub p: f64,
    /// Where the normal approximation was refused, and what took its place.
    pub refusals: Vec<String>,
}

/// Judges a picture.
///
/// # Errors
/// One sentence, if the two cannot be compared.
pub fn judge(
    picture: &RenderedImage,
    against: Against<'_>,
    rules: Tolerances,
    asked: Asked,
) -> Result<Judged, String> {
    let exact = asked.exact;
    let mut judgement = match against {
        Against::ExactImage(known) => judge::judge_known(picture, known, rules)?,
        Against::Picture(other) => judge::judge(picture, other, rules)?,
    };
    let questions = (judgement.images.len() + judgement.tiles.len()) as f64;
    let (alpha, alarm) = (rules.alpha / questions, asked.alarm / questions);
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
        let mut own = samples.p_differs(scale * rules.image_bound);
        if let Some((refusal, interval)) = refused {
            refusals.push(format!("{}: {refusal}", row.channel));
            let interval = interval.unwrap_or(Interval {
                low: f64::NEG_INFINITY,
                high: f64::INFINITY,
            });
            row.interval = [interval.low / scale, interval.high / scale];
            row.verdict = interval.verdict(rules.image_bound * scale);
            let shown = |tolerance| interval.verdict(tolerance) == Verdict::Differs;
            row.p_exact = p_of(shown(rules.rounding * scale), alpha);
            own = p_of(row.verdict == Verdict::Differs, alpha);
        }
        let (p, tolerance) = if exact {
            (&mut row.p_exact, rules.rounding)
        } else {
            (&mut own, rules.image_bound)
        };
        if *p <= alpha && !harmless {
            *p = samples.alarming(*p, tolerance * scale, [alpha, alarm]);
        }
        smallest = smallest.min(*p);
    }
    for row in &mut judgement.tiles {
        let of_image = (scales.iter()).find_map(|(name, x)| (*name == row.channel).then_some(*x));
        let of_image = of_image.unwrap_or(0.0);
        let (mut p, tolerance) = if exact {
            (row.p_exact, Tolerance::exact(rules, of_image))
        } else {
            (row.p_differs, Tolerance::bounded(rules, of_image))
        };
        if p <= alpha {
            let Some(least) = confirmed(metadata, against, row, [alpha, alarm], tolerance)? else {
                refusals.push(format!(
                    "{} tiles of {}²: those off are too far from normal",
                    row.channel, row.side
                ));
                row.verdict = Verdict::Undecided;
                (row.p_exact, row.p_differs) = (1.0, 1.0);
                continue;
            };
            p = least;
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

/// What is said of a picture by itself, at a level of its own ([`super::looks::STATED`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowClaim {
    /// The greatest relative bias of an image's mean that is not excluded: the upper bound of the
    /// greatest |bias| among the channels.
    pub bias: f64,
    /// Whether equality is plausible, where it is claimed: every channel that could not be tested for it
    /// at the run's level has an interval here that does not exclude it.
    pub equal: bool,
}

impl RowClaim {
    /// The verdict of a run that asks each row by itself for the bound of its rules. What differs at
    /// the run's level differs, and tiles keep their say.
    pub fn verdict(&self, judgement: &ImageComparison) -> Verdict {
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
    picture: &RenderedImage,
    against: Against<'_>,
    judgement: &ImageComparison,
    exact: bool,
    alpha: f64,
) -> Result<RowClaim, String> {
    let metadata = picture.metadata.as_ref().ok_or("there are no statistics")?;
    let mut stated = RowClaim {
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
        // Zero is no bias, relative to anything.
        let bias = if reach == 0.0 { 0.0 } else { reach / scale };
        stated.bias = stated.bias.max(bias);
    }
    Ok(stated)
}

/// All means must agree, and no tile may differ or be in doubt.
fn verdict(judgement: &ImageComparison) -> Verdict {
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

/// The least p-value, times the number of tiles, of those that t calls off by more than their
/// tolerance and that are so without a normal approximation, or allow it; `None` if there is no such
/// tile.
fn confirmed(
    metadata: &Metadata,
    against: Against<'_>,
    row: &TileRow,
    levels: [f64; 2],
    tolerance: Tolerance,
) -> Result<Option<f64>, String> {
    let tiles = row.tiles as f64;
    let each = levels.map(|level| level / tiles);
    let mut smallest = None;
    for tile in 0..row.tiles {
        let samples = Samples::of(metadata, against, &row.channel, Some(row.side), tile)?;
        let tolerance = tolerance.at(samples.truth());
        // Holm's first step, in the form that `row`'s own p-values have.
        let p = samples.p_differs(tolerance);
        if p * tiles > levels[0] {
            continue;
        }
        let p = match samples.judge(each[0]) {
            None => p,
            Some((_, Some(interval))) if interval.verdict(tolerance) == Verdict::Differs => {
                p_of(true, each[0])
            }
            Some(_) => continue,
        };
        let p = tiles * samples.alarming(p, tolerance, each);
        smallest = Some(smallest.map_or(p, |least: f64| least.min(p)));
    }
    Ok(smallest)
}
