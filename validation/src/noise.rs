//! Noise: is the standard error that is reported right?
//!
//! Two statements about a mean m of R independent replicates with the standard error s and the
//! truth t, counted over many means of pictures with different seeds:
//!
//! - E (m − t)² = E s², for any distribution: the squared standard error is unbiased. Σ (m − t)²
//!   over Σ s² is a ratio of sums over independent trials; its error is that of the mean residual
//!   (m − t)² − ratio · s² (the delta method).
//! - If replicates are nearly normal, m ± t s covers the truth with the probability that Student's t
//!   with R − 1 degrees of freedom says. The share of those covered is a binomial proportion (Clopper
//!   & Pearson 1934). Where replicates are skewed, fewer are covered, and that is no fault of s: so
//!   this is claimed of the means of tiles, which comparisons are decided by, and of pixels only
//!   where a replicate has many samples or their noise is known to be nearly normal.
//!
//! Of replicates that are blocks of one sequence the standard error is an upper estimate, so the statements
//! are one-sided: the squared error is at most the reported one, and intervals cover at least at their rate.
//!
//! Trials are independent: those of different seeds are, and so are pixels of one picture, and tiles
//! which share no pixel, unless the integrator splats or pixels share samples: claims are of films whose filter is `box` or
//! importance-sampled (checked). One channel is counted, as those of a pixel
//! are not independent of each other. Errors are relative to the truth.

use crate::batch_cache::BatchCache;
use crate::batches;
use crate::claim::{Budget, Claim, Counting, Effort, Estimator, Means};
use crate::closed_form;
use crate::fault::PlantedFault;
use crate::rendering;
use crate::tier::Tier;
use etalon_film::{Metadata, RenderedImage};
use etalon_render::decide::measure::{self, Measure};
use etalon_render::judge::{self, ExactImage};
use etalon_statistics::{Estimate, Summary, proportion};
use std::ops::Range;

/// The levels whose intervals are counted.
pub const LEVELS: [f64; 3] = [0.68, 0.95, 0.99];

/// How far the mean squared error may be from the reported one, relative to it, where coverages may be off by
/// `tolerance`: 0.15, or more where a quick look is content with less.
pub fn ratio_tolerance(tolerance: f64) -> f64 {
    (2.5 * tolerance).max(0.15)
}

/// The channel that is counted.
const CHANNEL: &str = "G";

/// The side of the tiles that are counted (pixels).
const SIDE: Option<u32> = Some(16);

impl Counting {
    /// What is made of it in a tier. A quarter of the pictures shows a fault, and of the fewest.
    pub fn effort(&self, tier: Tier, fault: Option<PlantedFault>) -> Effort {
        let all = Effort {
            seeds: self.seeds,
            tolerance: self.tolerance,
        };
        let least = self.default.unwrap_or(all);
        match (fault, tier) {
            (Some(_), _) => Effort {
                seeds: 2 * least.seeds.div_ceil(8),
                ..least
            },
            (None, Tier::Default) => least,
            (None, Tier::Thorough | Tier::Full) => all,
        }
    }
}

/// What is counted of a picture, or of several.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counted {
    /// Means whose intervals cover the truth, for each of [`LEVELS`].
    pub covered: [u64; LEVELS.len()],
    /// Means.
    pub trials: u64,
    /// Σ a, Σ b, Σ a², Σ ab, Σ b² of the squared errors a and the squares b of the reported errors.
    pub squares: [f64; 5],
}

/// A mean: how far it is from the truth, and its standard error; both relative to the truth.
struct Trial {
    off: f64,
    error: f64,
}

/// Counts the means of each of the pictures with these numbers; the samples that one takes are those
/// of the budget.
///
/// # Errors
/// If a picture cannot be rendered, or an integrator makes pixels depend on each other.
pub(crate) fn count(
    claim: &Claim,
    (counting, numbers): (&Counting, Range<u32>),
    estimator: &Estimator,
    fault: Option<PlantedFault>,
    budget: Budget,
    seed: u64,
    kept: &BatchCache<'_>,
) -> Result<Vec<Counted>, String> {
    let shrink = match fault {
        None => 1.0,
        Some(PlantedFault::StandardError) => std::f64::consts::FRAC_1_SQRT_2,
        Some(other) => return Err(format!("`{other}` cannot be planted here")),
    };
    let loaded = rendering::load_for(claim, estimator)?;
    if loaded.integrator.splats() {
        return Err("pixels of an integrator that splats depend on each other".to_owned());
    }
    let size = loaded.compiled.film.crop_size.to_array();
    let known = closed_form::picture(&counting.formula, claim, estimator, size)?;
    let freedom = f64::from(budget.replicates) - 1.0;
    let print = batches::fingerprint(estimator);
    let mut pictures = Vec::new();
    for number in numbers {
        let seed = seed.wrapping_add((u64::from(number) + 1) << 32);
        let plan = rendering::plan(&loaded, estimator, budget, seed);
        let name = format!("{print:08x}-{number}");
        let render = || rendering::picture(&loaded, &plan, estimator, None, None);
        let picture = kept.shared(&claim.name, &name, render)?;
        let shared = |metadata: &Metadata| metadata.film.filter_method.is_some();
        if picture.metadata.as_ref().is_some_and(shared) {
            return Err("pixels that share samples depend on each other".to_owned());
        }
        let mut trials = match counting.of {
            Means::Pixels => pixels(&picture, &known)?,
            Means::Tiles => tiles(&picture, &known)?,
        };
        for trial in &mut trials {
            trial.error *= shrink;
        }
        let counted = Counted::of(&trials, freedom);
        pictures.push(counted.ok_or("a mean or its truth is not a number above 0")?);
    }
    Ok(pictures)
}

/// The coverages and the squared error over all pictures, judged at `alpha` together; one-sided if the
/// replicates are `blocks`.
///
/// # Errors
/// If there is nothing to count.
pub fn judge(
    pictures: &[Counted],
    blocks: bool,
    tolerance: f64,
    alpha: f64,
) -> Result<Vec<Measure>, String> {
    let all = (pictures.iter()).fold(Counted::default(), |all, picture| all.and(picture));
    let each = alpha / (LEVELS.len() + 1) as f64;
    let coverages = (0..LEVELS.len()).map(|index| all.coverage(index, blocks, tolerance, each));
    let ratio = std::iter::once_with(|| all.squared_error(blocks, tolerance, each));
    let measures: Option<Vec<Measure>> = coverages.chain(ratio).collect();
    measures.ok_or_else(|| "there is nothing to count".to_owned())
}

/// The pixels of a picture.
fn pixels(picture: &RenderedImage, known: &ExactImage) -> Result<Vec<Trial>, String> {
    let missing = "the picture has no standard errors, or nothing is known of it";
    let truth = known.channel(CHANNEL)?;
    let means = picture.image.channel(CHANNEL).ok_or(missing)?;
    let errors = picture.standard_error(CHANNEL).ok_or(missing)?;
    let all = means.iter().zip(errors).zip(truth);
    let trials = all.map(|((mean, error), truth)| Trial {
        off: f64::from(*mean) / truth - 1.0,
        error: f64::from(*error) / truth,
    });
    Ok(trials.collect())
}

/// The tiles of a picture.
fn tiles(picture: &RenderedImage, known: &ExactImage) -> Result<Vec<Trial>, String> {
    let missing = "the picture has too few replicates";
    let metadata = picture.metadata.as_ref().ok_or(missing)?;
    let (means, count) = judge::replicates(metadata, CHANNEL, SIDE)?;
    let trial = |tile: usize| {
        let truth = known.tile_mean(CHANNEL, SIDE, tile)?;
        let relative = means.iter().skip(tile).step_by(count).map(|x| x / truth);
        let summary = Summary::of_iter(relative).ok_or(missing)?;
        Ok(Trial {
            off: summary.mean() - 1.0,
            error: summary.standard_error(),
        })
    };
    (0..count).map(trial).collect()
}

impl Counted {
    /// Of trials whose standard errors have `freedom` degrees of freedom.
    fn of(trials: &[Trial], freedom: f64) -> Option<Self> {
        let mut all = Self::default();
        for trial in trials {
            let estimate = Estimate::new(trial.off, trial.error, freedom)?;
            for (count, level) in all.covered.iter_mut().zip(LEVELS) {
                *count += u64::from(estimate.interval(level).contains(0.0));
            }
            all.trials += 1;
            let (a, b) = (trial.off * trial.off, trial.error * trial.error);
            for (sum, term) in all.squares.iter_mut().zip([a, b, a * a, a * b, b * b]) {
                *sum += term;
            }
        }
        Some(all)
    }

    /// Both.
    fn and(self, other: &Self) -> Self {
        Self {
            covered: std::array::from_fn(|i| self.covered[i] + other.covered[i]),
            trials: self.trials + other.trials,
            squares: std::array::from_fn(|i| self.squares[i] + other.squares[i]),
        }
    }

    /// How often the interval of a level covers the truth. The same number of a proportion's standard
    /// deviations is accepted at every level.
    fn coverage(&self, index: usize, blocks: bool, tolerance: f64, alpha: f64) -> Option<Measure> {
        let (count, level) = (self.covered[index], LEVELS[index]);
        let spread = |p: f64| (p * (1.0 - p)).sqrt();
        let tolerance = tolerance * spread(level) / spread(LEVELS[0]);
        let most = if blocks {
            1.0
        } else {
            (level + tolerance).min(1.0)
        };
        let accepted = [level - tolerance, most];
        let interval = proportion::interval(count, self.trials, 1.0 - alpha)?;
        let bounds = [interval.low, interval.high];
        Some(Measure {
            name: format!("coverage of {:.0} % intervals", 100.0 * level),
            value: count as f64 / self.trials as f64,
            interval: bounds,
            accepted,
            p: proportion::p_outside(count, self.trials, accepted)?,
            verdict: measure::verdict(bounds, accepted),
        })
    }

    /// The mean squared error over the reported one.
    fn squared_error(&self, blocks: bool, tolerance: f64, alpha: f64) -> Option<Measure> {
        let tolerance = ratio_tolerance(tolerance);
        let [errors, reported, aa, ab, bb] = self.squares;
        let ratio = errors / reported;
        // Σ (a − ratio b)².
        let residuals = (aa - 2.0 * ratio * ab + ratio * ratio * bb).max(0.0);
        let estimate = Estimate::with_known_error(ratio, residuals.sqrt() / reported)?;
        let least = if blocks { 0.0 } else { 1.0 - tolerance };
        let accepted = [least, 1.0 + tolerance];
        let name = "squared error over the reported".to_owned();
        Some(Measure::new(name, &estimate, accepted, alpha))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Means of 8 normal numbers, by Box and Muller's method from a golden-ratio sequence's hash.
    fn trials(count: u32) -> Vec<Trial> {
        let mut state = 1_u64;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            ((state >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
        };
        let mut normal = || {
            let (u, v) = (uniform(), uniform());
            let angle = std::f64::consts::TAU * v;
            (-2.0 * etalon_math::float64::ln(u)).sqrt() * etalon_math::float64::cos(angle)
        };
        (0..count)
            .map(|_| {
                let replicates: [f64; 8] = std::array::from_fn(|_| normal());
                let summary = Summary::of(&replicates).expect("eight numbers");
                Trial {
                    off: summary.mean(),
                    error: summary.standard_error(),
                }
            })
            .collect()
    }

    #[test]
    fn normal_noise_passes_and_errors_that_are_too_small_do_not() {
        // α = 10⁻⁴ in each measure.
        let mut trials = trials(16_384);
        let judged = |trials: &[Trial], blocks: bool| {
            let counted = Counted::of(trials, 7.0).expect("numbers");
            let mut measures = judge(&[counted], blocks, 0.03, 4e-4).expect("trials");
            let ratio = measures.pop().expect("four measures");
            let shares: Vec<_> = measures.iter().map(|share| share.verdict).collect();
            (shares, ratio)
        };
        let (shares, ratio) = judged(&trials, false);
        assert_eq!(shares, [etalon_statistics::Verdict::Agrees; 3]);
        assert_eq!(ratio.verdict, etalon_statistics::Verdict::Agrees);
        // Upper estimates are right for blocks, and wrong for independent replicates.
        for trial in &mut trials {
            trial.error *= 1.5;
        }
        for (blocks, verdict) in [
            (true, etalon_statistics::Verdict::Agrees),
            (false, etalon_statistics::Verdict::Differs),
        ] {
            let (shares, ratio) = judged(&trials, blocks);
            assert_eq!(shares[..2], [verdict; 2]);
            assert_eq!(ratio.verdict, verdict);
        }
        for trial in &mut trials {
            trial.error /= 1.5;
        }
        // Mutant rejected: standard errors too small by √2.
        for trial in &mut trials {
            trial.error *= std::f64::consts::FRAC_1_SQRT_2;
        }
        for blocks in [false, true] {
            let (shares, ratio) = judged(&trials, blocks);
            assert_eq!(shares, [etalon_statistics::Verdict::Differs; 3]);
            assert!((ratio.value - 2.0).abs() < 0.1 && ratio.p < 1e-9);
        }
    }
}
