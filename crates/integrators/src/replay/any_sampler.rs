//! Any kind of sampler behind one type, where speed does not matter.

use etalon_sampling::{Independent, SampleId, Sampler, SamplerKind, Sobol, Stratified};
use glam::Vec2;

/// A sampler of any kind.
#[derive(Clone)]
pub(super) enum AnySampler {
    Independent(Independent),
    Sobol(Sobol),
    Stratified(Stratified),
}

macro_rules! each {
    ($self:ident, $sampler:ident => $answer:expr) => {
        match $self {
            Self::Independent($sampler) => $answer,
            Self::Sobol($sampler) => $answer,
            Self::Stratified($sampler) => $answer,
        }
    };
}

impl AnySampler {
    /// The sampler of one sample.
    pub(super) fn start(kind: SamplerKind, sample: &SampleId) -> Self {
        match kind {
            SamplerKind::Independent => Self::Independent(Independent::start(sample)),
            SamplerKind::Sobol => Self::Sobol(Sobol::start(sample)),
            SamplerKind::Stratified { jitter } => {
                Self::Stratified(Stratified::with_jitter(sample, jitter))
            }
        }
    }
}

impl Sampler for AnySampler {
    fn next_1d(&mut self) -> f32 {
        each!(self, sampler => sampler.next_1d())
    }

    fn next_2d(&mut self) -> Vec2 {
        each!(self, sampler => sampler.next_2d())
    }

    fn dimension(&self) -> u32 {
        each!(self, sampler => sampler.dimension())
    }

    fn skip_to(&mut self, dimension: u32) {
        each!(self, sampler => sampler.skip_to(dimension));
    }
}
