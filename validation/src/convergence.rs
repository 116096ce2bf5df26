//! Convergence: how fast the squared error falls with the samples of a replicate.
//!
//! E|x − t|² = c nᵇ, with b = −1 for independent samples; Owen-scrambled points in d dimensions
//! reach b = −3 for smooth integrands (Owen 1997) and −1 − 1/d for discontinuous ones (He & Wang
//! 2015). x are the pixels of one replicate of n samples, t those of the closed form; their mean
//! squared distance, over pixels, channels and the replicates of a batch, is fitted by a power law
//! in n. Instead of samples something else may grow, such as the photons of a map. Batches are independent: the exponents of all of them are a sample, and their mean has a
//! t-distributed error.
//!
//! Estimators that are biased but consistent have two exponents. With two replicates in a batch
//!
//! ```text
//! E|x₁ − x₂|²/2 = Var x,   E (x₁ − t)(x₂ − t) = (E x − t)²
//! ```
//!
//! tell the variance and the squared bias apart, neither biased by the other.

use crate::claim::{Budget, Claim, Estimator, Sampler};
use crate::closed_form;
use crate::fault::PlantedFault;
use crate::measure::Measure;
use crate::rendering;
use etalon_film::RenderedImage;
use etalon_math::float64;
use etalon_render::judge::ExactImage;
use etalon_render::pipeline::Loaded;
use etalon_statistics::{Estimate, Line, Summary};
use serde::{Deserialize, Serialize};

/// Replicates of a batch: two, the fewest that have standard errors.
const BATCH: u32 = 2;

/// What is climbed while the error falls.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ladder {
    /// The closed form that tells the error.
    pub formula: String,
    /// Growing numbers: samples per replicate, powers of two for Sobol' points, or the values of a
    /// parameter.
    pub rungs: Vec<u32>,
    /// The scene parameter that takes these values, if it is not the samples that grow: a replicate then has
    /// as many on every rung, all of them together a budget's `spp`.
    pub over: Option<String>,
}

impl Ladder {
    /// # Errors
    /// If it cannot be climbed.
    pub(crate) fn check(&self) -> Result<(), String> {
        if self.rungs.len() < 3 || self.rungs.windows(2).any(|pair| pair[0] >= pair[1]) {
            return Err("`rungs` must be three or more growing numbers".to_owned());
        }
        Ok(())
    }

    /// An estimator on a rung, and the samples of a replicate there.
    fn stand(&self, rung: u32, estimator: &Estimator, budget: Budget) -> (Estimator, u32) {
        let mut standing = estimator.clone();
        let Some(parameter) = &self.over else {
            return (standing, rung);
        };
        let value = toml::Value::Integer(rung.into());
        standing.defines.insert(parameter.clone(), value);
        let replicates = budget.replicates * self.rungs.len() as u32;
        (standing, (budget.spp / replicates).max(1))
    }
}

/// A part of the squared error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// All of it.
    #[default]
    Whole,
    /// That of replicates about their mean.
    Variance,
    /// That of their mean about the truth.
    SquaredBias,
}

impl Part {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Whole => "squared error",
            Self::Variance => "variance",
            Self::SquaredBias => "squared bias",
        }
    }

    /// This part for replicates whose mean is `off` the truth and has the standard error `error`.
    fn of(self, replicates: f64, error: f64, off: f64) -> f64 {
        match self {
            Self::Whole => (replicates - 1.0) * error * error + off * off,
            Self::Variance => replicates * error * error,
            Self::SquaredBias => off * off - error * error,
        }
    }
}

/// How the squared error of one replicate falls.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fall {
    /// What grows from rung to rung.
    pub over: String,
    /// The rung, squared error (the mean of the batches), and its standard error.
    pub points: Vec<[f64; 3]>,
    /// The mean of the batches' fitted exponents.
    pub exponent: f64,
    /// The fitted power law's squared error on a rung 1: the geometric mean of the batches'.
    pub factor: f64,
}

/// What the batches of an estimator came to; more of them may be added.
#[derive(Clone, Debug, Default)]
pub struct Batches {
    /// The exponent of each independent batch.
    pub exponents: Vec<f64>,
    /// The logarithm of the fitted power law's squared error on a rung 1, of each batch.
    logarithms: Vec<f64>,
    /// The squared errors of all batches, by rung.
    errors: Vec<Vec<f64>>,
    /// The samples spent.
    pub spp: u64,
}

impl Batches {
    /// Renders until there are as many batches as the budget has replicates for.
    ///
    /// # Errors
    /// If a picture cannot be rendered or has no error at all.
    pub fn extend(
        &mut self,
        claim: &Claim,
        ladder: &Ladder,
        (estimator, fault): (&Estimator, Option<PlantedFault>),
        budget: Budget,
        seed: u64,
    ) -> Result<(), String> {
        let estimator = match fault {
            Some(PlantedFault::IndependentSamples) => &Estimator {
                sampler: Some(Sampler::Independent),
                ..estimator.clone()
            },
            Some(other) => return Err(format!("`{other}` cannot be planted here")),
            None => estimator,
        };
        let rungs = &ladder.rungs;
        let stands = rungs
            .iter()
            .map(|rung| ladder.stand(*rung, estimator, budget));
        let stands: Vec<(Estimator, u32)> = stands.collect();
        // Where only the samples grow, all rungs have one scene.
        let different = if ladder.over.is_some() {
            rungs.len()
        } else {
            1
        };
        let scenes = stands[..different]
            .iter()
            .map(|(standing, _)| rendering::load_for(claim, standing));
        let scenes = scenes.collect::<Result<Vec<Loaded>, String>>()?;
        let size = scenes[0].compiled.film.crop_size.to_array();
        let known = closed_form::picture(&ladder.formula, claim, estimator, size)?;
        self.errors.resize(rungs.len(), Vec::new());
        let batches = (budget.replicates / BATCH).max(2);
        for batch in self.exponents.len() as u32..batches {
            let (mut x, mut y) = (Vec::new(), Vec::new());
            for (rung, (_, samples)) in stands.iter().enumerate() {
                let loaded = &scenes[rung.min(different - 1)];
                let budget = Budget {
                    spp: samples * BATCH,
                    replicates: BATCH,
                    bound: None,
                };
                // All are independent of each other.
                let number = u64::from(batch) * rungs.len() as u64 + rung as u64;
                let seed = seed.wrapping_add((number + 1) << 32);
                let plan = rendering::plan(loaded, estimator, budget, seed);
                let picture = rendering::picture(loaded, &plan, estimator, None, None)?;
                x.push(match &ladder.over {
                    Some(_) => f64::from(rungs[rung]),
                    None => f64::from(plan.samples_per_replicate),
                });
                let error = squared_error(&picture, &known, estimator.part)?;
                y.push(error);
                self.errors[rung].push(error);
                self.spp += u64::from(plan.samples_per_replicate * BATCH);
            }
            let fit =
                Line::fit_power_law(&x, &y).ok_or("there is no error whose fall can be seen")?;
            self.exponents.push(fit.slope.value());
            self.logarithms.push(fit.intercept.value());
        }
        Ok(())
    }

    /// How the error fell, over all of them.
    pub fn fall(&self, ladder: &Ladder) -> Fall {
        let point = |(n, errors): (&u32, &Vec<f64>)| {
            let summary = Summary::of(errors)?;
            Some([f64::from(*n), summary.mean(), summary.standard_error()])
        };
        let mean = |values: &[f64]| Summary::of(values).map_or(f64::NAN, |s| s.mean());
        let points = ladder.rungs.iter().zip(&self.errors);
        Fall {
            over: (ladder.over.clone()).unwrap_or_else(|| "samples per replicate".to_owned()),
            points: points.filter_map(point).collect(),
            exponent: mean(&self.exponents),
            factor: float64::exp(mean(&self.logarithms)),
        }
    }
}

/// The exponent of all batches together, judged at `alpha`.
///
/// # Errors
/// If there are fewer than two batches, or nothing is accepted of this estimator.
pub fn judge(exponents: &[f64], estimator: &Estimator, alpha: f64) -> Result<Measure, String> {
    let accepted = estimator.exponent.ok_or("there is no `exponent`")?;
    let summary = Summary::of(exponents).ok_or("too few batches")?;
    let name = format!("exponent of the {}", estimator.part.name());
    Ok(Measure::new(
        name,
        &Estimate::mean(&summary),
        accepted,
        alpha,
    ))
}

/// The mean over pixels, channels and replicates of a part of the squared error. With s the
/// standard error of the mean m, all of it is (1/R) Σ (xᵢ − t)² = (R − 1) s² + (m − t)², the
/// variance R s², and the squared bias (m − t)² − s².
fn squared_error(picture: &RenderedImage, known: &ExactImage, part: Part) -> Result<f64, String> {
    let missing = "the picture has no standard errors";
    let metadata = picture.metadata.as_ref().ok_or(missing)?;
    let replicates = f64::from(metadata.replicates);
    let (mut sum, mut count) = (0.0, 0_u32);
    for (channel, truth) in &known.channels {
        let means = picture.image.channel(channel).ok_or(missing)?;
        let errors = picture.standard_error(channel).ok_or(missing)?;
        for ((mean, error), truth) in means.iter().zip(errors).zip(truth) {
            let (error, off) = (f64::from(*error), f64::from(*mean) - truth);
            sum += part.of(replicates, error, off);
            count += 1;
        }
    }
    Ok(sum / f64::from(count))
}
