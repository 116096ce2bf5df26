//! The density or discrete probability of a sampled event.

use etalon_math::{DeltaProbability, Density, SolidAngle};
use glam::Vec4;

/// The density of a sampled direction, or the probability of a discrete one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SamplePdf {
    /// One of a continuum of directions.
    Continuous(Density<SolidAngle>),
    /// A direction that has a probability of its own (a mirror's, a point light's).
    Discrete(DeltaProbability),
}

impl SamplePdf {
    /// The per-lane values without their measure. Ratios between lanes are meaningful for both kinds;
    /// comparisons between kinds are not.
    #[inline]
    pub fn lanes(self) -> Vec4 {
        match self {
            Self::Continuous(density) => density.lanes(),
            Self::Discrete(atom) => atom.0,
        }
    }

    /// The density times the probability of an earlier choice.
    #[inline]
    #[must_use]
    pub fn scaled(self, probability: f32) -> Self {
        match self {
            Self::Continuous(density) => Self::Continuous(density * probability),
            Self::Discrete(atom) => Self::Discrete(DeltaProbability(atom.0 * probability)),
        }
    }

    /// Whether the direction is discrete.
    #[inline]
    pub fn is_delta(self) -> bool {
        matches!(self, Self::Discrete(_))
    }
}
