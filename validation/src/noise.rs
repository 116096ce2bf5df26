//! Noise: is the standard error that a picture reports right?
//!
//! If a pixel's replicates are independent and nearly normal, mean ± t s covers the truth with the
//! probability that Student's t with R − 1 degrees of freedom says. Over all pixels of pictures
//! with different seeds the share of those covered is a binomial proportion (Clopper & Pearson
//! 1934); pixels of estimators that do not splat are independent. One channel is counted: those
//! of a pixel are not independent of each other.

use crate::claim::{Budget, Claim, Estimator};
use crate::closed_form;
use crate::fault::Fault;
use crate::measure::{self, Measure};
use crate::rendering;
use etalon_statistics::{Estimate, proportion};

/// The levels whose intervals are counted.
pub const LEVELS: [f64; 3] = [0.68, 0.95, 0.99];

/// The channel that is counted.
const CHANNEL: &str = "G";

/// How many pixels of a picture have intervals that cover the truth, level by level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counted {
    /// Covered, for each of [`LEVELS`].
    pub covered: [u64; LEVELS.len()],
    /// Pixels.
    pub trials: u64,
}

/// Counts the pixels covered in each of `seeds` pictures; and the samples spent.
///
/// # Errors
/// If a picture cannot be rendered, or an integrator makes pixels depend on each other.
pub fn count(
    claim: &Claim,
    (formula, seeds): (&str, u32),
    estimator: &Estimator,
    fault: Option<Fault>,
    budget: Budget,
    seed: u64,
) -> Result<(Vec<Counted>, u64), String> {
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
    let known = closed_form::picture(formula, claim, size)?;
    let found = known.channels.iter().find(|(name, _)| name == CHANNEL);
    let (_, truth) = found.ok_or("nothing is known of channel `G`")?;
    let freedom = f64::from(budget.replicates) - 1.0;
    let (mut pictures, mut spent) = (Vec::new(), 0);
    for number in 0..seeds {
        let seed = seed.wrapping_add((u64::from(number) + 1) << 32);
        let plan = rendering::plan(&loaded, estimator, budget, seed);
        let picture = rendering::picture(&loaded, &plan, None, None)?;
        let missing = "the picture has no standard errors";
        let means = picture.image.channel(CHANNEL).ok_or(missing)?;
        let errors = picture.standard_error(CHANNEL).ok_or(missing)?;
        let mut counted = Counted {
            covered: [0; LEVELS.len()],
            trials: 0,
        };
        for ((mean, error), truth) in means.iter().zip(errors).zip(truth) {
            let error = f64::from(*error) * shrink;
            let estimate = Estimate::new(f64::from(*mean), error, freedom).ok_or(missing)?;
            for (count, level) in counted.covered.iter_mut().zip(LEVELS) {
                *count += u64::from(estimate.interval(level).contains(*truth));
            }
            counted.trials += 1;
        }
        pictures.push(counted);
        spent += u64::from(plan.samples_per_replicate) * u64::from(budget.replicates);
    }
    Ok((pictures, spent))
}

/// The coverages over all pictures, judged at `alpha` together.
///
/// # Errors
/// If there is nothing to count.
pub fn judge(pictures: &[Counted], tolerance: f64, alpha: f64) -> Result<Vec<Measure>, String> {
    let trials: u64 = pictures.iter().map(|picture| picture.trials).sum();
    let each = alpha / LEVELS.len() as f64;
    let measures = LEVELS.iter().enumerate().map(|(index, level)| {
        let count: u64 = pictures.iter().map(|p| p.covered[index]).sum();
        // The same number of a proportion's standard deviations at every level.
        let spread = |p: f64| (p * (1.0 - p)).sqrt();
        let tolerance = tolerance * spread(*level) / spread(LEVELS[0]);
        let accepted = [level - tolerance, (level + tolerance).min(1.0)];
        let interval =
            proportion::interval(count, trials, 1.0 - each).ok_or("there is nothing to count")?;
        let share = count as f64 / trials as f64;
        let error = spread(*level) / (trials as f64).sqrt();
        let excess =
            Estimate::with_known_error(share - level, error).ok_or("there is nothing to count")?;
        let bounds = [interval.low, interval.high];
        Ok(Measure {
            name: format!("coverage of {:.0} % intervals", 100.0 * level),
            value: share,
            interval: bounds,
            accepted,
            p: excess.p_differs(tolerance),
            verdict: measure::verdict(bounds, accepted),
        })
    });
    measures.collect()
}
