//! The samplers that claims may name.

use etalon_sampling::SamplerKind;
use serde::Deserialize;

/// The kinds of samplers claims may name.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Sampler {
    /// Pseudo-random numbers.
    Independent,
    /// Jittered strata.
    Stratified,
    /// The midpoints of strata (`stratified` without `jitter`): the same numbers in every
    /// replicate and another order, so that what one coordinate alone decides has no noise.
    Midpoints,
    /// Scrambled Sobol' points.
    Sobol,
}

impl Sampler {
    /// As claims and reports spell it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Stratified => "stratified",
            Self::Midpoints => "midpoints",
            Self::Sobol => "sobol",
        }
    }
}

impl From<Sampler> for SamplerKind {
    fn from(sampler: Sampler) -> Self {
        match sampler {
            Sampler::Independent => Self::Independent,
            Sampler::Stratified => Self::Stratified { jitter: true },
            Sampler::Midpoints => Self::Stratified { jitter: false },
            Sampler::Sobol => Self::Sobol,
        }
    }
}
