//! The decision: does what a program answers agree with the truth within a bound?
//!
//! The unit is one render. Of each the mean of the picture and of its tiles are compared with the truth's, over all renders: by
//! Student's t, or where their distribution forbids that, at a lower level or not at all. Two levels hold for all questions of a run
//! together (Bonferroni): an interval for *agrees* misses its truth with probability [`Rules::miss`], a sound program is accused with
//! [`Rules::alarm`].
//!
//! That a mean is too large can be shown whatever the tails ([`etalon_statistics::e_value`]). That it is too small cannot without a
//! bound b on single samples ([`Rules::brightest`]): a rare flash may still be to come. If flashes of b at most carried the light that is
//! missing, a share d of all, n samples would have seen n d/b of them or more, and none with the probability
//!
//! ```text
//! P ≤ (1 − d/b)ⁿ ≤ exp(−n d/b)
//! ```
//!
//! Nothing is called too dark, no tile either, unless that is as rare as a false alarm may be.

use crate::copies::{self, Copies};
use crate::refinement::Refinement;
use crate::replicate::Replicate;
use crate::rules::Rules;
use crate::suspicion;
use crate::tile::{self, TILES};
use crate::truth::Picture;
use etalon_math::float64::ln;
use etalon_statistics::bootstrap::Resampling;
use etalon_statistics::judgement::{self, Symmetry};
use etalon_statistics::tails::Limits;
use etalon_statistics::{Summary, e_value};
use serde::{Deserialize, Serialize};

/// What was decided.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "verdict", content = "reason", rename_all = "snake_case")]
pub enum Verdict {
    /// The mean is shown to be within the bound, and no tile to be beyond its.
    Agrees,
    /// The mean or a tile is shown to be beyond its bound.
    Differs,
    /// Neither: why.
    Undecided(String),
    /// The program cannot express the scene: why.
    NotSupported(String),
    /// There are no pictures that could be judged: why.
    Broken(String),
}

/// What was found of a question.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// The decision.
    #[serde(flatten)]
    pub verdict: Verdict,
    /// Mean over truth, less 1.
    pub bias: Option<f64>,
    /// Its interval, of 95 % by itself.
    pub interval: Option<[f64; 2]>,
    /// Its interval at the level of the run.
    pub run_interval: Option<[f64; 2]>,
    /// The tile that is farthest off, if any is beyond its bound: column, row, and its bias over the bound.
    pub tile: Option<(u32, u32, f64)>,
    /// What the difference looks like.
    pub suspicion: Option<String>,
    /// What was found with more samples.
    pub refinement: Option<Refinement>,
    /// The means of the pictures over the truth's, by pose.
    pub replicates: Vec<(u32, f64)>,
}

impl Finding {
    /// Nothing but a verdict.
    pub fn of(verdict: Verdict) -> Self {
        Self {
            verdict,
            bias: None,
            interval: None,
            run_interval: None,
            tile: None,
            suspicion: None,
            refinement: None,
            replicates: Vec::new(),
        }
    }
}

/// Judges the pictures of one question.
pub fn judge(truth: &Picture, replicates: &[Replicate], rules: &Rules) -> Finding {
    let asked = Asked::new(truth, replicates, rules);
    let alarm = rules.alarm / f64::from(rules.family);
    let decision = asked.decide();
    let ratios = || asked.ratios.iter();
    let biases: Vec<f64> = ratios().map(|ratio| ratio - 1.0).collect();
    let of_poses: Vec<(u32, f64)> = (replicates.iter().map(|r| r.pose))
        .zip(ratios().copied())
        .collect();
    let poses_differ = || suspicion::poses_differ(&of_poses, alarm);
    let suspicion = match &decision.verdict {
        Verdict::Differs => suspicion::of(truth, replicates).or_else(poses_differ),
        // Not accused; but most who are too dark have a unit wrong.
        Verdict::Undecided(why) if why == A_FEW_COULD_MAKE_UP => {
            suspicion::of(truth, replicates).or_else(poses_differ)
        }
        Verdict::Undecided(_) => poses_differ(),
        _ => None,
    };
    let [interval, run_interval] = match (&decision.verdict, decision.noise) {
        (Verdict::Broken(_), _) => [None; 2],
        (_, false) => [range(&biases); 2],
        (_, true) => [0.05, rules.miss_level()].map(|level| interval(&biases, level)),
    };
    let judged = !matches!(decision.verdict, Verdict::Broken(_));
    let summary = Summary::of(&biases).filter(|_| judged);
    Finding {
        bias: summary.map(|summary| summary.mean()),
        interval,
        run_interval,
        tile: decision.tile,
        suspicion,
        replicates: of_poses,
        ..Finding::of(decision.verdict)
    }
}

/// The verdict alone, as [`judge`] finds it.
pub fn decide(truth: &Picture, replicates: &[Replicate], rules: &Rules) -> Verdict {
    Asked::new(truth, replicates, rules).decide().verdict
}

/// Why a dark picture accuses nobody.
const A_FEW_COULD_MAKE_UP: &str =
    "too dark so far; but a few bright samples that have not come yet could make up for it";

/// More pictures than this many times those that there are, are not advised.
const MOST_TO_ADVISE: f64 = 100.0;

/// So many pictures are not all near each other by chance: 16 normal numbers within a third of their deviation are as rare as 10⁻¹².
const MANY: usize = 16;

/// A truth is not off by more than this many of its standard errors: 3·10⁻⁷ of normal numbers are.
const TRUSTED: f64 = 5.0;

/// Pictures whose difference from the bound is this many times that among them are all beyond it.
const FAR: f64 = 3.0;

/// A question with its answers.
struct Asked<'a> {
    truth: &'a Picture,
    replicates: &'a [Replicate],
    /// Their means over the truth's.
    ratios: Vec<f64>,
    rules: &'a Rules,
    /// The bound, less and more by what the truth itself may be off.
    within: f64,
    beyond: f64,
}

/// What came of it.
struct Decision {
    verdict: Verdict,
    /// See [`Finding::tile`].
    tile: Option<(u32, u32, f64)>,
    /// Whether seeds made a difference.
    noise: bool,
}

impl<'a> Asked<'a> {
    fn new(truth: &'a Picture, replicates: &'a [Replicate], rules: &'a Rules) -> Self {
        let mean = truth.mean();
        let uncertain = TRUSTED * truth.error;
        Self {
            truth,
            replicates,
            ratios: replicates.iter().map(|r| r.mean() / mean).collect(),
            rules,
            within: rules.bound - uncertain,
            beyond: rules.bound + uncertain,
        }
    }

    fn decide(&self) -> Decision {
        let broken = |how: String| Decision {
            verdict: Verdict::Broken(how),
            tile: None,
            noise: true,
        };
        match Copies::among(self.replicates, self.truth.pixels) {
            Copies::All if copies::noise(self.replicates) > self.rules.bound => broken(
                "all seeds gave the same bits, and not of a picture without noise: they are no replicates".to_owned(),
            ),
            Copies::All => self.without_noise(),
            Copies::Some(a, b) => broken(format!(
                "seeds {a} and {b} gave the same bits: they are no replicates"
            )),
            Copies::None => self.with_noise(),
        }
    }

    /// Pictures that no seed changes are judged as they are.
    fn without_noise(&self) -> Decision {
        let biases: Vec<f64> = self.ratios.iter().map(|ratio| ratio - 1.0).collect();
        let tile = self.worst_tile(|known, sample| {
            let beyond = |off: &&f64| **off > 1.0 || self.tile_is_dark(known, **off);
            sample.iter().find(beyond).copied()
        });
        let verdict = match range(&biases) {
            Some([low, high]) if high > self.beyond || tile.is_some() || self.is_dark(low) => {
                Verdict::Differs
            }
            Some([low, _]) if low < -self.within => {
                Verdict::Undecided(A_FEW_COULD_MAKE_UP.to_owned())
            }
            _ => Verdict::Agrees,
        };
        Decision {
            verdict,
            tile,
            noise: false,
        }
    }

    fn with_noise(&self) -> Decision {
        let decision = |verdict, tile| Decision {
            verdict,
            tile,
            noise: true,
        };
        let rules = self.rules;
        let biases: Vec<f64> = self.ratios.iter().map(|ratio| ratio - 1.0).collect();
        if biases.len() < 3 {
            let few = format!("{} pictures are too few", biases.len());
            return decision(Verdict::Undecided(few), None);
        }
        let alarm = rules.alarm_level();
        let of_picture = interval(&biases, alarm);
        let tile = self.worst_tile(|known, sample| {
            let mean = sample.iter().sum::<f64>() / sample.len() as f64;
            if mean.abs() <= 1.0 {
                return None; // as its interval holds it
            }
            let [low, high] = interval(sample, alarm)?;
            // Flashes in other tiles are to be expected in this one.
            let dark = || of_picture.is_some() && self.tile_is_dark(known, high);
            (low > 1.0 || dark()).then_some(mean)
        });
        if tile.is_none()
            && let Some(verdict) = self.of_little_noise(&biases)
        {
            return decision(verdict, None);
        }
        let beyond = |[low, high]: [f64; 2]| low > self.beyond || self.is_dark(high);
        let too_bright = || e_value::exceeds(&self.ratios, 1.0 + self.beyond) >= 1.0 / alarm;
        if tile.is_some() || of_picture.is_some_and(beyond) || too_bright() {
            return decision(Verdict::Differs, tile);
        }
        let verdict = match interval(&biases, rules.miss_level()) {
            Some([low, high]) if low >= -self.within && high <= self.within => Verdict::Agrees,
            Some([_, high]) if high < -self.within => {
                Verdict::Undecided(A_FEW_COULD_MAKE_UP.to_owned())
            }
            Some([low, _]) if low > self.within => Verdict::Undecided(
                "too bright so far; but not shown at the level of an accusation".to_owned(),
            ),
            Some(interval) => Verdict::Undecided(self.what_it_would_take(interval)),
            None => Verdict::Undecided(
                "a few pictures carry most of the light, and no test reaches the level of the run"
                    .to_owned(),
            ),
        };
        decision(verdict, None)
    }

    /// Noise that does not matter needs no distribution: of many pictures all are well within the bound, or farther beyond it than
    /// they are from each other.
    fn of_little_noise(&self, biases: &[f64]) -> Option<Verdict> {
        if biases.len() < MANY {
            return None;
        }
        let (beyond, [low, high]) = (self.beyond, range(biases)?);
        let far = FAR * (high - low);
        let half = 0.5 * self.within;
        let all_came = || {
            let missing = half * self.truth.mean();
            self.would_have_come(missing, 1.0, self.rules.miss_level())
        };
        if low >= -half && high <= half && all_came() {
            Some(Verdict::Agrees)
        } else if low > beyond + far || high < -beyond - far && self.is_dark(high) {
            Some(Verdict::Differs)
        } else {
            None
        }
    }

    /// Why an interval decides nothing.
    fn what_it_would_take(&self, [low, high]: [f64; 2]) -> String {
        let bound = self.within;
        let farthest = if -low > high { low } else { high };
        let mut text = format!(
            "at the level of the run the mean may be off by {:+.2} %, and ± {:.2} % are allowed",
            100.0 * farthest,
            100.0 * bound
        );
        // The interval narrows with the root of their number.
        let room = self.within - (0.5 * (low + high)).abs();
        let more = (0.5 * (high - low) / room).powi(2);
        if room > 0.0 && more < MOST_TO_ADVISE {
            text += &format!(
                "; about {:.0} pictures would tell",
                more * self.replicates.len() as f64
            );
        }
        text
    }

    /// Whether a mean that is off by this at most is too small.
    fn is_dark(&self, bias: f64) -> bool {
        let missing = (-self.beyond - bias) * self.truth.mean();
        missing > 0.0 && self.would_have_come(missing, 1.0, self.rules.alarm_level())
    }

    /// Whether a tile that is off by this many of its bounds at most is too dark.
    fn tile_is_dark(&self, known: f64, bounds: f64) -> bool {
        let missing = -1.0 - bounds;
        let (missing, parts) = (missing * self.off(known), f64::from(TILES * TILES));
        missing > 0.0 && self.would_have_come(missing, parts, self.rules.alarm_level())
    }

    /// Whether this much radiance, missing in one of `parts` equal parts of all pictures, would have come by now, in however rare
    /// samples, but for a probability of this level.
    fn would_have_come(&self, missing: f64, parts: f64, level: f64) -> bool {
        let pixels = f64::from(self.truth.pixels * self.truth.pixels);
        let samples = pixels * f64::from(self.rules.samples) * self.replicates.len() as f64 / parts;
        // A pixel that is brighter shows that samples are.
        let pixels = self
            .replicates
            .iter()
            .flat_map(|picture| &picture.luminance);
        let brightest = pixels.copied().fold(self.rules.brightest, f64::max);
        samples * missing / brightest >= -ln(level)
    }

    /// How far a tile of this mean may be off.
    fn off(&self, known: f64) -> f64 {
        self.rules.tile_bound * known + self.rules.bound * self.truth.mean()
    }

    /// The tile that is farthest beyond its bound: column, row, and by how many bounds; `beyond` says, of a tile's mean and a sample
    /// of deviations in bounds, by how many it is shown to be, if it is.
    fn worst_tile(&self, beyond: impl Fn(f64, &[f64]) -> Option<f64>) -> Option<(u32, u32, f64)> {
        let pixels = self.truth.pixels;
        let deviation = |place: u32| {
            let [column, row] = [place % TILES, place / TILES];
            let known = tile::mean(&self.truth.means, pixels, [column, row]);
            let bound = self.off(known);
            let off = |replicate: &Replicate| {
                (tile::mean(&replicate.luminance, pixels, [column, row]) - known) / bound
            };
            let sample: Vec<f64> = self.replicates.iter().map(off).collect();
            Some((column, row, beyond(known, &sample)?))
        };
        (0..TILES * TILES)
            .filter_map(deviation)
            .max_by(|(.., a), (.., b)| a.abs().total_cmp(&b.abs()))
    }
}

/// The least and the greatest.
fn range(biases: &[f64]) -> Option<[f64; 2]> {
    let least = biases.iter().copied().reduce(f64::min)?;
    Some([least, biases.iter().copied().reduce(f64::max)?])
}

/// An interval of a mean at a level, if any method reaches it.
pub(crate) fn interval(sample: &[f64], level: f64) -> Option<[f64; 2]> {
    let judged = judgement::judge(
        sample,
        level,
        Symmetry::Unknown,
        &Limits::DECLARED,
        &RESAMPLING,
    )?;
    judged
        .interval
        .map(|(interval, _)| [interval.low, interval.high])
}

/// How samples are drawn again where they are too skewed for Student's t.
pub(crate) const RESAMPLING: Resampling = Resampling::independent(20_000, 1);
