//! The film: pixels that accumulate exactly, replicate by replicate.
//!
//! While a replicate is rendered, every pixel and channel has one exact sum
//! ([`AtomicFixed128`]), to which tiles add once per pixel and splats add directly. When the
//! replicate ends, the sums are divided by the number of samples; these means, and their
//! squares, join exact sums over replicates, and tile means are taken. All of this is integer
//! arithmetic, so the bits of an image depend on neither threads nor the order of tiles.
//!
//! Memory: 64 bytes per pixel and channel (48 MiB for 512 × 512 in RGB).

use crate::faults::{FaultLog, Offence};
use crate::pixel_moments::PixelMoments;
use crate::tile_means::{self, TileMeans, TileSums};
use crate::tile_sink::ExactTile;
use crate::{FilmSettings, PixelFilter};
use etalon_params::Diagnostic;
use etalon_statistics::{AtomicFixed128, Fault, Fixed128, Moments};
use etalon_transport::{Channel, Film, Placement};
use glam::{UVec2, Vec2};
use rayon::prelude::*;
use std::sync::Mutex;

/// What the name of a channel with standard errors begins with.
pub const STANDARD_ERROR: &str = "standard_error.";

/// A film that accumulates exactly.
#[derive(Debug)]
pub struct ExactFilm {
    settings: FilmSettings,
    filter: PixelFilter,
    /// All channels: colours, alpha, then the integrator's.
    channels: Vec<String>,
    /// Sums of the replicate being rendered, by row, column and channel.
    current: Vec<AtomicFixed128>,
    /// Sums over finished replicates, in the same order.
    moments: Vec<PixelMoments>,
    replicates: u32,
    samples: u64,
    tiles: [TileMeans; 3],
    faults: Mutex<FaultLog>,
}

/// Pixels on the side of the smallest tiles.
const TILE: u32 = 16;

impl ExactFilm {
    /// An empty film with channels for the colour and those that the integrator names.
    ///
    /// # Errors
    /// If two channels of the file would have the same name, or the memory cannot be had.
    pub fn new(settings: FilmSettings, named: &[Channel]) -> Result<Self, Diagnostic> {
        let format = settings.pixel_format;
        let mut channels: Vec<String> = format.colours().iter().map(|&c| c.to_owned()).collect();
        if format.has_alpha() {
            channels.push("A".to_owned());
        }
        for Channel(name) in named {
            if channels.contains(name) || name.starts_with(STANDARD_ERROR) || name.is_empty() {
                let message = format!("two channels of the film would be called `{name}`");
                return Err(Diagnostic::error_nowhere(message)
                    .help("give the integrators and their `aovs` different names"));
            }
            channels.push(name.clone());
        }
        let size = settings.crop_size;
        let count = u64::from(size.x) * u64::from(size.y) * channels.len() as u64;
        let (Some(mut current), Some(mut moments)) = (reserved(count), reserved(count)) else {
            let (w, h, n) = (size.x, size.y, channels.len());
            let message = format!("there is no memory for {w} × {h} pixels of {n} channels");
            return Err(Diagnostic::error_nowhere(message)
                .help("a film takes 64 bytes per pixel and channel; crop it or make it smaller"));
        };
        current.resize_with(count as usize, AtomicFixed128::new);
        moments.resize(count as usize, PixelMoments::ZERO);
        let means = |side| TileMeans::new(side, size.to_array(), channels.len() as u32);
        Ok(Self {
            filter: PixelFilter::new(settings.filter),
            current,
            moments,
            replicates: 0,
            samples: 0,
            tiles: [means(Some(TILE)), means(Some(4 * TILE)), means(None)],
            faults: Mutex::default(),
            channels,
            settings,
        })
    }

    /// Size, crop, format and filter.
    pub fn settings(&self) -> &FilmSettings {
        &self.settings
    }

    /// The filter, ready to be sampled.
    pub fn filter(&self) -> &PixelFilter {
        &self.filter
    }

    /// The names of all channels: colours, alpha, then the integrator's.
    pub fn channels(&self) -> &[String] {
        &self.channels
    }

    /// Finished replicates.
    pub fn replicates(&self) -> u32 {
        self.replicates
    }

    /// Samples per pixel in all finished replicates together.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// What was refused so far.
    pub fn faults(&self) -> FaultLog {
        self.faults
            .lock()
            .unwrap_or_else(|e| e.into_inner())
            .clone()
    }

    /// Means over tiles of 16² and 64² pixels and over the whole image.
    pub fn tile_means(&self) -> &[TileMeans] {
        &self.tiles
    }

    /// The finished replicates of one channel of one pixel, counted within the crop.
    pub(crate) fn moments(&self, pixel: usize, channel: usize) -> Moments {
        self.moments[pixel * self.channels.len() + channel].of(self.replicates)
    }

    /// Adds sums to a pixel of the whole film, and empties them.
    pub(crate) fn deliver(&self, pixel: UVec2, sums: &mut [Fixed128], faults: &mut FaultLog) {
        let first = self.index(pixel - self.settings.crop_offset);
        for (channel, sum) in sums.iter_mut().enumerate() {
            let outcome = self.current[first + channel].merge(*sum);
            *sum = Fixed128::ZERO;
            if let Err(fault) = outcome {
                faults.note(self.offence(pixel, None, &self.channels[channel], fault));
            }
        }
    }

    /// Adds the first terms of a pixel counted within the crop; says whether all went well.
    pub(crate) fn add(&self, pixel: UVec2, terms: &[f32]) -> Result<(), Fault> {
        let first = self.index(pixel);
        terms
            .iter()
            .zip(&self.current[first..])
            .try_for_each(|(term, sum)| sum.add(*term))
    }

    /// The record of a refused number.
    pub(crate) fn offence(
        &self,
        pixel: UVec2,
        sample: Option<u32>,
        source: &str,
        fault: Fault,
    ) -> Offence {
        Offence {
            replicate: self.replicates,
            pixel: pixel.to_array(),
            sample,
            source: source.to_owned(),
            kind: fault.into(),
        }
    }

    /// Adds a tile's log.
    pub(crate) fn report(&self, log: FaultLog) {
        if !log.is_empty() {
            self.faults
                .lock()
                .unwrap_or_else(|e| e.into_inner())
                .merge(log);
        }
    }

    /// Where the sums of a pixel counted within the crop begin.
    fn index(&self, pixel: UVec2) -> usize {
        let width = self.settings.crop_size.x as usize;
        (pixel.y as usize * width + pixel.x as usize) * self.channels.len()
    }
}

/// Room for `count` values, if there is memory for them.
fn reserved<T>(count: u64) -> Option<Vec<T>> {
    let mut values = Vec::new();
    values
        .try_reserve_exact(usize::try_from(count).ok()?)
        .ok()?;
    Some(values)
}

impl Film for ExactFilm {
    type Tile<'f> = ExactTile<'f>;

    fn origin(&self) -> UVec2 {
        self.settings.crop_offset
    }

    #[expect(
        clippy::misnamed_getters,
        reason = "to a renderer, the film is its crop"
    )]
    fn size(&self) -> UVec2 {
        self.settings.crop_size
    }

    #[inline]
    fn place(&self, pixel: UVec2, u: Vec2) -> Placement {
        let (offset, weight) = self.filter.sample(u);
        Placement {
            raster: pixel.as_vec2() + 0.5 + offset,
            weight,
        }
    }

    fn margin(&self) -> f32 {
        self.filter.margin()
    }

    fn tile(&self, from: UVec2, to: UVec2) -> ExactTile<'_> {
        ExactTile::new(self, from, to)
    }

    fn end_replicate(&mut self, samples: u32) {
        if samples == 0 {
            return;
        }
        let channels = self.channels.len();
        let width = self.settings.crop_size.x as usize;
        let band = TILE as usize * width * channels;
        let (names, origin, replicate) =
            (&self.channels, self.settings.crop_offset, self.replicates);
        let bands: Vec<(Vec<Option<Fixed128>>, FaultLog)> = self
            .current
            .par_chunks_mut(band)
            .zip(self.moments.par_chunks_mut(band))
            .enumerate()
            .map(|(row, (current, moments))| {
                let mut sums = vec![Some(Fixed128::ZERO); width.div_ceil(TILE as usize) * channels];
                let mut log = FaultLog::default();
                for (i, (sum, moments)) in current.iter_mut().zip(moments).enumerate() {
                    let sum = sum.take();
                    let (pixel, channel) = (i / channels, i % channels);
                    let tile = pixel % width / TILE as usize * channels + channel;
                    sums[tile] = tile_means::add(sums[tile], Some(sum));
                    if let Err(fault) = moments.push(sum.mean_fixed(samples.into())) {
                        let y = row * TILE as usize + pixel / width;
                        let pixel = origin + UVec2::new((pixel % width) as u32, y as u32);
                        log.note(Offence {
                            replicate,
                            pixel: pixel.to_array(),
                            sample: None,
                            source: names[channel].clone(),
                            kind: fault.into(),
                        });
                    }
                }
                (sums, log)
            })
            .collect();
        let mut finest = TileSums {
            columns: self.settings.crop_size.x.div_ceil(TILE),
            channels: channels as u32,
            sums: Vec::new(),
        };
        for (sums, log) in bands {
            finest.sums.extend(sums);
            self.report(log);
        }
        let size = self.settings.crop_size.to_array();
        let coarse = finest.coarser(4);
        let whole = coarse.coarser(coarse.columns.max(size[1].div_ceil(4 * TILE)));
        for (means, sums) in self.tiles.iter_mut().zip([&finest, &coarse, &whole]) {
            means.push(sums, samples, size);
        }
        self.replicates += 1;
        self.samples += u64::from(samples);
    }
}
