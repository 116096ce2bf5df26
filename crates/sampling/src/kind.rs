//! The kind of sampler, chosen once per image.

use crate::sampler::{SampleId, Sampler};
use crate::stratified::ceil_sqrt;
use crate::{Independent, Sobol, Stratified};
use glam::Vec2;

/// A kind of sampler.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SamplerKind {
    /// Independent uniform numbers.
    Independent,
    /// A shuffled grid in every pair of dimensions.
    Stratified {
        /// Random places within the strata, or their centres.
        jitter: bool,
    },
    /// Owen-scrambled Sobol' points.
    Sobol,
}

impl SamplerKind {
    /// The smallest number of samples per pixel and replicate that is at least `samples` and
    /// that this sampler can stratify fully: any for `Independent`, a square for
    /// `Stratified`, a power of two for `Sobol`; at least 1, and never so large that it
    /// would not fit.
    pub fn round_up(self, samples: u32) -> u32 {
        let samples = samples.max(1);
        match self {
            Self::Independent => samples,
            // 65535² is the largest square of 32 bits, 2³¹ the largest power of two.
            Self::Stratified { .. } => ceil_sqrt(samples).min(65535).pow(2),
            Self::Sobol => samples.min(1 << 31).next_power_of_two(),
        }
    }

    /// Begins one sample.
    #[inline]
    pub fn start(self, sample: &SampleId) -> AnySampler {
        match self {
            Self::Independent => AnySampler::Independent(Independent::start(sample)),
            Self::Stratified { jitter } => {
                AnySampler::Stratified(Stratified::with_jitter(sample, jitter))
            }
            Self::Sobol => AnySampler::Sobol(Sobol::start(sample)),
        }
    }
}

/// A sampler of any kind, for callers that do not care to be compiled once for each.
#[derive(Clone, Debug)]
pub enum AnySampler {
    /// Independent uniform numbers.
    Independent(Independent),
    /// A shuffled grid in every pair of dimensions.
    Stratified(Stratified),
    /// Owen-scrambled Sobol' points.
    Sobol(Sobol),
}

macro_rules! forward {
    ($self:ident, $sampler:ident => $call:expr) => {
        match $self {
            AnySampler::Independent($sampler) => $call,
            AnySampler::Stratified($sampler) => $call,
            AnySampler::Sobol($sampler) => $call,
        }
    };
}

impl Sampler for AnySampler {
    #[inline]
    fn next_1d(&mut self) -> f32 {
        forward!(self, sampler => sampler.next_1d())
    }

    #[inline]
    fn next_2d(&mut self) -> Vec2 {
        forward!(self, sampler => sampler.next_2d())
    }

    #[inline]
    fn dimension(&self) -> u32 {
        forward!(self, sampler => sampler.dimension())
    }

    #[inline]
    fn skip_to(&mut self, dimension: u32) {
        forward!(self, sampler => sampler.skip_to(dimension))
    }
}
