//! How many samples each pixel gets in a replicate, where they are not dealt evenly.
//!
//! The counts are fixed before the first sample of the image is drawn, from something that is no
//! part of it. Every pixel's mean is over its own samples; so each replicate remains an unbiased
//! estimate of the whole image, and the spread of replicates its standard error.

use serde::{Deserialize, Serialize};

/// The name of the channel that says how many samples each pixel has, all replicates together.
pub const SAMPLES: &str = "samples";

/// A number of samples for each pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SampleCounts {
    /// By row and column of the crop.
    of_pixel: Vec<u32>,
    pilot: u32,
}

impl SampleCounts {
    /// These counts, by row and column of the crop, found by a pilot of so many samples per
    /// pixel; `None` if a pixel gets none.
    pub fn new(of_pixel: Vec<u32>, pilot: u32) -> Option<Self> {
        let sound = !of_pixel.is_empty() && of_pixel.iter().all(|&count| count > 0);
        sound.then_some(Self { of_pixel, pilot })
    }

    /// The counts, by row and column of the crop.
    pub fn of_pixels(&self) -> &[u32] {
        &self.of_pixel
    }

    /// Samples per pixel of the pilot that found them.
    pub fn pilot(&self) -> u32 {
        self.pilot
    }

    /// Samples of one replicate, all pixels together.
    pub fn total(&self) -> u64 {
        self.of_pixel.iter().map(|&count| u64::from(count)).sum()
    }

    /// The mean over pixels, rounded; 1 at least.
    pub(crate) fn rounded_mean(&self) -> u32 {
        let pixels = self.of_pixel.len() as u64;
        ((self.total() + pixels / 2) / pixels).max(1) as u32
    }

    /// Their metadata.
    pub fn facts(&self) -> DealtFacts {
        let mut hasher = blake3::Hasher::new();
        for count in &self.of_pixel {
            hasher.update(&count.to_le_bytes());
        }
        DealtFacts {
            pilot: self.pilot,
            least: self.of_pixel.iter().copied().min().unwrap_or(0),
            most: self.of_pixel.iter().copied().max().unwrap_or(0),
            mean: self.total() as f64 / self.of_pixel.len() as f64,
            hash: hasher.finalize().to_hex()[..16].to_owned(),
        }
    }
}

/// Metadata of an uneven distribution of samples.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DealtFacts {
    /// Samples per pixel of the pilot that decided.
    pub pilot: u32,
    /// The fewest samples of a pixel in a replicate.
    pub least: u32,
    /// The most.
    pub most: u32,
    /// The mean over pixels.
    pub mean: f64,
    /// A hash over all of them.
    pub hash: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_has_samples() {
        assert_eq!(SampleCounts::new(vec![1, 0, 2], 16), None);
        assert_eq!(SampleCounts::new(Vec::new(), 16), None);
        let counts = SampleCounts::new(vec![1, 4, 1, 2], 16).expect("sound");
        let facts = counts.facts();
        assert_eq!((facts.least, facts.most, facts.mean), (1, 4, 2.0));
        let others = SampleCounts::new(vec![4, 1, 1, 2], 16).expect("sound");
        assert_ne!(others.facts().hash, facts.hash);
    }
}
