//! Whether a picture's pixels agree with its statistics.
//!
//! ```text
//! mean over a tile of the pixels = mean over the replicates of the tile's means
//! ```
//!
//! for every channel and tile, up to rounding. Verdicts use tile means, so without this check a file whose
//! pixels were edited afterwards would be judged by its old picture.

use crate::{Metadata, TileMeans};
use etalon_images::Image;

/// How far the two may be apart, relative to the mean absolute value in the tile: both are rounded to
/// 24 bits.
const ROUNDING: f64 = 1e-5;

/// How far they may be apart besides: exact sums are multiples of 2⁻⁶⁴.
const QUANTUM: f64 = 1e-18;

/// The contradiction to the statistics, if any, as a sentence.
pub(crate) fn contradiction(image: &Image, metadata: &Metadata) -> Option<String> {
    metadata.tile_means.iter().find_map(|means| {
        let channels = metadata.channels.iter().enumerate();
        channels
            .take(means.channels() as usize)
            .find_map(|(c, name)| {
                let pixels = image.channel(name)?;
                in_channel(pixels, image.width(), means, c as u32)
                    .map(|what| format!("channel `{name}`{what}; was the picture changed?"))
            })
    })
}

fn in_channel(pixels: &[f32], width: usize, means: &TileMeans, channel: u32) -> Option<String> {
    if means.replicates() == 0 {
        return None;
    }
    let height = pixels.len() / width;
    let side = means.side().map_or(width.max(height), |side| side as usize);
    for row in 0..means.rows() {
        for column in 0..means.columns() {
            let [left, top] = [column, row].map(|n| n as usize * side);
            let (right, bottom) = ((left + side).min(width), (top + side).min(height));
            let lines = (top..bottom).map(|y| &pixels[y * width + left..y * width + right]);
            let shown = Mean::of(lines.flatten().copied());
            let told = (0..means.replicates()).map(|r| means.get(r, channel, column, row));
            let told = Mean::of(told);
            // Sums that were out of range leave no number behind. A tile's may be so where no pixel's is.
            if !told.value.is_finite() {
                continue;
            }
            let far =
                (shown.value - told.value).abs() > ROUNDING * (shown.size + told.size) + QUANTUM;
            if far || !shown.value.is_finite() {
                return Some(format!(
                    " is {} on the average from pixel ({left}, {top}) on, and was {} when the statistics were made",
                    shown.value, told.value
                ));
            }
        }
    }
    None
}

/// The mean of some numbers, and of their sizes.
struct Mean {
    value: f64,
    size: f64,
}

impl Mean {
    fn of(numbers: impl Iterator<Item = f32>) -> Self {
        let (mut value, mut size, mut count) = (0.0, 0.0, 0.0);
        for number in numbers {
            value += f64::from(number);
            size += f64::from(number).abs();
            count += 1.0;
        }
        Self {
            value: value / count,
            size: size / count,
        }
    }
}
