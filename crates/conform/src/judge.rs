//! The decision: does what a program answers agree with the truth within a bound?
//!
//! The unit is one render. Of each the mean of the picture and of its tiles are compared with the truth's, over all renders: by
//! Student's t, or where their distribution forbids that, at a lower level or not at all. Two levels hold for all questions of a run
//! together (Bonferroni): an interval for *agrees* misses its truth with probability [`Rules::miss`], a sound program is accused with
//! [`Rules::alarm`]. That a mean is too large can be shown whatever the tails ([`etalon_statistics::e_value`]). That
//! it is too small cannot: a rare flash may still be to come. So nothing is called too dark, no tile either, where one picture
//! carries most of the light; a program whose light comes in flashes rarer than the pictures of a run cannot be told from a
//! dark one.

use crate::replicate::{self, Replicate};
use crate::suspicion;
use crate::truth::Picture;
use etalon_statistics::bootstrap::Resampling;
use etalon_statistics::judgement::{self, Symmetry};
use etalon_statistics::tails::Limits;
use etalon_statistics::{Summary, e_value};
use serde::{Deserialize, Serialize};

/// Tiles along a side of a picture.
pub const TILES: u32 = 4;

/// The relative difference of a tile beyond which a program differs, unless [`Rules`] say otherwise.
pub const TILE_BOUND: f64 = 0.03;

/// What is asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// δ: the relative difference of means within which a program agrees.
    pub bound: f64,
    /// The relative difference of a tile beyond which a program differs, of its own mean; δ of the picture's is added.
    pub tile_bound: f64,
    /// The probability that any interval of a run misses.
    pub miss: f64,
    /// The probability that a sound program is accused of anything in a run.
    pub alarm: f64,
    /// How many questions and looks share these.
    pub family: u32,
    /// Whether the program can be called too dark: not one that finds lights by chance alone.
    pub darkness: bool,
}

impl Rules {
    /// δ = 0.5 %; 3 % of a tile; 10⁻³ and 10⁻⁵ for this many questions, each looked at so often.
    pub fn new(questions: usize, looks: u32) -> Self {
        Self {
            bound: 0.005,
            tile_bound: TILE_BOUND,
            miss: 1e-3,
            alarm: 1e-5,
            family: (questions as u32 * looks).max(1),
            darkness: true,
        }
    }
}

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
            replicates: Vec::new(),
        }
    }
}

/// Judges the pictures of one question.
pub fn judge(truth: &Picture, replicates: &[Replicate], rules: &Rules) -> Finding {
    let ratios: Vec<f64> = replicates
        .iter()
        .map(|replicate| replicate.mean() / truth.mean())
        .collect();
    let mut finding = Finding {
        replicates: replicates
            .iter()
            .map(|r| r.pose)
            .zip(ratios.clone())
            .collect(),
        ..Finding::of(Verdict::Undecided(String::new()))
    };
    let asked = Asked {
        truth,
        replicates,
        ratios: &ratios,
        rules,
    };
    finding.verdict = match copies(replicates, truth.pixels) {
        Copies::All if noise(replicates) > rules.bound => Verdict::Broken(
            "all seeds gave the same bits, and not of a picture without noise: they are no replicates"
                .to_owned(),
        ),
        Copies::All => asked.without_noise(&mut finding),
        Copies::Some(a, b) => Verdict::Broken(format!(
            "seeds {a} and {b} gave the same bits: they are no replicates"
        )),
        Copies::None => asked.with_noise(&mut finding),
    };
    let alarm = rules.alarm / f64::from(rules.family);
    finding.suspicion = match finding.verdict {
        Verdict::Differs => {
            suspicion::of(truth, replicates).or_else(|| poses_differ(&finding.replicates, alarm))
        }
        Verdict::Undecided(_) => poses_differ(&finding.replicates, alarm),
        _ => None,
    };
    finding
}

/// Whether seeds made a difference.
enum Copies {
    None,
    /// Two seeds of one pose gave the same, others did not.
    Some(u32, u32),
    /// All of a pose are the same.
    All,
}

fn copies(replicates: &[Replicate], pixels: u32) -> Copies {
    let Some(mean) = replicate::mean(replicates, pixels) else {
        return Copies::None;
    };
    let mut twins = None;
    let (mut pairs, mut same) = (0, 0);
    for (i, a) in replicates.iter().enumerate() {
        for b in replicates[..i].iter().filter(|b| b.pose == a.pose) {
            pairs += 1;
            if a.is_copy_of(b) {
                same += 1;
                // Pictures without noise may well be the same by chance.
                if difference(&a.luminance, &mean.means) > NO_NOISE {
                    twins = twins.or(Some((b.seed, a.seed)));
                }
            }
        }
    }
    match twins {
        _ if pairs > 0 && same == pairs => Copies::All,
        None => Copies::None,
        Some((a, b)) => Copies::Some(a, b),
    }
}

/// With less noise than this in a pixel, relative to the mean, pictures of different seeds may well be the same by chance.
const NO_NOISE: f64 = 1e-3;

/// The difference of two pictures, root mean square over pixels, relative to their mean.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
    let sum: f64 = a.iter().chain(b).sum();
    match square > 0.0 {
        true => (square * a.len() as f64).sqrt() / (0.5 * sum.abs()),
        false => 0.0,
    }
}

/// The greatest difference of a picture from the first. A sound picture is the same in every pose but for its noise, and so is a
/// wrong one without noise.
fn noise(replicates: &[Replicate]) -> f64 {
    let Some((first, others)) = replicates.split_first() else {
        return 0.0;
    };
    others
        .iter()
        .map(|other| difference(&first.luminance, &other.luminance))
        .fold(0.0, f64::max)
}

/// Why a dark picture accuses nobody.
const FOUND_BY_CHANCE: &str =
    "too dark so far; but the program finds lights by chance alone, and may have missed some";

/// A question with its answers.
struct Asked<'a> {
    truth: &'a Picture,
    replicates: &'a [Replicate],
    /// Their means over the truth's.
    ratios: &'a [f64],
    rules: &'a Rules,
}

impl Asked<'_> {
    /// Pictures that no seed changes are judged as they are.
    fn without_noise(&self, finding: &mut Finding) -> Verdict {
        let rules = self.rules;
        let biases = self.ratios.iter().map(|ratio| ratio - 1.0);
        let least = biases.clone().fold(f64::INFINITY, f64::min);
        let most = biases.clone().fold(f64::NEG_INFINITY, f64::max);
        finding.bias = Some(biases.sum::<f64>() / self.ratios.len() as f64);
        finding.interval = Some([least, most]);
        finding.run_interval = finding.interval;
        finding.tile = self.worst_tile(|sample| {
            let beyond = |off: &&f64| **off > 1.0 || rules.darkness && **off < -1.0;
            sample.iter().find(beyond).copied()
        });
        let too_dark = least < -rules.bound;
        if most > rules.bound || too_dark && rules.darkness || finding.tile.is_some() {
            Verdict::Differs
        } else if too_dark {
            Verdict::Undecided(FOUND_BY_CHANCE.to_owned())
        } else {
            Verdict::Agrees
        }
    }

    fn with_noise(&self, finding: &mut Finding) -> Verdict {
        let rules = self.rules;
        let biases: Vec<f64> = self.ratios.iter().map(|ratio| ratio - 1.0).collect();
        let Some(summary) = Summary::of(&biases).filter(|_| biases.len() >= 3) else {
            return Verdict::Undecided(format!("{} pictures are too few", biases.len()));
        };
        finding.bias = Some(summary.mean());
        let family = f64::from(rules.family);
        let tiles = f64::from(TILES * TILES);
        let (miss, alarm) = (rules.miss / family, rules.alarm / (family * (1.0 + tiles)));
        let at = |level: f64| interval(&biases, level);
        finding.interval = at(0.05);
        finding.run_interval = at(miss);
        let of_picture = at(alarm);
        let darkness = rules.darkness && of_picture.is_some();
        finding.tile = self.worst_tile(|sample| {
            let [low, high] = interval(sample, alarm)?;
            let mean = sample.iter().sum::<f64>() / sample.len() as f64;
            (low > 1.0 || darkness && high < -1.0).then_some(mean)
        });
        // Deviations that do not matter need no distribution.
        if biases.iter().all(|bias| bias.abs() <= 0.1 * rules.bound) && finding.tile.is_none() {
            return Verdict::Agrees;
        }
        let beyond = |[low, high]: [f64; 2]| low > rules.bound || darkness && high < -rules.bound;
        let too_bright = e_value::exceeds(self.ratios, 1.0 + rules.bound) >= 1.0 / alarm;
        if of_picture.is_some_and(beyond) || too_bright || finding.tile.is_some() {
            return Verdict::Differs;
        }
        match finding.run_interval {
            Some([low, high]) if low >= -rules.bound && high <= rules.bound => Verdict::Agrees,
            Some([_, high]) if high < -rules.bound && !rules.darkness => {
                Verdict::Undecided(FOUND_BY_CHANCE.to_owned())
            }
            Some([low, high]) => Verdict::Undecided(format!(
                "the interval is ± {:.2} % wide at the level of the run",
                50.0 * (high - low)
            )),
            None => Verdict::Undecided(
                "a few pictures carry most of the light, and no test reaches the level of the run"
                    .to_owned(),
            ),
        }
    }

    /// The tile that is farthest beyond its bound: column, row, and by how many bounds; `beyond` says by how many a sample of
    /// deviations, in bounds, is shown to be, if it is.
    fn worst_tile(&self, beyond: impl Fn(&[f64]) -> Option<f64>) -> Option<(u32, u32, f64)> {
        let Self {
            truth,
            replicates,
            rules,
            ..
        } = self;
        let deviation = |place: u32| {
            let [column, row] = [place % TILES, place / TILES];
            let known = tile_mean(&truth.means, truth.pixels, [column, row]);
            let bound = rules.tile_bound * known + rules.bound * truth.mean();
            let off = |replicate: &Replicate| {
                (tile_mean(&replicate.luminance, truth.pixels, [column, row]) - known) / bound
            };
            let sample: Vec<f64> = replicates.iter().map(off).collect();
            Some((column, row, beyond(&sample)?))
        };
        (0..TILES * TILES)
            .filter_map(deviation)
            .max_by(|(.., a), (.., b)| a.abs().total_cmp(&b.abs()))
    }
}

/// An interval of a mean at a level, if any method reaches it.
fn interval(sample: &[f64], level: f64) -> Option<[f64; 2]> {
    let plan = Resampling::independent(20_000, 1);
    let judged = judgement::judge(sample, level, Symmetry::Unknown, &Limits::DECLARED, &plan)?;
    judged
        .interval
        .map(|(interval, _)| [interval.low, interval.high])
}

/// Whether the first two poses are shown to differ, as no seed makes them.
fn poses_differ(replicates: &[(u32, f64)], level: f64) -> Option<String> {
    let of = |pose: u32| -> Vec<f64> {
        let own = replicates.iter().filter(|(other, _)| *other == pose);
        own.map(|(_, ratio)| ratio - 1.0).collect()
    };
    let [a, b] = [of(0), of(1)];
    let plan = Resampling::independent(20_000, 1);
    let limits = &Limits::DECLARED;
    let judged = judgement::judge_difference(&a, &b, level, Symmetry::Unknown, limits, &plan)?;
    let (interval, _) = judged.interval?;
    let mean = |sample: &[f64]| 100.0 * sample.iter().sum::<f64>() / sample.len() as f64;
    (!interval.contains(0.0)).then(|| {
        format!(
            "its poses differ, {:+.2} % and {:+.2} %: rounding, or something that depends on direction or size",
            mean(&a),
            mean(&b)
        )
    })
}

/// The mean of a tile of a picture.
pub fn tile_mean(means: &[f64], pixels: u32, [column, row]: [u32; 2]) -> f64 {
    let side = (pixels / TILES) as usize;
    let [left, top] = [column, row].map(|n| n as usize * side);
    let rows = (top..top + side).map(|y| &means[y * pixels as usize + left..][..side]);
    rows.flatten().sum::<f64>() / (side * side) as f64
}
