//! The end of a replicate: its means join the statistics, and its tiles are summed.

use crate::faults::{FaultLog, InvalidSample};
use crate::pixel_moments::PixelMoments;
use crate::tile_means::{TileSums, add};
use etalon_statistics::{AtomicFixed128, Fixed128};
use glam::UVec2;
use rayon::prelude::*;

/// Sides of the tiles whose means are kept (pixels); the last is the whole image.
pub(crate) const TILES: [Option<u32>; 3] = [Some(SIDE), Some(SIDE * FACTOR), None];

/// Side of the smallest tiles.
const SIDE: u32 = 16;
/// Ratio of the sides of successive tile sizes.
const FACTOR: u32 = 4;

/// The divisor of a replicate's sums.
#[derive(Clone, Copy)]
pub(crate) enum Divisor<'f> {
    /// The same number in all pixels.
    Even(u64),
    /// The samples of each pixel, by row and column.
    OfPixels(&'f [u32]),
}

impl Divisor<'_> {
    /// What the sums over tiles are divided by: those of unevenly sampled pixels are of means
    /// already.
    pub(crate) fn of_tiles(self) -> u64 {
        match self {
            Self::Even(divisor) => divisor,
            Self::OfPixels(_) => 1,
        }
    }
}

/// The layout of a film's numbers.
pub(crate) struct Layout<'f> {
    pub(crate) channels: &'f [String],
    pub(crate) origin: UVec2,
    pub(crate) size: UVec2,
    pub(crate) replicate: u32,
}

impl Layout<'_> {
    /// Empties the current sums into the moments, each divided by `divisor`. Gives the sums over
    /// the tiles of each size, and what did not fit.
    pub(crate) fn finish(
        &self,
        current: &mut [AtomicFixed128],
        moments: &mut [PixelMoments],
        divisor: Divisor<'_>,
    ) -> ([TileSums; 3], FaultLog) {
        let channels = self.channels.len();
        let band = SIDE as usize * self.size.x as usize * channels;
        let bands: Vec<(Vec<Option<Fixed128>>, FaultLog)> = current
            .par_chunks_mut(band)
            .zip(moments.par_chunks_mut(band))
            .enumerate()
            .map(|(row, (current, moments))| self.band(row as u32, current, moments, divisor))
            .collect();
        let mut log = FaultLog::default();
        let mut finest = TileSums {
            columns: self.size.x.div_ceil(SIDE),
            channels: channels as u32,
            sums: Vec::new(),
        };
        for (sums, of_band) in bands {
            finest.sums.extend(sums);
            log.merge(of_band);
        }
        let coarse = finest.coarser(FACTOR);
        let whole = coarse.coarser(coarse.columns.max(self.size.y.div_ceil(SIDE * FACTOR)));
        ([finest, coarse, whole], log)
    }

    /// One row of tiles.
    fn band(
        &self,
        row: u32,
        current: &mut [AtomicFixed128],
        moments: &mut [PixelMoments],
        divisor: Divisor<'_>,
    ) -> (Vec<Option<Fixed128>>, FaultLog) {
        let channels = self.channels.len();
        let columns = self.size.x.div_ceil(SIDE) as usize;
        let mut sums = vec![Some(Fixed128::ZERO); columns * channels];
        let mut log = FaultLog::default();
        let pixels = current
            .chunks_exact_mut(channels)
            .zip(moments.chunks_exact_mut(channels));
        for (i, (current, moments)) in (0u32..).zip(pixels) {
            let (x, y) = (i % self.size.x, i / self.size.x);
            let tile = (x / SIDE) as usize * channels;
            let tile = &mut sums[tile..tile + channels];
            for (channel, sum) in current.iter_mut().enumerate() {
                let sum = sum.take();
                let (mean, into_tile) = match divisor {
                    Divisor::Even(divisor) => (sum.mean_fixed(divisor), sum),
                    Divisor::OfPixels(counts) => {
                        let first = (row * SIDE * self.size.x) as usize;
                        let mean = sum.mean_fixed(counts[first + i as usize].into());
                        (mean, mean)
                    }
                };
                tile[channel] = add(tile[channel], Some(into_tile));
                if let Err(fault) = moments[channel].push(mean) {
                    let pixel = self.origin + UVec2::new(x, row * SIDE + y);
                    log.note(InvalidSample {
                        replicate: self.replicate,
                        pixel: pixel.as_ivec2().to_array(),
                        sample: None,
                        source: self.channels[channel].clone(),
                        kind: fault.into(),
                    });
                }
            }
        }
        (sums, log)
    }
}
