//! Noise: is the standard error that is reported right?
//!
//! Two statements about a mean m of R independent replicates with the standard error s and the
//! truth t, counted over many means of pictures with different seeds:
//!
//! - E (m − t)² = E s², whatever the distribution: the squared standard error is unbiased. Σ (m − t)²
//!   over Σ s² is a ratio of sums over independent trials; its error is that of the mean residual
//!   (m − t)² − ratio · s² (the delta method).
//! - If replicates are nearly normal, m ± t s covers the truth with the probability that Student's t
//!   with R − 1 degrees of freedom says. The share of those covered is a binomial proportion (Clopper
//!   & Pearson 1934). Where replicates are skewed, fewer are covered, and that is no fault of s: so
//!   this is claimed of the means of tiles, which comparisons are decided by, and of pixels only
//!   where a replicate has many samples or their noise is known to be nearly normal.
//!
//! Trials are independent: those of different seeds are, and so are pixels of one picture, and tiles
//! which share no pixel, unless the integrator splats. One channel is counted, as those of a pixel
//! are not independent of each other. Errors are relative to the truth.

use crate::claim::{Budget, Claim, Estimator, Means};
use crate::closed_form;
use crate::fault::Fault;
use crate::judged;
use crate::measure::{self, Measure};
use crate::rendering;
use etalon::judge::{self, Known};
use etalon_film::Developed;
use etalon_statistics::{Estimate, Summary, proportion};

/// The levels whose intervals are counted.
pub const LEVELS: [f64; 3] = [0.68, 0.95, 0.99];

/// How far the mean squared error may be from the reported one, relative to it.
pub const RATIO_TOLERANCE: f64 = 0.15;

/// The channel that is counted.
const CHANNEL: &str = "G";

/// The side of the tiles that are counted (pixels).
const SIDE: Option<u32> = Some(16);

/// What is counted.
pub struct Counted<'a> {
    /// Whose means.
    pub of: Means,
    /// The closed form that tells the truth.
    pub formula: &'a str,
    /// How many pictures.
    pub seeds: u32,
    /// How far a share of 68 % may be from what it ought to be; others in proportion to their spread.
    pub tolerance: f64,
}

/// A mean: how far it is from the truth, and its standard error; both relative to the truth.
struct Trial {
    off: f64,
    error: f64,
}

/// The coverages and the squared error of an estimator, judged at `alpha` together; and the samples
/// spent.
///
/// # Errors
/// If a picture cannot be rendered, or an integrator makes pixels depend on each other.
pub fn measure(
    claim: &Claim,
    counted: &Counted<'_>,
    estimator: &Estimator,
    fault: Option<Fault>,
    budget: Budget,
    (seed, alpha): (u64, f64),
) -> Result<(Vec<Measure>, u64), String> {
    let shrink = match fault {
        None => 1.0,
        Some(Fault::StandardError) => std::f64::consts::FRAC_1_SQRT_2,
        Some(other) => return Err(format!("`{other}` cannot be planted here")),
    };
    let loaded = rendering::load_for(claim, estimator)?;
    if loaded.integrator.splats() {
        return Err("pixels of an integrator that splats depend on each other".to_owned());
    }
    let size = loaded.compiled.film.crop_size.to_array();
    let known = closed_form::picture(counted.formula, claim, size)?;
    let (mut trials, mut spent) = (Vec::new(), 0);
    for number in 0..counted.seeds {
        let seed = seed.wrapping_add((u64::from(number) + 1) << 32);
        let plan = rendering::plan(&loaded, estimator, budget, seed);
        let picture = rendering::picture(&loaded, &plan, None, None)?;
        match counted.of {
            Means::Pixels => pixels(&picture, &known, &mut trials)?,
            Means::Tiles => tiles(&picture, &known, &mut trials)?,
        }
        spent += u64::from(plan.samples_per_replicate) * u64::from(budget.replicates);
    }
    for trial in &mut trials {
        trial.error *= shrink;
    }
    let freedom = f64::from(budget.replicates) - 1.0;
    let each = alpha / (LEVELS.len() + 1) as f64;
    let coverages = LEVELS
        .iter()
        .map(|level| coverage(&trials, freedom, *level, counted.tolerance, each));
    let ratio = std::iter::once_with(|| squared_error(&trials, each));
    let measures: Option<Vec<Measure>> = coverages.chain(ratio).collect();
    Ok((measures.ok_or("there is nothing to count")?, spent))
}

/// Adds the pixels of a picture.
fn pixels(picture: &Developed, known: &Known, trials: &mut Vec<Trial>) -> Result<(), String> {
    let missing = "the picture has no standard errors, or nothing is known of it";
    let found = known.channels.iter().find(|(name, _)| name == CHANNEL);
    let (_, truth) = found.ok_or(missing)?;
    let means = picture.image.channel(CHANNEL).ok_or(missing)?;
    let errors = picture.standard_error(CHANNEL).ok_or(missing)?;
    for ((mean, error), truth) in means.iter().zip(errors).zip(truth) {
        trials.push(Trial {
            off: f64::from(*mean) / truth - 1.0,
            error: f64::from(*error) / truth,
        });
    }
    Ok(())
}

/// Adds the tiles of a picture.
fn tiles(picture: &Developed, known: &Known, trials: &mut Vec<Trial>) -> Result<(), String> {
    let missing = "the picture has too few replicates";
    let metadata = picture.metadata.as_ref().ok_or(missing)?;
    let (means, count) = judge::replicates(metadata, CHANNEL, SIDE)?;
    for tile in 0..count {
        let truth = judged::tile_mean(known, CHANNEL, SIDE, tile)?;
        let relative = means.iter().skip(tile).step_by(count).map(|x| x / truth);
        let summary = Summary::of_iter(relative).ok_or(missing)?;
        trials.push(Trial {
            off: summary.mean() - 1.0,
            error: summary.standard_error(),
        });
    }
    Ok(())
}

/// How often the interval of `level` covers the truth. The same number of a proportion's standard
/// deviations is accepted at every level.
fn coverage(
    trials: &[Trial],
    freedom: f64,
    level: f64,
    tolerance: f64,
    alpha: f64,
) -> Option<Measure> {
    let mut count = 0;
    for trial in trials {
        let estimate = Estimate::new(trial.off, trial.error, freedom)?;
        count += u64::from(estimate.interval(level).contains(0.0));
    }
    let spread = |p: f64| (p * (1.0 - p)).sqrt();
    let tolerance = tolerance * spread(level) / spread(LEVELS[0]);
    let accepted = [level - tolerance, (level + tolerance).min(1.0)];
    let total = trials.len() as u64;
    let interval = proportion::interval(count, total, 1.0 - alpha)?;
    let bounds = [interval.low, interval.high];
    Some(Measure {
        name: format!("coverage of {:.0} % intervals", 100.0 * level),
        value: count as f64 / total as f64,
        interval: bounds,
        accepted,
        p: proportion::p_outside(count, total, accepted)?,
        verdict: measure::verdict(bounds, accepted),
    })
}

/// The mean squared error over the reported one.
fn squared_error(trials: &[Trial], alpha: f64) -> Option<Measure> {
    let squares = trials.iter().map(|t| (t.off * t.off, t.error * t.error));
    let (errors, reported) = squares.fold((0.0, 0.0), |sum, t| (sum.0 + t.0, sum.1 + t.1));
    let ratio = errors / reported;
    let residuals: f64 = (trials.iter())
        .map(|t| (t.off * t.off - ratio * t.error * t.error).powi(2))
        .sum();
    let estimate = Estimate::with_known_error(ratio, residuals.sqrt() / reported)?;
    let accepted = [1.0 - RATIO_TOLERANCE, 1.0 + RATIO_TOLERANCE];
    let name = "squared error over the reported".to_owned();
    Some(Measure::new(name, &estimate, accepted, alpha))
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
        let judged = |trials: &[Trial]| {
            let shares = LEVELS.map(|level| coverage(trials, 7.0, level, 0.03, 1e-4));
            let ratio = squared_error(trials, 1e-4).expect("trials");
            (shares.map(|share| share.expect("trials").verdict), ratio)
        };
        let (shares, ratio) = judged(&trials);
        assert_eq!(shares, [etalon_statistics::Verdict::Agrees; 3]);
        assert_eq!(ratio.verdict, etalon_statistics::Verdict::Agrees);
        // Mutant rejected: standard errors too small by √2.
        for trial in &mut trials {
            trial.error *= std::f64::consts::FRAC_1_SQRT_2;
        }
        let (shares, ratio) = judged(&trials);
        assert_eq!(shares, [etalon_statistics::Verdict::Differs; 3]);
        assert!((ratio.value - 2.0).abs() < 0.1 && ratio.p < 1e-9);
    }
}
