//! Rendering to an error or for a time: a pilot, which is no part of the image, fixes the number of
//! samples before the first of them is drawn.
//!
//! The relative standard error of an image of N samples per pixel is
//!
//! ```text
//! e = √( Σ_c ⟨s²⟩_c / Σ_c m_c² )            e² = V / N
//! ```
//!
//! with ⟨s²⟩ the mean over pixels of the squared standard error, m the mean over pixels, and the sums over the
//! colours. The pilot is [`GROUPS`] independent pictures of two replicates each. Each gives an unbiased estimate
//! of V (except for m, which is estimated from all of them); Student's t with one degree of freedom less
//! than there are pictures bounds ln V from above with 95 % confidence, and N = V/e² follows.
//!
//! Nothing of the pilot goes into the image, and its samples have seeds of their own. So N is independent
//! of the image's samples: the image is that of a request for N samples, and its standard error is as
//! valid. There is no look at the image before it is finished, and no optional stopping. The price:
//! whether the target was reached is known only at the end, and is reported.

use crate::adaptive::Distribution;
use crate::loaded::Loaded;
use crate::pilot::{Failure, GROUPS, pilot_picture};
use crate::sizes::{MOST, sized};
use etalon_film::{RenderedImage, SampleCounts};
use etalon_integrators::{Progress, RenderPlan};
use etalon_math::float64;
use etalon_params::Diagnostic;
use etalon_statistics::{Summary, student_t};
use std::ops::RangeInclusive;
use std::time::Instant;

/// What an image is to reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// A relative standard error.
    Error(f64),
    /// A time for everything (s).
    Seconds(f64),
}

/// The confidence with which the error is reached.
const CONFIDENCE: f64 = 0.95;

/// The relative standard errors that may be asked for.
pub const ERRORS: RangeInclusive<f64> = 1e-6..=1.0;

/// The times (s) that may be asked for.
pub const SECONDS: RangeInclusive<f64> = 1e-3..=1e8;

/// Samples per pixel of a pilot, by default.
pub const PILOT: u32 = 64;

/// Of a time, the share after which a pilot has seen enough.
const PILOT_SHARE: f64 = 0.05;

/// The noise of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Noise {
    /// Σ_c ⟨s²⟩_c: the mean over pixels of the squared standard error, summed over colours.
    pub variance: f64,
    /// The mean of each colour over the pixels.
    pub mean: Vec<f64>,
}

impl Noise {
    /// The noise of a picture; `None` without standard errors.
    pub fn of(developed: &RenderedImage) -> Option<Self> {
        let (mut variance, mut mean) = (0.0, Vec::new());
        for name in developed.colours() {
            let means = developed.image.channel(name)?;
            let errors = developed.standard_error(name)?;
            let count = means.len() as f64;
            mean.push(means.iter().map(|&m| f64::from(m)).sum::<f64>() / count);
            variance += errors.iter().map(|&s| f64::from(s).powi(2)).sum::<f64>() / count;
        }
        Some(Self { variance, mean })
    }

    /// Σ_c m_c².
    fn mean_square(&self) -> f64 {
        self.mean.iter().map(|m| m * m).sum()
    }

    /// The relative standard error; `None` of a black picture.
    pub fn relative(&self) -> Option<f64> {
        let square = self.mean_square();
        (square > 0.0).then(|| (self.variance / square).sqrt())
    }
}

/// What a pilot found, and what follows from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fixed {
    /// What to render.
    pub plan: RenderPlan,
    /// Samples per pixel that the pilot took.
    pub pilot: u32,
    /// Time that the pilot took (s).
    pub seconds: f64,
}

/// Renders a pilot (of as many samples as a time allows, if that is aimed at) and fixes a plan like `plan`,
/// but of as many samples as the target needs. `replicates` keeps their number.
///
/// # Errors
/// If no number of samples can reach the target, or `progress` says to stop.
pub fn fix(
    loaded: &Loaded,
    plan: &RenderPlan,
    target: Target,
    pilot: Pilot<'_>,
    replicates: Option<u32>,
    progress: &dyn Progress,
) -> Result<Fixed, Failure> {
    let (needed, taken) = match target {
        Target::Error(error) => error_pilot(loaded, plan, error, pilot, progress)?,
        Target::Seconds(seconds) => time_pilot(loaded, plan, seconds, pilot, progress)?,
    };
    let up = matches!(target, Target::Error(_));
    Ok(Fixed {
        plan: sized(plan, needed, replicates, up),
        pilot: taken,
        seconds: pilot.start.elapsed().as_secs_f64(),
    })
}

/// What is known of a pilot before it begins.
#[derive(Clone, Copy, Debug)]
pub struct Pilot<'a> {
    /// Samples per pixel, about, of one that aims at an error.
    pub samples: u32,
    /// How the picture's samples will be dealt, if not evenly.
    pub distribution: Option<&'a Distribution>,
    /// When what counts as its time began.
    pub start: Instant,
}

impl Pilot<'_> {
    /// How `each` samples per pixel are dealt, if not evenly.
    fn counts(&self, plan: &RenderPlan, each: u32) -> Option<SampleCounts> {
        self.distribution.map(|d| d.counts(plan.sampler, each))
    }
}

/// The samples per pixel, 16 times a power of two or a little more and at most [`PILOT`], of a pilot that takes
/// a tenth of a time (s), and never fewer than 16.
///
/// # Errors
/// As [`fix`].
pub fn affordable(
    loaded: &Loaded,
    plan: &RenderPlan,
    seconds: f64,
    progress: &dyn Progress,
) -> Result<u32, Failure> {
    let (_, cold) = pilot_picture(loaded, plan, None, GROUPS, 1, progress)?;
    let pace = cold / 2.0;
    let mut samples = 2 * GROUPS;
    while samples < PILOT && pace * f64::from(2 * samples) <= 2.0 * PILOT_SHARE * seconds {
        samples *= 2;
    }
    Ok(samples)
}

/// The samples per pixel that bring the relative standard error below `error`, and those of the pilot.
fn error_pilot(
    loaded: &Loaded,
    plan: &RenderPlan,
    error: f64,
    pilot: Pilot<'_>,
    progress: &dyn Progress,
) -> Result<(f64, u32), Failure> {
    let each = plan.sampler.round_up(pilot.samples.div_ceil(2 * GROUPS));
    let mut found = Vec::new();
    for index in 0..GROUPS {
        let (developed, _) = pilot_picture(
            loaded,
            plan,
            pilot.counts(plan, each),
            index,
            each,
            progress,
        )?;
        found.push(Noise::of(&developed).ok_or_else(|| {
            Diagnostic::error_nowhere(
                "an error cannot be aimed at: the film has no colours".to_owned(),
            )
        })?);
    }
    let needed = samples_for(&found, f64::from(2 * each), error).map_err(|reason| {
        Diagnostic::error_nowhere(format!("no error can be aimed at: {reason}"))
            .help("name the number of samples with `--spp`, or let the pilot take more (`--pilot`)")
    })?;
    if needed > MOST {
        let message = format!(
            "a relative standard error of {error} would take {needed:.1e} samples per pixel, more than \
             {MOST:.1e}"
        );
        return Err(Diagnostic::error_nowhere(message)
            .help("aim at a larger error")
            .into());
    }
    Ok((needed, 2 * GROUPS * each))
}

/// N: the upper bound of V, over the squared error.
fn samples_for(found: &[Noise], samples: f64, error: f64) -> Result<f64, &'static str> {
    let count = found.len() as f64;
    let mut mean = vec![0.0; found.first().map_or(0, |noise| noise.mean.len())];
    for noise in found {
        for (mean, of_one) in mean.iter_mut().zip(&noise.mean) {
            *mean += of_one / count;
        }
    }
    let square: f64 = mean.iter().map(|m| m * m).sum();
    if !(square > 0.0) {
        return Err("the pilot found no light");
    }
    let per_sample: Vec<f64> = (found.iter())
        .map(|noise| samples * noise.variance / square)
        .collect();
    let summary = Summary::of(&per_sample).ok_or("the pilot's noise is not finite")?;
    let spread = (summary.variance() / count).sqrt();
    let quantile = student_t::upper_quantile(1.0 - CONFIDENCE, count - 1.0);
    let (mean, relative) = match summary.mean() {
        0.0 => (0.0, 0.0),
        mean => (mean, spread / mean),
    };
    // On the scale of logarithms: variances are skewed, and a bound by the mean plus so many spreads
    // suffices too seldom.
    Ok(mean * float64::exp(quantile * relative) / (error * error))
}

/// The samples per pixel that fit into a time, and those of the pilot.
fn time_pilot(
    loaded: &Loaded,
    plan: &RenderPlan,
    seconds: f64,
    pilot: Pilot<'_>,
    progress: &dyn Progress,
) -> Result<(f64, u32), Failure> {
    let start = pilot.start;
    let before = start.elapsed().as_secs_f64();
    // The first picture finds cold caches; its time is spent, but does not count.
    let (_, cold) = pilot_picture(loaded, plan, pilot.counts(plan, 1), 0, 1, progress)?;
    let (mut each, mut taken, mut pace) = (1, 2, cold / 2.0);
    for index in 1.. {
        // The largest so far says most: what is learned once weighs least in it.
        let spent = start.elapsed().as_secs_f64() - before;
        if spent + 8.0 * pace * f64::from(each) > PILOT_SHARE * seconds {
            break;
        }
        let (_, time) = pilot_picture(
            loaded,
            plan,
            pilot.counts(plan, each),
            index,
            each,
            progress,
        )?;
        pace = time / f64::from(2 * each);
        taken += 2 * each;
        each *= 4;
    }
    let left = seconds - start.elapsed().as_secs_f64();
    Ok((left / pace.max(1e-9), taken))
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_sampling::hash::mix64;

    /// Pilots of noise that is known: the number of samples suffices in 95 % of them or more.
    #[test]
    fn the_bound_holds_at_its_rate() {
        let mut state = 1_u64;
        let mut uniform = || {
            state = mix64(state.wrapping_add(0x9e37_79b9_7f4a_7c15));
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        // Three hundred pixels' worth of squares of nearly normal numbers (sums of twelve), V = 3.
        let mut noise = || {
            let mut square = || {
                let sum: f64 = (0..12).map(|_| uniform()).sum();
                (sum - 6.0).powi(2)
            };
            Noise {
                variance: 3.0 / 8.0 * (0..300).map(|_| square()).sum::<f64>() / 300.0,
                mean: vec![1.0, 0.0, 0.0],
            }
        };
        let pilots = 2000;
        let enough = (0..pilots)
            .filter(|_| {
                let found: Vec<Noise> = (0..GROUPS).map(|_| noise()).collect();
                samples_for(&found, 8.0, 0.01).is_ok_and(|n| n >= 3.0 / 1e-4)
            })
            .count();
        // Binomial: 95 % of 2000 has the standard deviation 9.7; within 3.3 of them, α = 10⁻³. The mutant
        // takes the mean for the bound and suffices in half of the pilots.
        assert!((1868..=1932).contains(&enough), "{enough}");
    }

    #[test]
    fn black_pictures_have_no_relative_error() {
        let black = Noise {
            variance: 0.0,
            mean: vec![0.0; 3],
        };
        assert_eq!(black.relative(), None);
        assert!(samples_for(&vec![black; 8], 4.0, 0.01).is_err());
        let grey = Noise {
            variance: 0.02,
            mean: vec![1.0, 1.0, 0.0],
        };
        assert_eq!(grey.relative(), Some(0.1));
    }
}
