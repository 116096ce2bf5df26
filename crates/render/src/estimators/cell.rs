//! Independent pictures of one size by one estimator, each measured when it is finished.
//!
//! Of every picture its time, its errors and its mean are kept. Two successive pictures, being
//! independent, tell bias from variance: the mean of (a − r)(b − r) is the bias squared, that of
//! ½ (a − b)² the variance, both without a bias of their own ([`Reference::product`],
//! [`Reference::half_difference`]); pairs do not overlap, so these numbers are independent, too.

use super::estimator_config::EstimatorConfig;
use super::reference::{Reference, interleaved};
use super::schedule::Size;
use crate::pipeline::render_into;
use etalon_film::{ExactFilm, RenderFacts};
use etalon_integrators::{Progress, RenderPlan};
use etalon_sampling::ReplicateKind;
use etalon_statistics::Picture;
use etalon_statistics::metrics::{EPSILON, mse, rel_mse};
use std::time::Instant;

/// A picture as it was rendered.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// Red, green and blue, interleaved, row after row.
    pub pixels: Vec<f32>,
    /// Wall-clock time of rendering.
    pub seconds: f64,
    /// Contributions that were not finite, and refused.
    pub faults: u64,
}

/// Renders one picture on the current thread pool.
///
/// # Errors
/// One sentence, if there is no memory for it.
pub fn render(
    entrant: &EstimatorConfig,
    samples: u32,
    seed: u64,
    progress: &dyn Progress,
) -> Result<Rendered, String> {
    let channels = entrant.integrator.channels();
    let film = ExactFilm::new(entrant.film.clone(), &channels).map_err(|error| error.message)?;
    let plan = RenderPlan {
        seed,
        replicates: 1,
        replicate_kind: ReplicateKind::Independent,
        share: None,
        samples_per_replicate: samples,
        sampler: entrant.sampler,
    };
    let start = Instant::now();
    let estimator = (&entrant.integrator, &entrant.compiled.scene);
    let film = render_into(film, estimator, &plan, progress);
    let seconds = start.elapsed().as_secs_f64();
    let faults = film.faults().total();
    let developed = film.develop(RenderFacts::default());
    let pixels = interleaved(&developed.image, "");
    Ok(Rendered {
        pixels: pixels.ok_or("the film has no channels R, G and B")?,
        seconds,
        faults,
    })
}

/// What is known of one picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Wall-clock time of rendering.
    pub seconds: f64,
    /// relMSE, without the reference's noise.
    pub error: f64,
    /// The mean squared error, without the reference's noise.
    pub squared: f64,
    /// The means of the three channels.
    pub mean: [f64; 3],
}

/// What is known of two successive pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// An unbiased estimate of the squared relative bias; it may be negative.
    pub bias_squared: f64,
    /// An unbiased estimate of the relative variance.
    pub variance: f64,
}

/// Pictures of one size by one estimator.
#[derive(Clone, Debug)]
pub struct Cell {
    /// How many there will be, and their size.
    pub size: Size,
    /// What was found of each so far.
    pub measured: Vec<Measured>,
    /// What was found of each two.
    pub pairs: Vec<Pair>,
    /// Contributions that were not finite.
    pub faults: u64,
    /// The first picture, for the eye.
    pub first: Option<Vec<f32>>,
    /// A picture that waits for its partner.
    waiting: Option<Vec<f32>>,
}

impl Cell {
    /// No picture yet.
    pub fn new(size: Size) -> Self {
        Self {
            size,
            measured: Vec::new(),
            pairs: Vec::new(),
            faults: 0,
            first: None,
            waiting: None,
        }
    }

    /// Measures a picture; `keep` keeps the first one.
    ///
    /// # Errors
    /// One sentence, if a pixel is not finite.
    pub fn add(
        &mut self,
        rendered: Rendered,
        reference: &Reference,
        keep: bool,
    ) -> Result<(), String> {
        let [width, height] = reference.size();
        let truth = reference.picture();
        let pixels = rendered.pixels;
        let picture = Picture::new(&pixels, width, height).map_err(|error| error.to_string())?;
        let error = rel_mse(&picture, &truth, EPSILON).map_err(|error| error.to_string())?;
        let squared = mse(&picture, &truth).map_err(|error| error.to_string())?;
        let count = (width * height) as f64;
        let mut mean = [0.0; 3];
        for pixel in picture.pixels() {
            for (mean, value) in mean.iter_mut().zip(pixel) {
                *mean += value / count;
            }
        }
        self.measured.push(Measured {
            seconds: rendered.seconds,
            error: error - reference.noise.unwrap_or(0.0),
            squared: squared - reference.squared_noise.unwrap_or(0.0),
            mean,
        });
        self.faults += rendered.faults;
        if keep && self.first.is_none() {
            self.first = Some(pixels.clone());
        }
        match self.waiting.take() {
            Some(other) => self.pairs.push(Pair {
                bias_squared: reference.product(&pixels, &other),
                variance: reference.half_difference(&pixels, &other),
            }),
            None => self.waiting = Some(pixels),
        }
        Ok(())
    }

    /// One number of every picture.
    pub fn of(&self, number: impl Fn(&Measured) -> f64) -> Vec<f64> {
        self.measured.iter().map(number).collect()
    }
}
