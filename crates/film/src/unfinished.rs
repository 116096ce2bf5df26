//! An interrupted replicate: its data in a checkpoint, and its picture if no replicate is finished.
//!
//! The picture divides every pixel by its own number of samples. Where pixels share samples, it divides by the sum of
//! their weights with `weighted_mean`, and by the expectation of that sum, for the numbers of samples around the
//! pixel, with `splatting`. Splats come from the samples of all pixels and are divided by the mean number. There is no
//! standard error, as there is only one replicate.
//!
//! In a file a channel `NAME` takes four planes of 32-bit words `exact.NAME.unfinished.0` to `.3`,
//! the sum over a pixel's samples, and as many of its splats, `exact.NAME.splats.0` to `.3`, both
//! in two's complement and units of 2⁻⁶⁴, least significant word first. `exact.unfinished` is the
//! number of samples, `exact.unfinished.weight.0` to `.3` what they count where pixels share them, and `exact.unfinished.standing.0` to `.2` what stands out among them (two
//! floats' bits, and the number of a sample).

use crate::exact_sums::EXACT;
use crate::faults::FaultLog;
use crate::footprint::Footprint;
use crate::outliers::DominantSample;
use crate::sample_counts::SAMPLES;
use etalon_images::Image;
use etalon_images::exr::IntegerPlane;
use etalon_statistics::Fixed128;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// The plane with the numbers of samples.
const COUNTS: &str = "exact.unfinished";

/// Metadata of an unfinished replicate in a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct UnfinishedFacts {
    /// Samples per pixel that the replicate was to have.
    pub samples_per_replicate: u32,
    /// The fewest samples of a pixel.
    pub least: u32,
    /// The most.
    pub most: u32,
    /// The mean over pixels.
    pub mean: f64,
    /// Pixels that no sample counts for, which are black.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub without: u64,
    /// Whether samples splat.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub splats: bool,
    /// Whether pixels share samples.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub shared: bool,
    /// Numbers that were refused in it.
    #[serde(default, skip_serializing_if = "FaultLog::is_empty")]
    pub faults: FaultLog,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as `serde` calls it")]
fn is_zero(count: &u64) -> bool {
    *count == 0
}

/// The sums of a replicate that was interrupted.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Unfinished {
    /// Sums over the samples of each pixel, by row, column and channel.
    pub(crate) own: Vec<Fixed128>,
    /// Sums of splats, by row, column and colour; empty if there are none.
    pub(crate) splats: Vec<Fixed128>,
    /// Sums of the weights of each pixel, by row and column; empty if pixels do not share samples.
    pub(crate) weights: Vec<Fixed128>,
    /// Samples of each pixel, and what stands out among them.
    pub(crate) samples: Vec<u32>,
    pub(crate) standing: Vec<DominantSample>,
    /// Refused values.
    pub(crate) faults: FaultLog,
}

impl Unfinished {
    /// Its metadata.
    pub(crate) fn facts(&self, samples_per_replicate: u32) -> UnfinishedFacts {
        UnfinishedFacts {
            samples_per_replicate,
            least: self.samples.iter().copied().min().unwrap_or(0),
            most: self.samples.iter().copied().max().unwrap_or(0),
            mean: self.mean_samples(),
            without: match self.weights.is_empty() {
                true => self.samples.iter().filter(|n| **n == 0).count() as u64,
                false => self
                    .weights
                    .iter()
                    .filter(|w| **w == Fixed128::ZERO)
                    .count() as u64,
            },
            shared: !self.weights.is_empty(),
            splats: !self.splats.is_empty(),
            faults: self.faults.clone(),
        }
    }

    fn total(&self) -> u64 {
        self.samples.iter().map(|&count| u64::from(count)).sum()
    }

    fn mean_samples(&self) -> f64 {
        self.total() as f64 / self.samples.len() as f64
    }

    /// Colours that have splats.
    fn colours(&self) -> usize {
        self.splats.len() / self.samples.len()
    }

    /// The means of these channels, and the samples of each pixel.
    pub(crate) fn image(&self, channels: &[String], [width, height]: [usize; 2]) -> Image {
        let mut image = Image::new(width, height);
        let (colours, mean) = (self.colours(), self.mean_samples());
        for (channel, name) in channels.iter().enumerate() {
            let value = |(pixel, &samples): (usize, &u32)| {
                let sum = self.own[pixel * channels.len() + channel];
                let own = match (self.weights.get(pixel), samples) {
                    (Some(&Fixed128::ZERO), _) | (None, 0) => 0.0,
                    (Some(weight), _) => sum.to_f64() / weight.to_f64(),
                    (None, samples) => sum.mean(samples.into()),
                };
                let splats = match channel < colours {
                    true => self.splats[pixel * colours + channel].to_f64() / mean,
                    false => 0.0,
                };
                (own + splats) as f32
            };
            let means = self.samples.iter().enumerate().map(value);
            image.push(name.as_str(), means.collect());
        }
        let samples = self.samples.iter().map(|&count| count as f32);
        image.push(SAMPLES, samples.collect());
        image
    }

    /// The planes of a file.
    pub(crate) fn planes(&self, names: &[String]) -> Vec<IntegerPlane> {
        let mut planes = Vec::new();
        let colours = self.colours();
        let words = |name: &str, kind, channel, sums: &[Fixed128], step| {
            [0, 1, 2, 3].map(|word| IntegerPlane {
                name: plane_name(name, kind, word),
                samples: (sums.iter().skip(channel).step_by(step))
                    .map(|sum| (sum.to_bits() >> (32 * word)) as u32)
                    .collect(),
            })
        };
        if !self.weights.is_empty() {
            planes.extend(words("", Kind::Weights, 0, &self.weights, 1));
        }
        for (channel, name) in names.iter().enumerate() {
            let mut push = |kind, sums: &[Fixed128], step| {
                planes.extend(words(name, kind, channel, sums, step));
            };
            push(Kind::Own, &self.own, names.len());
            if channel < colours {
                push(Kind::Splats, &self.splats, colours);
            }
        }
        planes.push(IntegerPlane {
            name: COUNTS.to_owned(),
            samples: self.samples.clone(),
        });
        planes.extend((0..3).map(|word| IntegerPlane {
            name: standing_name(word),
            samples: self.standing.iter().map(|s| s.words()[word]).collect(),
        }));
        planes
    }

    /// Reads it from the planes of a file of so many pixels.
    ///
    /// # Errors
    /// Says what is missing.
    pub(crate) fn from_planes(
        planes: &[IntegerPlane],
        facts: &UnfinishedFacts,
        names: &[String],
        colours: usize,
        pixels: usize,
    ) -> Result<Self, String> {
        let by_name: HashMap<&str, &[u32]> = planes
            .iter()
            .map(|plane| (plane.name.as_str(), plane.samples.as_slice()))
            .collect();
        let plane = |name: &str| match by_name.get(name) {
            Some(samples) if samples.len() == pixels => Ok(*samples),
            _ => Err(format!(
                "it has no plane `{name}` of an unfinished replicate"
            )),
        };
        let sums = |kind: Kind, names: &[String]| {
            let mut sums = vec![Fixed128::ZERO; pixels * names.len()];
            for (channel, name) in names.iter().enumerate() {
                let mut words = [&[][..]; 4];
                for (word, samples) in words.iter_mut().enumerate() {
                    *samples = plane(&plane_name(name, kind, word))?;
                }
                for pixel in 0..pixels {
                    let bits = words.iter().rev();
                    let bits = bits.fold(0, |bits, word| bits << 32 | u128::from(word[pixel]));
                    let sum = Fixed128::from_bits(bits.cast_signed());
                    sums[pixel * names.len() + channel] = sum;
                }
            }
            Ok::<_, String>(sums)
        };
        let standing = [0, 1, 2].map(|word| plane(&standing_name(word)));
        let [total, most, sample] = standing;
        let (total, most, sample) = (total?, most?, sample?);
        let unfinished = Self {
            own: sums(Kind::Own, names)?,
            splats: match facts.splats {
                true => sums(Kind::Splats, &names[..colours.min(names.len())])?,
                false => Vec::new(),
            },
            weights: match facts.shared {
                true => sums(Kind::Weights, &[String::new()])?,
                false => Vec::new(),
            },
            samples: plane(COUNTS)?.to_vec(),
            standing: (0..pixels)
                .map(|pixel| DominantSample::from_words([total[pixel], most[pixel], sample[pixel]]))
                .collect(),
            faults: facts.faults.clone(),
        };
        match unfinished.facts(facts.samples_per_replicate) == *facts {
            true => Ok(unfinished),
            false => Err("its unfinished replicate is not the one that it speaks of".to_owned()),
        }
    }

    /// Feeds all numbers to a checksum.
    pub(crate) fn hash_into(&self, hasher: &mut blake3::Hasher) {
        let sums = self.own.iter().chain(&self.splats);
        for sum in sums.chain(&self.weights) {
            hasher.update(&sum.to_bits().to_le_bytes());
        }
        let standing = self.standing.iter().flat_map(DominantSample::words);
        for word in self.samples.iter().copied().chain(standing) {
            hasher.update(&word.to_le_bytes());
        }
    }
}

/// The kind of sums that a plane holds.
#[derive(Clone, Copy)]
enum Kind {
    Own,
    Splats,
    /// Not of a channel.
    Weights,
}

fn plane_name(channel: &str, kind: Kind, word: usize) -> String {
    match kind {
        Kind::Own => format!("{EXACT}{channel}.unfinished.{word}"),
        Kind::Splats => format!("{EXACT}{channel}.splats.{word}"),
        Kind::Weights => format!("{COUNTS}.weight.{word}"),
    }
}

fn standing_name(word: usize) -> String {
    format!("{COUNTS}.standing.{word}")
}

/// What samples count for each pixel in expectation, by row and column, if those of the pixels count this much in all
/// and those around the film as much as those of the pixel next to them.
pub(crate) fn reached(
    footprint: &Footprint,
    mut counts: Vec<f64>,
    [width, height]: [usize; 2],
) -> Vec<f64> {
    let shares = footprint.shares();
    for (length, step, lines) in [(width, 1, height), (height, width, width)] {
        for line in 0..lines {
            let first = line * (if step == 1 { width } else { 1 });
            let own: Vec<f64> = (0..length).map(|i| counts[first + i * step]).collect();
            for i in 0..length {
                let both = shares.iter().enumerate().skip(1).map(|(away, share)| {
                    share * (own[i.saturating_sub(away)] + own[(i + away).min(length - 1)])
                });
                counts[first + i * step] = shares[0] * own[i] + both.sum::<f64>();
            }
        }
    }
    counts
}
