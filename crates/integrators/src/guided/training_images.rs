//! The pictures of the training's last round, and how they join the replicates.
//!
//! ```text
//! C_r = (1 − w)·F_r + w·T_r,      w = k/(n + k)
//! ```
//!
//! F_r is the mean of a pixel's n samples in replicate r, T_r that of the k samples that the last
//! round of training has drawn for this replicate: every sample counts alike. The weights of Müller (2019,
//! §10.5.3), the inverse variances of the rounds, are estimated from the samples that they weigh, and
//! so bias the picture; these are fixed beforehand.
//!
//! If T_r is not finite, that pixel's samples do without it, except the first in the replicate, which the film refuses,
//! counts and reports with its address.

use etalon_transport::{FilmSample, Pass, Placing, Sink, TileSink};
use glam::{UVec2, Vec2, Vec4};

/// The most memory for pictures (bytes); beyond, there are none.
const MOST: u64 = 1 << 30;

/// Pictures by samples of training, one for each replicate.
#[derive(Clone, Debug)]
pub(crate) struct TrainingImages {
    origin: UVec2,
    size: UVec2,
    width: usize,
    /// Whether pixels share samples; those of training they do not.
    shared: bool,
    replicates: usize,
    /// k
    samples: u32,
    /// w of every pixel, row by row.
    shares: Vec<f32>,
    /// Sums of colours and alpha, weighted by the film's filter: replicate by replicate for
    /// every pixel, row by row.
    sums: Vec<Vec4>,
}

impl TrainingImages {
    /// Black ones, to which `samples` of each pixel and replicate will be added; `None` if there are no such
    /// samples or too many pictures.
    pub(crate) fn black(placing: &impl Placing, pass: &Pass, samples: u32) -> Option<Self> {
        let pixels = u64::from(pass.size.x) * u64::from(pass.size.y);
        let bytes = pixels * (u64::from(pass.replicates) * 16 + 4);
        if samples == 0 || bytes > MOST {
            return None;
        }
        let pixel = |index: u32| pass.origin + UVec2::new(index % pass.size.x, index / pass.size.x);
        let shared = placing.shares_samples();
        let share = |index: u32| {
            // A pixel that samples of several count for weighs them all alike.
            let own = match shared {
                true => pass.samples,
                false => placing.dealt(pixel(index), pass.samples),
            };
            (f64::from(samples) / (f64::from(samples) + f64::from(own))) as f32
        };
        Some(Self {
            origin: pass.origin,
            size: pass.size,
            width: pass.size.x as usize,
            shared,
            replicates: pass.replicates as usize,
            samples,
            shares: (0..pixels as u32).map(share).collect(),
            sums: vec![Vec4::ZERO; pixels as usize * pass.replicates as usize],
        })
    }

    /// The sums of each row's pixels.
    pub(crate) fn rows(&mut self) -> impl Iterator<Item = &mut [Vec4]> {
        self.sums.chunks_mut((self.width * self.replicates).max(1))
    }

    /// w and T_r of a pixel; T_r of those around the film counts for none.
    fn of(&self, pixel: UVec2, replicate: u32) -> (f32, Vec4) {
        let place = pixel.wrapping_sub(self.origin);
        if !place.cmplt(self.size).all() {
            return (self.shares[0], Vec4::ZERO);
        }
        let pixel = place.y as usize * self.width + place.x as usize;
        let sum = self.sums[pixel * self.replicates + replicate as usize];
        (self.shares[pixel], sum / self.samples as f32)
    }
}

/// A sink that adds the training's pictures to a replicate's samples.
pub(crate) struct TrainingSink<'a, K> {
    sink: &'a mut K,
    pictures: &'a TrainingImages,
    replicate: u32,
    /// 1 − w
    own: f32,
    /// w·T_r over the sample's weight on the film, so that the film's mean over samples is that of T_r.
    training: Vec4,
    /// Whether each of the samples to come is its pixel's first in the replicate.
    first: std::vec::IntoIter<bool>,
}

impl<'a, K> TrainingSink<'a, K> {
    /// For a replicate; `first` marks the samples that are their pixels' first.
    pub(crate) fn new(
        sink: &'a mut K,
        pictures: &'a TrainingImages,
        replicate: u32,
        first: Vec<bool>,
    ) -> Self {
        Self {
            sink,
            pictures,
            replicate,
            own: 1.0,
            training: Vec4::ZERO,
            first: first.into_iter(),
        }
    }

    /// Adds the non-finite value to a pixel's first sample only.
    #[cold]
    fn spoil(&mut self, first: bool, mean: Vec4) {
        (self.own, self.training) = (1.0, if first { mean } else { Vec4::ZERO });
    }
}

impl<K: TileSink> Sink for TrainingSink<'_, K> {
    fn radiance(&mut self, [r, g, b]: [f32; 3], alpha: f32) {
        let mut joined = Vec4::new(r, g, b, alpha) * self.own;
        let training = self.training;
        let alone = self.pictures.shared && training.is_finite();
        if !alone {
            joined += training;
        }
        self.sink.radiance(joined.truncate().to_array(), joined.w);
        if alone && training != Vec4::ZERO {
            let colour = training.truncate().to_array();
            self.sink.radiance_alone(colour, training.w);
        }
    }

    fn splat(&mut self, raster: Vec2, rgb: [f32; 3]) {
        self.sink.splat(raster, rgb);
    }

    fn channel(&mut self, index: usize, value: f32) {
        self.sink.channel(index, value);
    }
}

impl<K: TileSink> TileSink for TrainingSink<'_, K> {
    fn begin_sample(&mut self, pixel: UVec2, weight: f32) {
        self.sink.begin_sample(pixel, weight);
        self.join(pixel, weight);
    }

    fn begin_placed(&mut self, pixel: UVec2, placement: &FilmSample) {
        self.sink.begin_placed(pixel, placement);
        self.join(pixel, placement.weight);
    }
}

impl<K> TrainingSink<'_, K> {
    /// Finds what joins a sample of a pixel.
    fn join(&mut self, pixel: UVec2, weight: f32) {
        let (share, mean) = self.pictures.of(pixel, self.replicate);
        let first = self.first.next() == Some(true);
        if mean.is_finite() {
            (self.own, self.training) = (1.0 - share, mean * (share / weight));
        } else {
            self.spoil(first, mean);
        }
    }
}
