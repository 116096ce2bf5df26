//! A picture that is known without error.

use std::ops::Range;

/// The expected value of each pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct ExactImage {
    /// Width and height (pixels).
    pub size: [u32; 2],
    /// Channels with their pixels, row after row.
    pub channels: Vec<(String, Vec<f64>)>,
}

impl ExactImage {
    /// The pixels of a channel, row after row.
    ///
    /// # Errors
    /// If it has no such channel.
    pub fn channel(&self, name: &str) -> Result<&[f64], String> {
        let found = self.channels.iter().find(|(channel, _)| channel == name);
        let found = found.map(|(_, pixels)| &pixels[..]);
        found.ok_or_else(|| format!("nothing is known of channel `{name}`"))
    }

    /// The mean of a channel over one tile of `side` pixels, or over the whole image.
    ///
    /// # Errors
    /// If it has no such channel.
    pub fn tile_mean(&self, channel: &str, side: Option<u32>, tile: usize) -> Result<f64, String> {
        let pixels = self.channel(channel)?;
        let (side, [width, height]) = self.tiling(side);
        let columns = width.div_ceil(side);
        let (left, top) = (tile % columns * side, tile / columns * side);
        let across = left..(left + side).min(width);
        Ok(self.mean(pixels, across, top..(top + side).min(height)))
    }

    /// The means over tiles of `side` pixels, or over the whole image, row after row.
    pub(crate) fn tile_means(&self, pixels: &[f64], side: Option<u32>) -> Vec<f64> {
        let (side, [width, height]) = self.tiling(side);
        let mut means = Vec::new();
        for top in (0..height).step_by(side) {
            for left in (0..width).step_by(side) {
                let across = left..(left + side).min(width);
                means.push(self.mean(pixels, across, top..(top + side).min(height)));
            }
        }
        means
    }

    /// The side of a tile, that of the whole image if there is none, and the image's size.
    fn tiling(&self, side: Option<u32>) -> (usize, [usize; 2]) {
        let [width, height] = self.size.map(|n| n as usize);
        let whole = width.max(height);
        (side.map_or(whole, |side| side as usize), [width, height])
    }

    fn mean(&self, pixels: &[f64], across: Range<usize>, down: Range<usize>) -> f64 {
        let width = self.size[0] as usize;
        let count = across.len() * down.len();
        let rows = down.map(|y| &pixels[y * width + across.start..y * width + across.end]);
        let sum: f64 = rows.map(|row| row.iter().sum::<f64>()).sum();
        sum / count as f64
    }
}
