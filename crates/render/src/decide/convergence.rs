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

use super::measure::Measure;
use crate::judge::ExactImage;
use etalon_film::RenderedImage;
use etalon_math::float64;
use etalon_statistics::{Estimate, Line, Summary};
use serde::{Deserialize, Serialize};

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

/// What independent batches of pictures came to; more of them may be added.
#[derive(Clone, Debug, Default)]
pub struct Batches {
    /// The exponent of each independent batch.
    pub exponents: Vec<f64>,
    /// The logarithm of the fitted power law's squared error on a rung 1, of each batch.
    logarithms: Vec<f64>,
    /// The squared errors of all batches, by rung.
    errors: Vec<Vec<f64>>,
}

impl Batches {
    /// Adds a batch: what grew, and the squared error, from rung to rung. All batches have the same rungs.
    ///
    /// # Errors
    /// If there is no error whose fall can be fitted.
    pub fn add(&mut self, grown: &[f64], errors: &[f64]) -> Result<(), String> {
        let fit = Line::fit_power_law(grown, errors);
        let fit = fit.ok_or("there is no error whose fall can be seen")?;
        self.errors.resize(errors.len(), Vec::new());
        for (all, error) in self.errors.iter_mut().zip(errors) {
            all.push(*error);
        }
        self.exponents.push(fit.slope.value());
        self.logarithms.push(fit.intercept.value());
        Ok(())
    }

    /// How the error fell over these rungs, over all batches.
    pub fn fall(&self, over: &str, rungs: &[u32]) -> Fall {
        let point = |(n, errors): (&u32, &Vec<f64>)| {
            let summary = Summary::of(errors)?;
            Some([f64::from(*n), summary.mean(), summary.standard_error()])
        };
        let mean = |values: &[f64]| Summary::of(values).map_or(f64::NAN, |s| s.mean());
        let points = rungs.iter().zip(&self.errors);
        Fall {
            over: over.to_owned(),
            points: points.filter_map(point).collect(),
            exponent: mean(&self.exponents),
            factor: float64::exp(mean(&self.logarithms)),
        }
    }
}

/// The exponent of all batches together, judged at `alpha`: it must lie within `accepted`.
///
/// # Errors
/// If there are fewer than two batches.
pub fn judge_convergence(
    exponents: &[f64],
    part: Part,
    accepted: [f64; 2],
    alpha: f64,
) -> Result<Measure, String> {
    let summary = Summary::of(exponents).ok_or("too few batches")?;
    let name = format!("exponent of the {}", part.name());
    let estimate = Estimate::mean(&summary);
    Ok(Measure::new(name, &estimate, accepted, alpha))
}

/// The mean over pixels, channels and replicates of a part of the squared error. With s the
/// standard error of the mean m, all of it is (1/R) Σ (xᵢ − t)² = (R − 1) s² + (m − t)², the
/// variance R s², and the squared bias (m − t)² − s².
///
/// # Errors
/// If the picture lacks standard errors or a channel that is known.
pub fn squared_error(
    picture: &RenderedImage,
    known: &ExactImage,
    part: Part,
) -> Result<f64, String> {
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
