//! `--adaptive`: more samples where the noise is.
//!
//! Of all ways to deal N samples per pixel, the one with the least error
//!
//! ```text
//! E = ⟨ v(x) / n(x) ⟩        ⟨n(x)⟩ = N
//! ```
//!
//! gives pixel x a number n in proportion to √v, the spread of one of its samples (Neyman 1934).
//! Two errors are spoken of in this program: that of the whole picture, which `--error` aims at,
//! where bright pixels decide, and the mean of the pixels' relative errors (the last line of a
//! render), where dark ones do too:
//!
//! ```text
//! v = s² / ⟨s²⟩ + r² / ⟨r²⟩        s² = Σ_c s_c²        r² = Σ_c s_c² / (m_c² + 0.01)
//! ```
//!
//! with m and s the mean and its standard error in colour c, so that both weigh as much. A pilot of
//! [`GROUPS`] independent pictures of two replicates each estimates them. Blocks of 4² pixels get
//! the same number, from the mean of v over the block and its neighbours (with the weights ¼, ½, ¼
//! along both axes): single pixels of a pilot are too noisy to be followed. A pilot may have missed
//! what is rare, so to v is added 1/64 of its mean over the picture, and no pixel gets more than 32
//! times its even share.
//!
//! The pilot has seeds of its own and is no part of the picture, and the numbers are frozen before
//! the first sample of the picture is drawn. Given them every replicate is an unbiased estimate of
//! every pixel, and replicates are independent: their mean is unbiased, and their spread is its
//! standard error, as if the numbers had been read from a file.

use crate::loaded::Loaded;
use crate::pilot::{Failure, GROUPS, pilot_picture};
use crate::sizes::nearest;
use etalon_film::{RenderedImage, SampleCounts};
use etalon_integrators::{Progress, RenderPlan};
use etalon_params::Diagnostic;
use etalon_sampling::SamplerKind;
use etalon_sampling::hash::mix64;

/// Side of the blocks whose pixels get equally many samples (pixels).
const SIDE: usize = 4;

/// What is added to the variance of a block, as a share of the picture's mean.
const FLOOR: f64 = 1.0 / 64.0;

/// The most samples of a pixel, in units of its even share.
const MOST: f64 = 32.0;

/// The first index of the pilot's pictures, apart from those of pilots that fix a number of
/// samples.
const FIRST: u32 = 1 << 16;

/// How to deal samples to the pixels of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution {
    /// Width and height of the crop (pixels).
    size: [usize; 2],
    /// Blocks in a row.
    columns: usize,
    /// What samples are dealt in proportion to, by row and column of blocks.
    weights: Vec<f64>,
    /// Samples per pixel that the pilot took.
    pilot: u32,
}

/// Why samples of this scene's integrator cannot be dealt to single pixels.
///
/// # Errors
/// If they cannot.
pub fn check(loaded: &Loaded) -> Result<(), Diagnostic> {
    let obstacle = if loaded.integrator.splats() {
        "its light paths may end in any pixel, so they cannot be dealt to one"
    } else if loaded.integrator.samples_per_pass().is_some() {
        "it passes over all pixels again and again, with one sample each"
    } else {
        return Ok(());
    };
    let message = format!(
        "`--adaptive` cannot be used with `{}`: {obstacle}",
        loaded.integrator_name
    );
    Err(Diagnostic::error_nowhere(message).help(
        "use an integrator whose samples each belong to one pixel, such as `path` or `guided`",
    ))
}

/// Renders a pilot of about `samples` samples per pixel and finds out where the noise is.
///
/// # Errors
/// If the film has no colours, or `progress` says to stop.
pub fn pilot(
    loaded: &Loaded,
    plan: &RenderPlan,
    samples: u32,
    progress: &dyn Progress,
) -> Result<Distribution, Failure> {
    let each = plan.sampler.round_up(samples.div_ceil(2 * GROUPS));
    let size = loaded.compiled.film.crop_size.to_array();
    let [width, height] = size.map(|n| n as usize);
    let mut noise = Noise::of_nothing(width * height);
    for index in FIRST..FIRST + GROUPS {
        let (developed, _) = pilot_picture(loaded, plan, None, index, each, progress)?;
        noise.add(&developed)?;
    }
    Ok(Distribution::of(
        &noise.errors(),
        [width, height],
        2 * GROUPS * each,
    ))
}

/// Sums over pictures of a pilot.
struct Noise {
    /// Means and squared standard errors of all pixels, for each of the colours.
    colours: Vec<(Vec<f64>, Vec<f64>)>,
    pixels: usize,
    pictures: f64,
}

impl Noise {
    fn of_nothing(pixels: usize) -> Self {
        Self {
            colours: Vec::new(),
            pixels,
            pictures: 0.0,
        }
    }

    /// Adds a picture.
    fn add(&mut self, developed: &RenderedImage) -> Result<(), Diagnostic> {
        let planes = developed.colours().into_iter().filter_map(|name| {
            Some((
                developed.image.channel(name)?,
                developed.standard_error(name)?,
            ))
        });
        let mut colour = 0;
        for (means, errors) in planes {
            if self.colours.len() == colour {
                self.colours
                    .push((vec![0.0; self.pixels], vec![0.0; self.pixels]));
            }
            let (sums, squares) = &mut self.colours[colour];
            for (sum, &mean) in sums.iter_mut().zip(means) {
                *sum += f64::from(mean);
            }
            for (sum, &error) in squares.iter_mut().zip(errors) {
                *sum += f64::from(error).powi(2);
            }
            colour += 1;
        }
        self.pictures += 1.0;
        match colour {
            0 => Err(Diagnostic::error_nowhere(
                "samples cannot be dealt by error: the film has no colours".to_owned(),
            )),
            _ => Ok(()),
        }
    }

    /// v of every pixel; not a number where nothing is known.
    fn errors(&self) -> Vec<f64> {
        let of = |pixel: usize| {
            let (mut whole, mut relative) = (0.0, 0.0);
            for (sums, squares) in &self.colours {
                let mean = sums[pixel] / self.pictures;
                whole += squares[pixel];
                relative += squares[pixel] / (mean * mean + 0.01);
            }
            [whole, relative]
        };
        let both: Vec<[f64; 2]> = (0..self.pixels).map(of).collect();
        let scale = |error: usize| {
            let known = both.iter().map(|v| v[error]).filter(|v| v.is_finite());
            let sum: f64 = known.sum();
            if sum > 0.0 {
                both.len() as f64 / sum
            } else {
                0.0
            }
        };
        let [whole, relative] = [scale(0), scale(1)];
        both.iter()
            .map(|v| v[0] * whole + v[1] * relative)
            .collect()
    }
}

impl Distribution {
    /// The distribution for these variances of pixels.
    fn of(variance: &[f64], [width, height]: [usize; 2], pilot: u32) -> Self {
        let (columns, rows) = (width.div_ceil(SIDE), height.div_ceil(SIDE));
        let mut blocks = vec![0.0; columns * rows];
        let mut pixels = vec![0.0; columns * rows];
        for (pixel, &variance) in variance.iter().enumerate() {
            let block = (pixel / width / SIDE) * columns + (pixel % width) / SIDE;
            // Refused numbers are no part of a picture, but a pixel of nothing else is not a
            // number.
            if variance.is_finite() {
                blocks[block] += variance;
                pixels[block] += 1.0;
            }
        }
        let mean = blocks.iter().sum::<f64>() / variance.len() as f64;
        let weight = |block: usize| {
            let (column, row) = (block % columns, block / columns);
            let (mut sum, mut count) = (0.0, 0.0);
            for y in row.saturating_sub(1)..(row + 2).min(rows) {
                for x in column.saturating_sub(1)..(column + 2).min(columns) {
                    let near = |a: usize, b: usize| if a == b { 2.0 } else { 1.0 };
                    let share = near(x, column) * near(y, row);
                    sum += share * blocks[y * columns + x];
                    count += share * pixels[y * columns + x];
                }
            }
            let local = if count > 0.0 { sum / count } else { mean };
            (local + FLOOR * mean).sqrt()
        };
        let mut weights: Vec<f64> = (0..columns * rows).map(weight).collect();
        // Without any noise all are equal.
        if mean == 0.0 {
            weights.fill(1.0);
        }
        Self {
            size: [width, height],
            columns,
            weights,
            pilot,
        }
    }

    /// Samples per pixel that the pilot took.
    pub fn pilot(&self) -> u32 {
        self.pilot
    }

    /// Deals `each` samples per pixel on average, or slightly fewer, in numbers that the sampler
    /// can stratify.
    pub fn counts(&self, sampler: SamplerKind, each: u32) -> SampleCounts {
        let [width, height] = self.size;
        let mut pixels = vec![0_u64; self.weights.len()];
        let block = |pixel: usize| (pixel / width / SIDE) * self.columns + (pixel % width) / SIDE;
        for pixel in 0..width * height {
            pixels[block(pixel)] += 1;
        }
        let even = f64::from(each);
        let sizes = |scale: f64| -> Vec<u32> {
            let weights = self.weights.iter().enumerate();
            weights
                .map(|(block, weight)| {
                    let wanted = (weight * scale).min(MOST * even);
                    nearest(sampler, wanted, dither(block as u64))
                })
                .collect()
        };
        let total = |sizes: &[u32]| -> u64 {
            let products = sizes.iter().zip(&pixels).map(|(&n, p)| u64::from(n) * p);
            products.sum()
        };
        let budget = u64::from(each) * (width * height) as u64;
        // The sizes grow with the scale. From one end, where all pixels have as many as they may,
        // to the other, where each has one.
        let largest = self.weights.iter().copied().fold(0.0, f64::max);
        let smallest = self.weights.iter().copied().fold(f64::MAX, f64::min);
        let (mut low, mut high) = (0.25 / largest, 2.0 * MOST * even / smallest);
        for _ in 0..64 {
            let middle = (low * high).sqrt();
            if total(&sizes(middle)) <= budget {
                low = middle;
            } else {
                high = middle;
            }
        }
        let sizes = sizes(low);
        let of_pixel = (0..width * height).map(|pixel| sizes[block(pixel)]);
        SampleCounts::new(of_pixel.collect(), self.pilot).expect("no size is zero")
    }
}

/// A number between -1/8 and 1/8 that differs from block to block.
fn dither(block: u64) -> f64 {
    let bits = mix64(block.wrapping_add(0x9e37_79b9_7f4a_7c15));
    ((bits >> 11) as f64 / (1_u64 << 53) as f64 - 0.5) / 4.0
}

#[cfg(test)]
mod tests {
    use super::*;

    const KINDS: [SamplerKind; 3] = [
        SamplerKind::Independent,
        SamplerKind::Sobol,
        SamplerKind::Stratified { jitter: true },
    ];

    /// A picture whose right half is 16 times as noisy.
    fn halves() -> Distribution {
        let (width, height) = (64, 37);
        let variance: Vec<f64> = (0..width * height)
            .map(|pixel| if pixel % width < 32 { 1.0 } else { 256.0 })
            .collect();
        Distribution::of(&variance, [width, height], 64)
    }

    #[test]
    fn samples_go_where_the_noise_is() {
        for kind in KINDS {
            for each in [1, 4, 64, 1024] {
                let counts = halves().counts(kind, kind.round_up(each));
                let each = f64::from(kind.round_up(each));
                let mean = counts.facts().mean;
                assert!(mean <= each, "{kind:?} {each}: {mean}");
                // The undistributed remainder is less than a block's step.
                assert!(mean > 0.9 * each || each < 5.0, "{kind:?} {each}: {mean}");
                let of = counts.of_pixels();
                assert!(of.iter().all(|&n| kind.round_up(n) == n));
                // Pixels away from the edge: 16 times the spread, less what is added to both.
                let (dark, bright) = (f64::from(of[4 * 64 + 8]), f64::from(of[4 * 64 + 56]));
                if each >= 64.0 {
                    let ratio = bright / dark;
                    assert!((4.0..=16.0).contains(&ratio), "{kind:?} {each}: {ratio}");
                }
            }
        }
    }

    /// The variance of the picture, relative to dealing evenly.
    fn variance(of_pixel: &[u32], variance: impl Fn(usize) -> f64, each: f64) -> f64 {
        let pixels = 0..of_pixel.len();
        let dealt: f64 = pixels
            .clone()
            .map(|p| variance(p) / f64::from(of_pixel[p]))
            .sum();
        let even: f64 = pixels.map(|p| variance(p) / each).sum();
        dealt / even
    }

    #[test]
    fn the_variance_falls_nearly_to_the_least() {
        let of = |pixel: usize| if pixel % 64 < 32 { 1.0 } else { 256.0 };
        // ⟨σ⟩² / ⟨σ²⟩ = (17/2)² / (257/2), the least there can be; the floor, the edge and rounding
        // take the rest. The mutant deals in proportion to the variance.
        let least = 8.5_f64.powi(2) / 128.5;
        for kind in KINDS {
            let counts = halves().counts(kind, 64);
            let reached = variance(counts.of_pixels(), of, 64.0);
            assert!(
                (least..1.2 * least).contains(&reached),
                "{kind:?}: {reached} of {least}"
            );
        }
    }

    #[test]
    fn without_noise_all_pixels_are_equal() {
        for kind in KINDS {
            for variance in [0.0, 3.0, f64::NAN] {
                let counts = Distribution::of(&[variance; 50 * 20], [50, 20], 16).counts(kind, 16);
                assert!(
                    counts.of_pixels().iter().all(|&n| (12..=16).contains(&n)),
                    "{kind:?}"
                );
            }
        }
    }

    #[test]
    fn no_pixel_gets_all() {
        let mut variance = vec![1e-9; 128 * 128];
        variance[5000] = 1e12;
        let counts = Distribution::of(&variance, [128, 128], 64).counts(SamplerKind::Sobol, 16);
        let facts = counts.facts();
        assert!(facts.most <= 16 * 64 && facts.least >= 8, "{facts:?}");
        assert!(facts.mean > 15.0, "{facts:?}");
    }
}
