//! The replicate that is being rendered: one exact sum per pixel and channel, and how many samples
//! it is of.
//!
//! Samples come in any number of rounds, so that a render can be interrupted between any two of
//! them: what a pixel has is a count of samples, the sums over them, and what stood out among
//! them. Splats have sums of their own: those of a pixel are of the samples of all pixels.

use crate::faults::FaultLog;
use crate::outliers::{DominantSample, Outlier, OutlierLog};
use crate::unfinished::Unfinished;
use etalon_statistics::{AtomicFixed128, Fixed128, InvalidValue};
use glam::UVec2;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, OnceLock};

/// Sums of a replicate that is not finished.
#[derive(Debug)]
pub(crate) struct Running {
    channels: usize,
    /// Sums of the samples of each pixel, by row, column and channel.
    own: Vec<AtomicFixed128>,
    /// What splats bring to the colours; made for the first of them.
    colours: usize,
    splats: OnceLock<Box<[AtomicFixed128]>>,
    /// Sums of the weights of each pixel, by row and column, if sums are divided by them; else empty.
    weights: Vec<AtomicFixed128>,
    /// By row and column.
    pixels: Vec<PixelProgress>,
    /// Its refused values.
    faults: Mutex<FaultLog>,
}

/// The progress of a pixel. Only the tile that has the pixel writes to it.
#[derive(Debug, Default)]
struct PixelProgress {
    samples: AtomicU32,
    /// Of [`DominantSample`]: the floats' bits, and the sample.
    standing: [AtomicU32; 3],
}

impl Running {
    /// Nothing yet, for so many pixels; `None` if there is no memory for it.
    pub(crate) fn new(
        pixels: u64,
        channels: usize,
        colours: usize,
        weighted: bool,
    ) -> Option<Self> {
        let sums = pixels.checked_mul(channels as u64)?;
        let (mut own, mut progress) = (reserved(sums)?, reserved(pixels)?);
        own.resize_with(sums as usize, AtomicFixed128::new);
        progress.resize_with(pixels as usize, PixelProgress::default);
        let weighted = if weighted { pixels } else { 0 };
        let mut weights = reserved(weighted)?;
        weights.resize_with(weighted as usize, AtomicFixed128::new);
        Some(Self {
            channels,
            own,
            colours,
            splats: OnceLock::new(),
            weights,
            pixels: progress,
            faults: Mutex::default(),
        })
    }

    /// The sums of a pixel's samples, and of their weights if the sums are divided by these.
    pub(crate) fn of_pixel(&self, pixel: usize) -> impl Iterator<Item = &AtomicFixed128> {
        let own = &self.own[pixel * self.channels..][..self.channels];
        own.iter().chain(self.weights.get(pixel))
    }

    /// Number of colour channels.
    #[inline]
    pub(crate) fn colours(&self) -> usize {
        self.colours
    }

    /// Whether sums are divided by the sum of the weights.
    pub(crate) fn is_weighted(&self) -> bool {
        !self.weights.is_empty()
    }

    /// Adds the colours of a splat to a pixel's, from `first` on; says whether all went well.
    pub(crate) fn splat(
        &self,
        pixel: usize,
        colours: &[f32],
        first: usize,
    ) -> Result<(), InvalidValue> {
        let sums = self.splats.get_or_init(|| self.no_splats());
        let sums = &sums[pixel * self.colours + first..];
        let mut pairs = colours.iter().zip(sums);
        pairs.try_for_each(|(term, sum)| sum.add(*term))
    }

    fn no_splats(&self) -> Box<[AtomicFixed128]> {
        let count = self.pixels.len() * self.colours;
        (0..count).map(|_| AtomicFixed128::new()).collect()
    }

    /// The samples that a pixel has.
    #[inline]
    pub(crate) fn samples(&self, pixel: usize) -> u32 {
        self.pixels[pixel].samples.load(Ordering::Relaxed)
    }

    /// The dominant sample of a pixel.
    pub(crate) fn standing(&self, pixel: usize) -> DominantSample {
        let words = &self.pixels[pixel].standing;
        DominantSample::from_words(words.each_ref().map(|word| word.load(Ordering::Relaxed)))
    }

    /// Notes that a pixel has so many samples, which bring this.
    pub(crate) fn advance(&self, pixel: usize, samples: u32, standing: &DominantSample) {
        let progress = &self.pixels[pixel];
        progress.samples.store(samples, Ordering::Relaxed);
        for (word, value) in progress.standing.iter().zip(standing.words()) {
            word.store(value, Ordering::Relaxed);
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

    /// The samples that stand out in `replicate`, of a film whose rows have `width` pixels.
    pub(crate) fn outliers(&self, origin: UVec2, width: u32, replicate: u32) -> OutlierLog {
        let mut log = OutlierLog::default();
        for (index, place) in (0..self.pixels.len()).zip(0..) {
            let samples = self.samples(index);
            if let Some((sample, value)) = self.standing(index).outstanding(samples) {
                let pixel = origin + UVec2::new(place % width, place / width);
                log.note(Outlier {
                    replicate,
                    pixel: pixel.to_array(),
                    sample,
                    value,
                    lift: value / samples as f32,
                });
            }
        }
        log
    }

    /// Adds the splats to the sums of the pixels and returns these, to be emptied. Weighted sums become means, and splats
    /// are divided by `samples` then. `refuse` is called for sums that are out of range, by pixel and channel.
    pub(crate) fn whole(
        &mut self,
        samples: u64,
        mut refuse: impl FnMut(usize, usize, InvalidValue),
    ) -> &mut [AtomicFixed128] {
        let weights = self.weights.iter_mut();
        let pixels = self.own.chunks_exact_mut(self.channels).zip(weights);
        for (pixel, (own, weight)) in pixels.enumerate() {
            let weight = weight.take().to_f64();
            for (channel, sum) in own.iter_mut().enumerate() {
                let total = sum.take().to_f64();
                let mean = if total == 0.0 { 0.0 } else { total / weight };
                match Fixed128::from_f64(mean) {
                    Ok(mean) => *sum = AtomicFixed128::from_fixed(mean),
                    Err(fault) => refuse(pixel, channel, fault),
                }
            }
        }
        if let Some(splats) = self.splats.get_mut() {
            let pixels = self.own.chunks_exact_mut(self.channels);
            let splats = splats.chunks_exact_mut(self.colours);
            for (pixel, (own, splats)) in pixels.zip(splats).enumerate() {
                for (channel, (own, splat)) in own.iter_mut().zip(splats).enumerate() {
                    if let Err(fault) = own.merge_alone(splat.take().mean_fixed(samples)) {
                        refuse(pixel, channel, fault);
                    }
                }
            }
        }
        &mut self.own
    }

    /// Starts a new replicate, after the sums have been emptied; returns the faults of the last one.
    pub(crate) fn begin(&mut self) -> FaultLog {
        self.pixels.fill_with(PixelProgress::default);
        std::mem::take(self.faults.get_mut().unwrap_or_else(|e| e.into_inner()))
    }

    /// The samples of each pixel.
    pub(crate) fn all_samples(&self) -> Vec<u32> {
        (0..self.pixels.len())
            .map(|pixel| self.samples(pixel))
            .collect()
    }

    /// Means of the samples so far, plane by plane, for pixels with `samples` samples each: sums over their own weights if there
    /// are any, else over `weights`, else over their number. Splats are divided by the mean number. In single precision, for
    /// display.
    pub(crate) fn means(&mut self, samples: &[u32], weights: Option<&[f64]>) -> Vec<Vec<f32>> {
        let total: u64 = samples.iter().map(|&count| u64::from(count)).sum();
        let per_splat = samples.len() as f64 / total.max(1) as f64;
        let (channels, colours) = (self.channels, self.colours);
        // Factors on the sums of each pixel.
        let inverse = |x: f64| if x > 0.0 { 1.0 / x } else { 0.0 };
        let factors: Vec<f64> = match (weights, self.weights.is_empty()) {
            (_, false) => self
                .weights
                .par_iter_mut()
                .map(|w| inverse(w.load().to_f64()))
                .collect(),
            (Some(weights), true) => weights.par_iter().map(|&w| inverse(w)).collect(),
            (None, true) => samples.par_iter().map(|&n| inverse(f64::from(n))).collect(),
        };
        let mut values = vec![0.0_f32; self.own.len()];
        let pixels = values
            .par_chunks_mut(channels)
            .zip(self.own.par_chunks_mut(channels))
            .zip(&factors);
        pixels.for_each(|((values, sums), factor)| {
            for (value, sum) in values.iter_mut().zip(sums) {
                *value = (sum.load().to_f64() * factor) as f32;
            }
        });
        if let Some(splats) = self.splats.get_mut() {
            let splats = splats.par_chunks_mut(colours);
            values
                .par_chunks_mut(channels)
                .zip(splats)
                .for_each(|(values, splats)| {
                    for (value, splat) in values.iter_mut().zip(splats) {
                        *value += (splat.load().to_f64() * per_splat) as f32;
                    }
                });
        }
        let plane = |channel: usize| {
            values
                .iter()
                .skip(channel)
                .step_by(channels)
                .copied()
                .collect()
        };
        (0..channels).into_par_iter().map(plane).collect()
    }

    /// A copy of the unfinished replicate, if it has any sample.
    pub(crate) fn snapshot(&mut self) -> Option<Unfinished> {
        let pixels = 0..self.pixels.len();
        let samples = self.all_samples();
        if samples.iter().all(|&count| count == 0) {
            return None;
        }
        let read =
            |sums: &mut [AtomicFixed128]| sums.iter_mut().map(AtomicFixed128::load).collect();
        Some(Unfinished {
            weights: read(&mut self.weights),
            standing: pixels.map(|pixel| self.standing(pixel)).collect(),
            samples,
            own: read(&mut self.own),
            splats: self
                .splats
                .get_mut()
                .map(|splats| read(splats))
                .unwrap_or_default(),
            faults: (self.faults.get_mut().unwrap_or_else(|e| e.into_inner())).clone(),
        })
    }

    /// Continues an unfinished replicate, of as many pixels and channels.
    pub(crate) fn restore(&mut self, unfinished: Unfinished) {
        let made = |sums: Vec<Fixed128>| sums.into_iter().map(AtomicFixed128::from_fixed);
        let pixels = unfinished.samples.iter().zip(&unfinished.standing);
        for (pixel, (samples, standing)) in pixels.enumerate() {
            self.advance(pixel, *samples, standing);
        }
        self.own = made(unfinished.own).collect();
        // Those of other methods follow from the numbers of samples.
        if self.is_weighted() {
            self.weights = made(unfinished.weights).collect();
        }
        self.splats = match unfinished.splats.is_empty() {
            true => OnceLock::new(),
            false => OnceLock::from(made(unfinished.splats).collect::<Box<[_]>>()),
        };
        self.faults = Mutex::new(unfinished.faults);
    }
}

/// Room for `count` values, if there is memory for them.
pub(crate) fn reserved<T>(count: u64) -> Option<Vec<T>> {
    let mut values = Vec::new();
    values
        .try_reserve_exact(usize::try_from(count).ok()?)
        .ok()?;
    Some(values)
}
