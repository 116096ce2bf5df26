//! The contract of every sampler, and the address of one sample.
//!
//! A sample is a point of [0, 1)^∞. Its coordinates are read one or two at a time, and the
//! number of those read so far is its *dimension*. A sampler never remembers other samples:
//! coordinate `d` is a pure function of the [`SampleId`] and of `d`, so that any thread
//! may compute any sample at any time with the same bits.

use crate::hash::{mix64, stream_key};
use glam::Vec2;

/// The address of a sample in an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SampleId {
    /// The seed of the whole image.
    pub seed: u64,
    /// Index of the independent replicate.
    pub replicate: u32,
    /// Column and row of the pixel.
    pub pixel: (u32, u32),
    /// Index of the sample within its pixel and replicate.
    pub sample: u32,
    /// How many samples this pixel takes in this replicate; samplers that stratify spread
    /// their strata over that many. See [`SamplerKind::round_up`](crate::SamplerKind::round_up)
    /// for the counts they like; any count of at least 1 is valid. Indices at or beyond the
    /// count (of all blocks) are valid too: they begin a further, independently drawn set of strata.
    pub samples_per_replicate: u32,
    /// How many replicates are blocks of this one sequence, one after the other, each of
    /// `samples_per_replicate`; 1 if replicates are independent. Samplers that stratify spread
    /// finer strata over all of them. See [`ReplicateKind`](crate::ReplicateKind).
    pub blocks: u32,
}

impl SampleId {
    /// 64 well-mixed bits that all samples of this pixel and replicate share.
    #[inline]
    pub fn pixel_key(&self) -> u64 {
        let (x, y) = self.pixel;
        mix64(stream_key(self.seed, self.replicate) ^ (u64::from(y) << 32 | u64::from(x)))
    }
}

/// A source of coordinates in [0, 1).
///
/// A pair always begins at an even dimension: [`next_2d`](Sampler::next_2d) at an odd
/// dimension leaves that one out. All samplers count alike, so that an integrator may lay
/// out its dimensions once.
pub trait Sampler {
    /// The next coordinate, in [0, 1); advances the dimension by one.
    fn next_1d(&mut self) -> f32;

    /// The next pair of coordinates, each in [0, 1), jointly stratified where the sampler
    /// stratifies; advances to the next even dimension, then by two.
    fn next_2d(&mut self) -> Vec2;

    /// The dimension that will be read next.
    fn dimension(&self) -> u32;

    /// Continues at `dimension`, ahead or back. Integrators begin every bounce at a fixed
    /// dimension, so that what one bounce happened to use does not shift the next.
    fn skip_to(&mut self, dimension: u32);
}

/// A borrowed sampler is a sampler too, for callers that use it afterwards.
impl<S: Sampler + ?Sized> Sampler for &mut S {
    #[inline]
    fn next_1d(&mut self) -> f32 {
        (**self).next_1d()
    }

    #[inline]
    fn next_2d(&mut self) -> Vec2 {
        (**self).next_2d()
    }

    #[inline]
    fn dimension(&self) -> u32 {
        (**self).dimension()
    }

    #[inline]
    fn skip_to(&mut self, dimension: u32) {
        (**self).skip_to(dimension);
    }
}
