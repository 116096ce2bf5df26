//! A perfect mirror on both sides, times a factor: the reflection of models whose refraction is a null
//! interaction.

use crate::Bxdf;
use crate::interface::refraction::reflect;
use etalon_math::DeltaProbability;
use etalon_transport::{BsdfSample, SamplePdf, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// Reflects a fraction of the light, independent of direction.
#[derive(Clone, Copy, Debug)]
pub struct Mirror {
    /// The fraction, per lane.
    pub reflectance: Vec4,
}

impl Bxdf for Mirror {
    fn eval_and_density(&self, _: Vec3, _: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        (Vec4::ZERO, Vec4::ZERO)
    }

    fn sample(&self, wo: Vec3, _: f32, _: Vec2, _: TransportMode) -> Option<BsdfSample> {
        Some(BsdfSample {
            wi: reflect(wo, Vec3::Z),
            value: self.reflectance,
            chance: SamplePdf::Discrete(DeltaProbability::uniform(1.0)),
            eta: 1.0,
            is_null: false,
        })
    }

    fn discrete(&self, wo: Vec3, index: u32, mode: TransportMode) -> Option<BsdfSample> {
        (index == 0)
            .then(|| self.sample(wo, 0.0, Vec2::ZERO, mode))
            .flatten()
    }

    fn has_continuous(&self) -> bool {
        false
    }

    fn has_discrete(&self) -> bool {
        true
    }
}
