//! The exact sums of a picture as whole numbers in a file.
//!
//! A channel `NAME` takes twelve planes of 32-bit words, least significant first: four of the
//! sum of its replicates' means (in two's complement, units of 2⁻⁶⁴), `exact.NAME.sum.0` to
//! `exact.NAME.sum.3`, and eight of the sum of their squares (units of 2⁻¹²⁸),
//! `exact.NAME.squares.0` to `exact.NAME.squares.7`.

use crate::pixel_moments::{PixelMoments, WORDS};
use etalon_images::exr::IntegerPlane;
use etalon_statistics::InvalidValue;
use std::collections::HashMap;

/// Prefix of the names of planes with exact sums.
pub const EXACT: &str = "exact.";

/// Exact sums over replicates, by row, column and channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ExactSums {
    channels: usize,
    moments: Vec<PixelMoments>,
}

impl ExactSums {
    pub(crate) fn new(channels: usize, moments: Vec<PixelMoments>) -> Self {
        Self { channels, moments }
    }

    pub(crate) fn moments(&self) -> &[PixelMoments] {
        &self.moments
    }

    pub(crate) fn into_moments(self) -> Vec<PixelMoments> {
        self.moments
    }

    /// Adds those of other replicates of the same pixels and channels.
    ///
    /// # Errors
    /// If a sum is out of range, which at most 2¹⁵ replicates never are; some are added then.
    pub(crate) fn merge(&mut self, other: &Self) -> Result<(), InvalidValue> {
        let pairs = self.moments.iter_mut().zip(&other.moments);
        for (sums, others) in pairs {
            sums.merge(others)?;
        }
        Ok(())
    }

    /// The planes of a file.
    pub(crate) fn planes(&self, names: &[String]) -> Vec<IntegerPlane> {
        let mut planes = Vec::with_capacity(names.len() * WORDS);
        for (channel, name) in names.iter().enumerate() {
            for word in 0..WORDS {
                let of_channel = self.moments.iter().skip(channel).step_by(self.channels);
                planes.push(IntegerPlane {
                    name: plane_name(name, word),
                    samples: of_channel.map(|moments| moments.words()[word]).collect(),
                });
            }
        }
        planes
    }

    /// The sums of `count` replicates, from the planes of a file of so many pixels.
    ///
    /// # Errors
    /// Says what is missing, or which channel has sums that no replicates can have.
    pub(crate) fn from_planes(
        planes: Vec<IntegerPlane>,
        names: &[String],
        pixels: usize,
        count: u32,
    ) -> Result<Self, String> {
        if names.is_empty() {
            return Err("it has no channels".to_owned());
        }
        let mut by_name: HashMap<String, Vec<u32>> = planes
            .into_iter()
            .map(|plane| (plane.name, plane.samples))
            .collect();
        let mut words = Vec::new();
        for name in names {
            for word in 0..WORDS {
                let name = plane_name(name, word);
                match by_name.remove(&name) {
                    Some(samples) if samples.len() == pixels => words.push(samples),
                    _ => return Err(format!("it has no exact sums `{name}`")),
                }
            }
        }
        let channels = names.len();
        let mut moments = Vec::with_capacity(pixels * channels);
        for pixel in 0..pixels {
            for (planes, name) in words.chunks_exact(WORDS).zip(names) {
                let mut of_pixel = [0; WORDS];
                for (word, plane) in of_pixel.iter_mut().zip(planes) {
                    *word = plane[pixel];
                }
                let sums = PixelMoments::from_words(of_pixel, count);
                moments.push(sums.ok_or_else(|| {
                    format!(
                        "no {count} replicates have the exact sums of `{name}` in pixel {pixel}"
                    )
                })?);
            }
        }
        Ok(Self { channels, moments })
    }

    /// Feeds all words, by row, column and channel, to a checksum.
    pub(crate) fn hash_into(&self, hasher: &mut blake3::Hasher) {
        for moments in &self.moments {
            let mut bytes = [0; 4 * WORDS];
            for (into, word) in bytes.chunks_exact_mut(4).zip(moments.words()) {
                into.copy_from_slice(&word.to_le_bytes());
            }
            hasher.update(&bytes);
        }
    }
}

fn plane_name(channel: &str, word: usize) -> String {
    match word {
        0..4 => format!("{EXACT}{channel}.sum.{word}"),
        _ => format!("{EXACT}{channel}.squares.{}", word - 4),
    }
}
