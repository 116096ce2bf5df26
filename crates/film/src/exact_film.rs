//! The film: pixels that accumulate exactly, replicate by replicate.
//!
//! While a replicate is rendered, every pixel and channel has one exact sum (`running.rs`), to
//! which tiles add once per pixel; splats have sums of their own. When the replicate ends, the sums are divided by the number of samples; these means, and their
//! squares, join exact sums over replicates, and tile means are taken. All of this is integer
//! arithmetic, so the bits of an image depend on neither threads nor the order of tiles.
//!
//! Memory: 64 bytes per pixel and channel and 16 per pixel (52 MiB for 512 × 512 in RGB), and
//! another 16 for each colour of a pixel where samples splat.

use crate::exact_sums::{EXACT, ExactSums};
use crate::faults::{FaultLog, InvalidSample};
use crate::filter_method::FilterMethod;
use crate::footprint::Footprint;
use crate::layout::{self, Divisor};
use crate::outliers::{DominantSample, OutlierLog};
use crate::pixel_moments::PixelMoments;
use crate::running::{Running, reserved};
use crate::sample_counts::{SAMPLES, SampleCounts};
use crate::tile_means::TileMeans;
use crate::unfinished::{Unfinished, reached};
use crate::{FilmSettings, Metadata, PixelFilter};
use etalon_params::Diagnostic;
use etalon_statistics::{Fixed128, InvalidValue};
use etalon_transport::Channel;
use glam::{IVec2, UVec2};

/// Prefix of the names of channels with standard errors.
pub const STANDARD_ERROR: &str = "standard_error.";

/// A film that accumulates exactly.
#[derive(Debug)]
pub struct ExactFilm {
    settings: FilmSettings,
    filter: PixelFilter,
    /// Weights of a sample on the pixels around it, if pixels share samples.
    footprint: Option<Footprint>,
    /// All channels: colours, alpha, then the integrator's.
    channels: Vec<String>,
    /// The replicate being rendered.
    pub(crate) running: Running,
    /// Sums over finished replicates, by row, column and channel.
    moments: Vec<PixelMoments>,
    /// The number of the first replicate, and how many are finished.
    first: u32,
    replicates: u32,
    samples: u64,
    /// The samples of each pixel in a replicate, if they are not dealt evenly.
    pub(crate) counts: Option<SampleCounts>,
    tiles: [TileMeans; 3],
    faults: FaultLog,
    outliers: OutlierLog,
}

impl ExactFilm {
    /// An empty film with channels for the colour and those that the integrator names.
    ///
    /// # Errors
    /// If the crop is empty or not within the film, two channels of the file would have the same
    /// name, or the memory cannot be had.
    pub fn new(settings: FilmSettings, named: &[Channel]) -> Result<Self, Diagnostic> {
        if !settings.is_valid() {
            let (o, c, w) = (settings.crop_offset, settings.crop_size, settings.size);
            let message = format!("a crop of {c} pixels at {o} is not within a film of {w}");
            return Err(Diagnostic::error_nowhere(message));
        }
        let format = settings.pixel_format;
        let mut channels = settings.colours();
        let colours = channels.len();
        if format.has_alpha() {
            channels.push("A".to_owned());
        }
        for Channel(name) in named {
            let reserved = [STANDARD_ERROR, EXACT]
                .iter()
                .any(|of| name.starts_with(of))
                || name == SAMPLES;
            if channels.contains(name) || reserved || name.is_empty() {
                let message = format!("two channels of the film would be called `{name}`");
                return Err(Diagnostic::error_nowhere(message)
                    .help("give the integrators and their `aovs` different names"));
            }
            channels.push(name.clone());
        }
        let size = settings.crop_size;
        let pixels = u64::from(size.x) * u64::from(size.y);
        let count = pixels * channels.len() as u64;
        let method = settings.filter_method.with(&settings.filter);
        let footprint =
            (method != FilterMethod::ImportanceSampling).then(|| Footprint::new(&settings.filter));
        let weighted = method == FilterMethod::WeightedMean;
        let running = Running::new(pixels, channels.len(), colours, weighted);
        let (Some(running), Some(mut moments)) = (running, reserved(count)) else {
            let (w, h, n) = (size.x, size.y, channels.len());
            let message = format!("there is no memory for {w} × {h} pixels of {n} channels");
            return Err(Diagnostic::error_nowhere(message)
                .help("a film takes 64 bytes per pixel and channel; crop it or make it smaller"));
        };
        moments.resize(count as usize, PixelMoments::ZERO);
        let means = |side| TileMeans::new(side, size.to_array(), channels.len() as u32);
        Ok(Self {
            filter: PixelFilter::new(settings.filter),
            footprint,
            running,
            moments,
            first: 0,
            replicates: 0,
            samples: 0,
            counts: None,
            tiles: layout::TILES.map(means),
            faults: FaultLog::default(),
            outliers: OutlierLog::default(),
            channels,
            settings,
        })
    }

    /// The same film, whose first replicate is the image's replicate `first`: for parts.
    #[must_use]
    pub fn starting_at(self, first: u32) -> Self {
        Self { first, ..self }
    }

    /// The same film, which deals samples to its pixels by these counts.
    ///
    /// # Panics
    /// If they are not those of as many pixels.
    #[must_use]
    pub fn dealing(self, counts: Option<SampleCounts>) -> Self {
        let size = self.settings.crop_size;
        let pixels = size.x as usize * size.y as usize;
        assert!(
            counts
                .as_ref()
                .is_none_or(|c| c.of_pixels().len() == pixels),
            "every pixel has its count"
        );
        Self { counts, ..self }
    }

    /// The samples of each pixel in a replicate, if they are not dealt evenly.
    pub fn counts(&self) -> Option<&SampleCounts> {
        self.counts.as_ref()
    }

    /// The number of its first replicate within the whole image.
    pub(crate) fn first_replicate(&self) -> u32 {
        self.first
    }

    /// Size, crop, format and filter.
    pub fn settings(&self) -> &FilmSettings {
        &self.settings
    }

    /// The filter, ready to be sampled.
    pub fn filter(&self) -> &PixelFilter {
        &self.filter
    }

    /// Number of colour channels; they come first.
    #[inline]
    pub(crate) fn colours(&self) -> usize {
        self.running.colours()
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

    /// Refused values of finished replicates.
    pub fn faults(&self) -> FaultLog {
        self.faults.clone()
    }

    /// Outliers of finished replicates.
    pub fn outliers(&self) -> OutlierLog {
        self.outliers.clone()
    }

    /// Means over tiles of 16² and 64² pixels and over the whole image.
    pub fn tile_means(&self) -> &[TileMeans] {
        &self.tiles
    }

    /// Divides the current sums by `divisor`, and lets the means join the statistics as those
    /// of `samples` per pixel.
    pub(crate) fn finish_replicate(&mut self, divisor: Divisor<'_>, samples: u64) {
        let (origin, size) = (self.settings.crop_offset, self.settings.crop_size);
        let replicate = self.replicate();
        let layout = layout::Layout {
            channels: &self.channels,
            origin,
            size,
            replicate,
        };
        self.outliers
            .merge(self.running.outliers(origin, size.x, replicate));
        let mut lost = FaultLog::default();
        let (divisor, of_splats) = match divisor {
            Divisor::Even(samples) if self.running.is_weighted() => (Divisor::Even(1), samples),
            divisor => (divisor, 1),
        };
        let whole = self.running.whole(of_splats, |pixel, channel, fault| {
            let place = UVec2::new(pixel as u32 % size.x, pixel as u32 / size.x);
            lost.note(InvalidSample {
                replicate,
                pixel: (origin + place).as_ivec2().to_array(),
                sample: None,
                source: self.channels[channel].clone(),
                kind: fault.into(),
            });
        });
        let (sums, log) = layout.finish(whole, &mut self.moments, divisor);
        for (means, sums) in self.tiles.iter_mut().zip(&sums) {
            means.push(sums, divisor.of_tiles(), size.to_array());
        }
        for log in [lost, log, self.running.begin()] {
            self.faults.merge(log);
        }
        self.replicates += 1;
        self.samples += samples;
    }

    /// The finished replicates, by row, column and channel.
    pub(crate) fn moments(&self) -> &[PixelMoments] {
        &self.moments
    }

    /// Takes the sums over finished replicates out of it.
    pub(crate) fn take_sums(&mut self) -> ExactSums {
        ExactSums::new(self.channels.len(), std::mem::take(&mut self.moments))
    }

    /// Puts sums over finished replicates into it.
    pub(crate) fn put_sums(&mut self, sums: ExactSums) {
        self.moments = sums.into_moments();
    }

    /// Continues after the finished replicates of this metadata.
    pub(crate) fn go_on_after(&mut self, metadata: Metadata) -> Result<(), String> {
        self.tiles = (metadata.tile_means.try_into())
            .map_err(|_| "its tile means are not those of a film".to_owned())?;
        self.replicates = metadata.replicates;
        self.samples = metadata.spp;
        self.faults = metadata.faults;
        self.outliers = metadata.outliers;
        Ok(())
    }

    /// The replicate that is not finished, if it has been begun.
    pub(crate) fn unfinished(&mut self) -> Option<Unfinished> {
        let mut unfinished = self.running.snapshot()?;
        if let Some(weights) = self.expected_weights(&unfinished.samples) {
            let fixed = |count| Fixed128::from_f64(count).unwrap_or(Fixed128::ZERO);
            unfinished.weights = weights.into_iter().map(fixed).collect();
        }
        Some(unfinished)
    }

    /// What samples count for each pixel in expectation if pixels have these numbers of them; `None` where each counts for its own
    /// pixel alone, or is weighed itself.
    fn expected_weights(&self, samples: &[u32]) -> Option<Vec<f64>> {
        let footprint = self
            .footprint
            .as_ref()
            .filter(|_| !self.running.is_weighted())?;
        let size = self.settings.crop_size.to_array().map(|n| n as usize);
        let counts = (0..).zip(samples);
        let weighted = counts.map(|(pixel, n)| f64::from(*n) * f64::from(self.weight_of(pixel)));
        Some(reached(footprint, weighted.collect(), size))
    }

    /// The means of the replicate that is being rendered, plane by plane, and the samples of each pixel; `None` before its first.
    pub(crate) fn running_means(&mut self) -> Option<(Vec<Vec<f32>>, Vec<u32>)> {
        let samples = self.running.all_samples();
        if samples.iter().all(|&count| count == 0) {
            return None;
        }
        let weights = self.expected_weights(&samples);
        let means = self.running.means(&samples, weights.as_deref());
        Some((means, samples))
    }

    /// Continues an unfinished replicate, of as many pixels and channels.
    pub(crate) fn go_on_with(&mut self, unfinished: Unfinished) {
        self.running.restore(unfinished);
    }

    /// The number of samples of a pixel of the whole film in this replicate, and the dominant one.
    pub(crate) fn progress(&self, pixel: UVec2) -> (u32, DominantSample) {
        let index = self.index(pixel - self.settings.crop_offset);
        (self.running.samples(index), self.running.standing(index))
    }

    /// Stores the number of samples of a pixel of the whole film, and the dominant one.
    pub(crate) fn advance(&self, pixel: UVec2, samples: u32, standing: &DominantSample) {
        let index = self.index(pixel - self.settings.crop_offset);
        self.running.advance(index, samples, standing);
    }

    /// Adds sums to a pixel of the whole film, and empties them.
    pub(crate) fn deliver(
        &self,
        pixel: UVec2,
        alone: bool,
        sums: &mut [Fixed128],
        faults: &mut FaultLog,
    ) {
        let index = self.index(pixel - self.settings.crop_offset);
        for (channel, (current, sum)) in self.running.of_pixel(index).zip(sums).enumerate() {
            let outcome = if alone {
                current.merge_alone(*sum)
            } else {
                current.merge(*sum)
            };
            *sum = Fixed128::ZERO;
            if let Err(fault) = outcome {
                let source = self.channels.get(channel).map_or("weight", String::as_str);
                faults.note(self.offence(pixel.as_ivec2(), None, source, fault));
            }
        }
    }

    /// Adds a splat's colours, from the film's colour `first` on, to a pixel counted within the crop; says whether all
    /// went well.
    pub(crate) fn splat(
        &self,
        pixel: UVec2,
        colours: &[f32],
        first: usize,
    ) -> Result<(), InvalidValue> {
        self.running.splat(self.index(pixel), colours, first)
    }

    /// Weights of a sample on the pixels around it, if pixels share samples.
    pub(crate) fn footprint(&self) -> Option<&Footprint> {
        self.footprint.as_ref()
    }

    /// Number of sums per pixel: one per channel, and that of the weights if the sums are divided by it.
    pub(crate) fn sums_per_pixel(&self) -> usize {
        self.channels.len() + usize::from(self.running.is_weighted())
    }

    /// The pixel of the film next to a pixel, counted from the crop's first, that may lie around it.
    pub(crate) fn nearest(&self, pixel: IVec2) -> UVec2 {
        let last = self.settings.crop_size.as_ivec2() - 1;
        pixel.clamp(IVec2::ZERO, last).as_uvec2() + self.settings.crop_offset
    }

    /// What a sample of a pixel counts where pixels share samples and have different numbers of them: their mean over
    /// its own.
    pub(crate) fn deal_weight(&self, pixel: UVec2) -> f32 {
        self.weight_of(self.index(pixel - self.settings.crop_offset))
    }

    fn weight_of(&self, index: usize) -> f32 {
        let counts = self.counts.as_ref().filter(|_| self.footprint.is_some());
        counts.map_or(1.0, |counts| {
            counts.rounded_mean() as f32 / counts.of_pixels()[index] as f32
        })
    }

    /// The number of the replicate that is being rendered.
    pub(crate) fn replicate(&self) -> u32 {
        self.first + self.replicates
    }

    /// The record of a refused number.
    pub(crate) fn offence(
        &self,
        pixel: IVec2,
        sample: Option<u32>,
        source: &str,
        fault: InvalidValue,
    ) -> InvalidSample {
        InvalidSample {
            replicate: self.replicate(),
            pixel: pixel.to_array(),
            sample,
            source: source.to_owned(),
            kind: fault.into(),
        }
    }

    /// Adds a tile's log.
    pub(crate) fn report(&self, log: FaultLog) {
        self.running.report(log);
    }

    /// The place of a pixel counted within the crop.
    pub(crate) fn index(&self, pixel: UVec2) -> usize {
        let width = self.settings.crop_size.x as usize;
        pixel.y as usize * width + pixel.x as usize
    }
}
