//! The picture so far, for previews.
//!
//! The running replicate is weighted by its finished fraction. With R finished replicates of mean m and the fraction f of
//! another one, whose samples so far have the mean x, a pixel is shown as
//!
//! ```text
//! (R m + f x) / (R + f)
//! ```
//!
//! These means are for display only: files, verdicts and the standard errors here use finished replicates.

use crate::ExactFilm;
use crate::rendered_image::image_of;
use etalon_images::Image;

/// A picture that is not finished.
#[derive(Clone, Debug)]
pub struct Glance {
    /// Its channels, with `standard_error.*` of the finished replicates if there are two or more.
    pub image: Image,
    /// Samples per pixel so far, the mean over pixels.
    pub samples: f64,
    /// Finished replicates.
    pub replicates: u32,
}

impl ExactFilm {
    /// The picture so far, of replicates of `samples` samples per pixel each; `None` before the first sample. In the first round of
    /// the first replicate, a pixel that has no sample shows the one left of it or above.
    pub fn glance(&mut self, samples: u32) -> Option<Glance> {
        let running = self.running_means();
        let replicates = self.replicates();
        let size = self.settings().crop_size.to_array().map(|n| n as usize);
        let seen = self.samples() as f64;
        if running.is_none() && replicates == 0 {
            return None;
        }
        let finished = (replicates > 0)
            .then(|| image_of(self.channels(), self.moments(), replicates, size, None));
        let Some((means, counts)) = running else {
            return finished.map(|image| Glance {
                image,
                samples: seen,
                replicates,
            });
        };
        let total: u64 = counts.iter().map(|&count| u64::from(count)).sum();
        let mean = total as f64 / counts.len() as f64;
        let image = match finished {
            None => spread(self.channels(), &means, &counts, size),
            Some(finished) => {
                let fraction = (mean / f64::from(samples.max(1))) as f32;
                joined(finished, &means, fraction / (replicates as f32 + fraction))
            }
        };
        Some(Glance {
            image,
            samples: seen + mean,
            replicates,
        })
    }
}

/// The finished picture with this weight of the running one, whose channels come first and in the same order. Standard errors are
/// of the finished replicates alone.
fn joined(finished: Image, running: &[Vec<f32>], weight: f32) -> Image {
    let mut image = Image::new(finished.width(), finished.height());
    for (index, mut channel) in finished.into_channels().into_iter().enumerate() {
        for (mean, x) in channel
            .samples
            .iter_mut()
            .zip(running.get(index).into_iter().flatten())
        {
            *mean += weight * (x - *mean);
        }
        image.push(channel.name, channel.samples);
    }
    image
}

/// A picture some of whose pixels may have no sample yet.
fn spread(
    names: &[String],
    means: &[Vec<f32>],
    counts: &[u32],
    [width, height]: [usize; 2],
) -> Image {
    // Where the value of each pixel is taken from.
    let mut source: Vec<usize> = (0..counts.len()).collect();
    for y in 0..height {
        let row = y * width;
        let is_empty = counts[row..row + width].iter().all(|&n| n == 0);
        for pixel in row..row + width {
            if counts[pixel] > 0 {
                continue;
            }
            if is_empty && y > 0 {
                source[pixel] = source[pixel - width];
            } else if pixel > row {
                source[pixel] = source[pixel - 1];
            }
        }
    }
    let mut image = Image::new(width, height);
    for (name, plane) in names.iter().zip(means) {
        image.push(
            name.as_str(),
            source.iter().map(|&pixel| plane[pixel]).collect(),
        );
    }
    image
}
