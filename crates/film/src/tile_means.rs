//! Means over tiles, one per replicate: what tests of images are made of.
//!
//! Neighbouring pixels may be correlated (light tracing, photon maps, Metropolis chains), so the
//! error of a tile does not follow from the errors of its pixels. Its spread over independent
//! replicates does.
//!
//! Tiles are counted from the upper left pixel of the crop; those at the right and lower edges
//! may be smaller, and their means are over the pixels they have. Means are rounded once, from
//! the exact sum to single precision (relative error below 6·10⁻⁸, far below the noise of
//! anything that was sampled).

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use etalon_statistics::Fixed128;
use serde::{Deserialize, Serialize};

/// Tile means of all finished replicates for one size of tile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Stored", into = "Stored")]
pub struct TileMeans {
    side: Option<u32>,
    columns: u32,
    rows: u32,
    channels: u32,
    replicates: u32,
    /// By replicate, channel, row and column.
    values: Vec<f32>,
}

/// As written: the numbers are little-endian 32-bit floats in Base64.
#[derive(Clone, Serialize, Deserialize)]
struct Stored {
    /// Pixels on a side; absent for the whole image.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    side: Option<u32>,
    columns: u32,
    rows: u32,
    channels: u32,
    replicates: u32,
    means: String,
}

impl TileMeans {
    /// Of no replicates yet; `side` is `None` for one tile that is the whole image.
    pub(crate) fn new(side: Option<u32>, size: [u32; 2], channels: u32) -> Self {
        let [columns, rows] = size.map(|n| side.map_or(1, |side| n.div_ceil(side)));
        Self {
            side,
            columns,
            rows,
            channels,
            replicates: 0,
            values: Vec::new(),
        }
    }

    /// Pixels on a tile's side; `None` if the only tile is the whole image.
    pub fn side(&self) -> Option<u32> {
        self.side
    }

    /// Tiles in a row.
    pub fn columns(&self) -> u32 {
        self.columns
    }

    /// Rows of tiles.
    pub fn rows(&self) -> u32 {
        self.rows
    }

    /// Channels, in the order of the metadata's list.
    pub fn channels(&self) -> u32 {
        self.channels
    }

    /// Replicates.
    pub fn replicates(&self) -> u32 {
        self.replicates
    }

    /// The mean of one tile in one replicate; NaN if the tile's sum was out of range.
    ///
    /// # Panics
    /// If there is no such tile, channel or replicate.
    pub fn get(&self, replicate: u32, channel: u32, column: u32, row: u32) -> f32 {
        assert!(
            column < self.columns && row < self.rows,
            "no tile {column}, {row}"
        );
        self.plane(replicate, channel)[(row * self.columns + column) as usize]
    }

    /// The means of all tiles for one channel in one replicate, row after row.
    ///
    /// # Panics
    /// If there is no such channel or replicate.
    pub fn plane(&self, replicate: u32, channel: u32) -> &[f32] {
        assert!(channel < self.channels, "no channel {channel}");
        let tiles = self.columns as usize * self.rows as usize;
        let plane = replicate as usize * self.channels as usize + channel as usize;
        &self.values[plane * tiles..(plane + 1) * tiles]
    }

    /// Adds the replicates of another batch of the same estimator, after those there are.
    ///
    /// # Errors
    /// If they are of other tiles or channels; nothing is added then.
    pub fn append(&mut self, other: &Self) -> Result<(), String> {
        let shape = |means: &Self| (means.side, means.columns, means.rows, means.channels);
        if shape(self) != shape(other) {
            return Err("the tile means are of different tiles or channels".to_owned());
        }
        self.values.extend_from_slice(&other.values);
        self.replicates += other.replicates;
        Ok(())
    }

    /// Some of the replicates, in the order and as often as they are named: for resampling.
    ///
    /// # Panics
    /// If there is no such replicate.
    pub fn chosen(&self, replicates: &[u32]) -> Self {
        let size = (self.channels * self.columns * self.rows) as usize;
        let values = replicates
            .iter()
            .flat_map(|r| &self.values[*r as usize * size..(*r as usize + 1) * size]);
        Self {
            replicates: replicates.len() as u32,
            values: values.copied().collect(),
            ..*self
        }
    }

    /// Adds a replicate: the sums of its tiles, to be divided by `divisor` and the number of
    /// pixels; `None` where they were out of range.
    pub(crate) fn push(&mut self, sums: &TileSums, divisor: u64, size: [u32; 2]) {
        for channel in 0..self.channels {
            for row in 0..self.rows {
                for column in 0..self.columns {
                    let count = divisor * self.extent(column, size[0]) * self.extent(row, size[1]);
                    let sum = sums.get(column, row, channel);
                    self.values
                        .push(sum.map_or(f32::NAN, |sum| sum.mean(count) as f32));
                }
            }
        }
        self.replicates += 1;
    }

    /// Pixels of the tile with this index along an axis of `length` pixels.
    fn extent(&self, index: u32, length: u32) -> u64 {
        let side = self.side.unwrap_or(length);
        u64::from((length - index * side).min(side))
    }

    /// The image's size that would have these tiles, if any.
    pub(crate) fn fits(&self, size: [u32; 2]) -> bool {
        let tiles = size.map(|n| self.side.map_or(1, |side| n.div_ceil(side)));
        tiles == [self.columns, self.rows]
    }
}

/// Exact sums over the tiles of one replicate.
pub(crate) struct TileSums {
    pub(crate) columns: u32,
    pub(crate) channels: u32,
    /// By row, column and channel.
    pub(crate) sums: Vec<Option<Fixed128>>,
}

impl TileSums {
    fn get(&self, column: u32, row: u32, channel: u32) -> Option<Fixed128> {
        self.sums[((row * self.columns + column) * self.channels + channel) as usize]
    }

    /// The sums over tiles `factor` times as large.
    pub(crate) fn coarser(&self, factor: u32) -> Self {
        let rows = self.sums.len() as u32 / (self.columns * self.channels).max(1);
        let columns = self.columns.div_ceil(factor);
        let tiles = columns * rows.div_ceil(factor);
        let mut sums = vec![Some(Fixed128::ZERO); (tiles * self.channels) as usize];
        for row in 0..rows {
            for column in 0..self.columns {
                let tile = (row / factor) * columns + column / factor;
                for channel in 0..self.channels {
                    let into = &mut sums[(tile * self.channels + channel) as usize];
                    *into = add(*into, self.get(column, row, channel));
                }
            }
        }
        Self {
            columns,
            channels: self.channels,
            sums,
        }
    }
}

/// The sum, unless it is out of range.
pub(crate) fn add(a: Option<Fixed128>, b: Option<Fixed128>) -> Option<Fixed128> {
    let mut sum = a?;
    sum.merge(b?).ok()?;
    Some(sum)
}

impl From<TileMeans> for Stored {
    fn from(means: TileMeans) -> Self {
        let bytes: Vec<u8> = means.values.iter().flat_map(|x| x.to_le_bytes()).collect();
        Self {
            side: means.side,
            columns: means.columns,
            rows: means.rows,
            channels: means.channels,
            replicates: means.replicates,
            means: STANDARD.encode(bytes),
        }
    }
}

impl TryFrom<Stored> for TileMeans {
    type Error = String;

    fn try_from(stored: Stored) -> Result<Self, String> {
        if stored.side == Some(0) {
            return Err("tiles cannot have a side of 0 pixels".to_owned());
        }
        let expected = [
            stored.columns,
            stored.rows,
            stored.channels,
            stored.replicates,
        ]
        .into_iter()
        .try_fold(4u64, |product, n| product.checked_mul(n.into()));
        let bytes = STANDARD
            .decode(&stored.means)
            .map_err(|error| format!("tile means are not Base64: {error}"))?;
        if expected != Some(bytes.len() as u64) {
            return Err(format!(
                "{} × {} tiles, {} channels and {} replicates need other than {} bytes of means",
                stored.columns,
                stored.rows,
                stored.channels,
                stored.replicates,
                bytes.len()
            ));
        }
        let values = bytes
            .chunks_exact(4)
            .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
            .collect();
        Ok(Self {
            side: stored.side,
            columns: stored.columns,
            rows: stored.rows,
            channels: stored.channels,
            replicates: stored.replicates,
            values,
        })
    }
}
