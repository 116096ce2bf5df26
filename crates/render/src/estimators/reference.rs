//! The picture that errors are measured against, and how converged it is.
//!
//! It is a file, or rendered with the first estimator and a seed of its own. A noisy reference adds
//! its own variance to every squared error: with t a picture, r̂ the reference and r the truth,
//!
//! E (t − r̂)² = E (t − r)² + var r̂,
//!
//! so where its standard errors s are known, their squares are taken off again: of relMSE the mean of
//! s² / (r̂² + ε). For MSE what remains is unbiased. In relMSE the weights 1/(r̂² + ε) are noisy, too, which
//! to second order makes all of it greater by a share of 3s²/r², and a bias b look like b² + 4bs²/r:
//! little where the reference is converged, and a remark says where it is not.

use super::estimator_config::EstimatorConfig;
use super::schedule::Size;
use crate::VERSION;
use crate::pipeline::{render_into, sampler_name};
use etalon_film::{ExactFilm, RenderFacts, RenderedImage, read_developed};
use etalon_images::Image;
use etalon_integrators::{Progress, RenderPlan};
use etalon_sampling::ReplicateKind;
use etalon_statistics::Picture;
use etalon_statistics::metrics::EPSILON;
use serde::Serialize;
use std::path::Path;

/// Where a reference comes from.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum ReferenceOrigin {
    /// A file.
    File {
        /// As it was named.
        path: String,
        /// The integrator that it names, if it is ours.
        integrator: Option<String>,
        /// Samples per pixel, if it is ours.
        samples_per_pixel: Option<u64>,
    },
    /// Rendered for this comparison.
    Rendered {
        /// The estimator.
        estimator: String,
        /// Its sampler.
        sampler: String,
        /// Samples per pixel of one replicate.
        samples_per_replicate: u32,
        /// Independent replicates.
        replicates: u32,
        /// Its seed, which no measured picture shares.
        seed: u64,
        /// The share of the time that it was given.
        share_of_time: f64,
    },
}

/// A reference.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Where it comes from.
    pub origin: ReferenceOrigin,
    /// Its own relMSE (the mean of s² / (r² + ε)), if it has standard errors.
    pub noise: Option<f64>,
    /// Its own mean squared error (the mean of s²).
    pub squared_noise: Option<f64>,
    /// Red, green and blue, interleaved, row after row.
    pixels: Vec<f32>,
    /// Width and height (pixels).
    size: [usize; 2],
    /// 1 / (r² + ε), for each of `pixels`.
    weights: Vec<f64>,
}

impl Reference {
    /// Reads a reference of `size` pixels.
    ///
    /// # Errors
    /// One sentence, if it cannot be read, is not of this size, or has no finite colours.
    pub fn read(path: &Path, size: [usize; 2]) -> Result<Self, String> {
        let developed = read_developed(path).map_err(|error| error.to_string())?;
        if let Some(method) = developed
            .metadata
            .as_ref()
            .and_then(|m| m.denoised.as_ref())
        {
            return Err(format!(
                "the reference {} was denoised ({method}): it is biased, and nothing can be held against it",
                path.display()
            ));
        }
        let image = &developed.image;
        let found = [image.width(), image.height()];
        if found != size {
            return Err(format!(
                "the reference {} has {} × {} pixels, the scene's film {} × {}",
                path.display(),
                found[0],
                found[1],
                size[0],
                size[1]
            ));
        }
        let metadata = developed.metadata.as_ref();
        let origin = ReferenceOrigin::File {
            path: path.display().to_string(),
            integrator: metadata.map(|m| m.integrator.clone()),
            samples_per_pixel: metadata.map(|m| m.spp),
        };
        Self::of(&developed, origin)
            .map_err(|reason| format!("the reference {}: {reason}", path.display()))
    }

    /// Renders a reference on the current thread pool.
    ///
    /// # Errors
    /// One sentence, if there is no memory for it or a pixel is not finite.
    pub fn render(
        entrant: &EstimatorConfig,
        size: Size,
        seed: u64,
        share_of_time: f64,
        progress: &dyn Progress,
    ) -> Result<Self, String> {
        let channels = entrant.integrator.channels();
        let film =
            ExactFilm::new(entrant.film.clone(), &channels).map_err(|error| error.message)?;
        let plan = RenderPlan {
            seed,
            replicates: size.replicates,
            replicate_kind: ReplicateKind::Independent,
            share: None,
            samples_per_replicate: size.samples,
            sampler: entrant.sampler,
        };
        let estimator = (&entrant.integrator, &entrant.compiled.scene);
        let film = render_into(film, estimator, &plan, progress);
        let developed = film.develop(RenderFacts {
            version: VERSION.to_owned(),
            ..RenderFacts::default()
        });
        let origin = ReferenceOrigin::Rendered {
            estimator: entrant.name.clone(),
            sampler: sampler_name(entrant.sampler).to_owned(),
            samples_per_replicate: size.samples,
            replicates: size.replicates,
            seed,
            share_of_time,
        };
        Self::of(&developed, origin).map_err(|reason| format!("the rendered reference: {reason}"))
    }

    fn of(developed: &RenderedImage, origin: ReferenceOrigin) -> Result<Self, String> {
        let image = &developed.image;
        let size = [image.width(), image.height()];
        let pixels = interleaved(image, "").ok_or("it has no channels R, G and B")?;
        Picture::new(&pixels, size[0], size[1]).map_err(|error| error.to_string())?;
        let weights: Vec<f64> = pixels
            .iter()
            .map(|&r| 1.0 / (f64::from(r) * f64::from(r) + EPSILON))
            .collect();
        let errors = interleaved(image, etalon_film::STANDARD_ERROR);
        let errors = errors.filter(|errors| errors.iter().all(|s| s.is_finite()));
        let mean = |weight: &dyn Fn(usize) -> f64| {
            let errors = errors.as_ref()?;
            let squares = errors.iter().enumerate();
            let sum: f64 = squares
                .map(|(i, &s)| weight(i) * f64::from(s) * f64::from(s))
                .sum();
            Some(sum / errors.len() as f64)
        };
        Ok(Self {
            noise: mean(&|i| weights[i]),
            squared_noise: mean(&|_| 1.0),
            origin,
            size,
            weights,
            pixels,
        })
    }

    /// The picture.
    pub fn picture(&self) -> Picture<'_> {
        let [width, height] = self.size;
        Picture::new(&self.pixels, width, height).expect("checked when it was made")
    }

    /// Width and height (pixels).
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// The mean over pixels and channels of (a − r)(b − r) / (r² + ε): for independent a and b an
    /// estimate of their squared relative bias, after the reference's own noise is taken off.
    pub fn product(&self, a: &[f32], b: &[f32]) -> f64 {
        let error = |t: f32, i: usize| f64::from(t) - f64::from(self.pixels[i]);
        let pairs = a.iter().zip(b).enumerate();
        let sum: f64 = pairs
            .map(|(i, (&a, &b))| self.weights[i] * error(a, i) * error(b, i))
            .sum();
        sum / self.weights.len() as f64 - self.noise.unwrap_or(0.0)
    }

    /// The mean over pixels and channels of ½ (a − b)² / (r² + ε): for independent and identically
    /// distributed a and b an estimate of their relative variance, independent of their bias.
    pub fn half_difference(&self, a: &[f32], b: &[f32]) -> f64 {
        let pairs = a.iter().zip(b).zip(&self.weights);
        let sum: f64 = pairs
            .map(|((&a, &b), weight)| {
                let difference = f64::from(a) - f64::from(b);
                0.5 * weight * difference * difference
            })
            .sum();
        sum / self.weights.len() as f64
    }
}

/// The channels `prefix`R, G and B, one pixel after the other.
pub fn interleaved(image: &Image, prefix: &str) -> Option<Vec<f32>> {
    let channel = |name: &str| image.channel(&format!("{prefix}{name}"));
    let (red, green, blue) = (channel("R")?, channel("G")?, channel("B")?);
    let pixels = red.iter().zip(green).zip(blue);
    Some(pixels.flat_map(|((r, g), b)| [*r, *g, *b]).collect())
}
