//! The picture so far, for whoever looks on while it is rendered.
//!
//! The running replicate counts by how far it is. With R finished replicates of mean m and the fraction f of another one, whose
//! samples so far have the mean x, a pixel is shown as
//!
//! ```text
//! (R m + f x) / (R + f)
//! ```
//!
//! These are means for eyes; files and verdicts are of finished replicates only, and so are the standard errors here.

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
        let unfinished = self.unfinished();
        let replicates = self.replicates();
        let size = self.settings().crop_size.to_array().map(|n| n as usize);
        let finished = || image_of(self.channels(), self.moments(), replicates, size, None);
        let seen = self.samples() as f64;
        let Some(unfinished) = unfinished else {
            return (replicates > 0).then(|| Glance {
                image: finished(),
                samples: seen,
                replicates,
            });
        };
        let running = unfinished.image(self.channels(), size);
        let mean = unfinished.facts(samples).mean;
        let image = if replicates == 0 {
            spread(&running, &unfinished.samples)
        } else {
            let fraction = (mean / f64::from(samples.max(1))) as f32;
            let weight = fraction / (replicates as f32 + fraction);
            joined(finished(), &running, weight)
        };
        Some(Glance {
            image,
            samples: seen + mean,
            replicates,
        })
    }
}

/// The finished picture with this weight of the running one.
fn joined(finished: Image, running: &Image, weight: f32) -> Image {
    let mut image = Image::new(finished.width(), finished.height());
    for mut channel in finished.into_channels() {
        // Standard errors are of the finished replicates alone.
        if let Some(more) = running.channel(&channel.name) {
            for (mean, x) in channel.samples.iter_mut().zip(more) {
                *mean += weight * (x - *mean);
            }
        }
        image.push(channel.name, channel.samples);
    }
    image
}

/// A picture some of whose pixels have no sample yet.
fn spread(running: &Image, samples: &[u32]) -> Image {
    let (width, height) = (running.width(), running.height());
    // Where the value of each pixel is taken from.
    let mut source: Vec<usize> = (0..samples.len()).collect();
    for y in 0..height {
        let row = y * width;
        let is_empty = samples[row..row + width].iter().all(|&n| n == 0);
        for pixel in row..row + width {
            if samples[pixel] > 0 {
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
    for channel in running.channels() {
        let from = |&pixel: &usize| channel.samples[pixel];
        image.push(channel.name.as_str(), source.iter().map(from).collect());
    }
    image
}
