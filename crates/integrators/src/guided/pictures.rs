//! What paths in training saw, and how it joins the picture.
//!
//! ```text
//! C_r = (1 − w)·F_r + w·T_r,      w = k/(n + k)
//! ```
//!
//! F_r is the mean of a pixel's n samples in replicate r, T_r that of the k samples that training has
//! drawn for this replicate: every sample counts alike. The weights of Müller (2019, §10.5.3), the
//! inverse variances of the rounds, are estimated from the samples that they weigh, and so bias the
//! picture; these are fixed beforehand.

use etalon_transport::{Pass, Sink, TileSink};
use glam::{UVec2, Vec4};

/// Pictures by samples of training, one for each replicate.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pictures {
    origin: UVec2,
    width: usize,
    replicates: usize,
    /// Samples of each pixel in each replicate.
    samples: u32,
    /// Their colours and alpha, weighted by the film's filter and added up: replicate by replicate
    /// for every pixel, row by row.
    sums: Vec<Vec4>,
}

impl Pictures {
    /// Black ones, for an image whose passes are like this one.
    pub(crate) fn black(pass: &Pass) -> Self {
        let replicates = replicates(pass) as usize;
        Self {
            origin: pass.origin,
            width: pass.size.x as usize,
            replicates,
            samples: 0,
            sums: vec![Vec4::ZERO; replicates * pass.size.element_product() as usize],
        }
    }

    /// The sums of each row's pixels, to which `samples` more of each replicate will be added.
    pub(crate) fn rows(&mut self, samples: u32) -> Vec<&mut [Vec4]> {
        self.samples += samples;
        let row = self.width * self.replicates;
        self.sums.chunks_mut(row.max(1)).collect()
    }

    /// w of the head of the file, with `samples` in F_r.
    fn share(&self, samples: u32) -> f32 {
        let all = f64::from(self.samples) + f64::from(samples);
        (f64::from(self.samples) / all) as f32
    }

    /// T_r of a pixel; nothing if there are no samples.
    fn mean(&self, pixel: UVec2, replicate: u32) -> Vec4 {
        if self.samples == 0 {
            return Vec4::ZERO;
        }
        let place = (pixel - self.origin).as_usizevec2();
        let pixel = place.y * self.width + place.x;
        self.sums[pixel * self.replicates + replicate as usize] / self.samples as f32
    }
}

/// The replicates of an image of such passes, each of which is a replicate.
pub(crate) fn replicates(pass: &Pass) -> u32 {
    (pass.image_samples / pass.samples.max(1)).max(1)
}

/// Passes a replicate's samples on, joined by what training has seen of their pixels.
pub(crate) struct Joined<'a, K> {
    sink: &'a mut K,
    pictures: &'a Pictures,
    replicate: u32,
    /// w
    share: f32,
    /// w·T_r, over what a sample counts on the film, so that the film's mean over samples is that of T_r.
    training: Vec4,
}

impl<'a, K> Joined<'a, K> {
    /// Of a replicate of `samples` samples per pixel.
    pub(crate) fn new(
        sink: &'a mut K,
        pictures: &'a Pictures,
        replicate: u32,
        samples: u32,
    ) -> Self {
        Self {
            sink,
            pictures,
            replicate,
            share: pictures.share(samples),
            training: Vec4::ZERO,
        }
    }
}

impl<K: TileSink> Sink for Joined<'_, K> {
    fn radiance(&mut self, [r, g, b]: [f32; 3], alpha: f32) {
        let joined = Vec4::new(r, g, b, alpha) * (1.0 - self.share) + self.training;
        self.sink.radiance(joined.truncate().to_array(), joined.w);
    }

    fn splat(&mut self, raster: glam::Vec2, rgb: [f32; 3]) {
        self.sink.splat(raster, rgb);
    }

    fn channel(&mut self, index: usize, value: f32) {
        self.sink.channel(index, value);
    }
}

impl<K: TileSink> TileSink for Joined<'_, K> {
    fn begin_sample(&mut self, pixel: UVec2, weight: f32) {
        self.sink.begin_sample(pixel, weight);
        self.training = self.pictures.mean(pixel, self.replicate) * (self.share / weight);
    }
}
