//! A scattering model that may have lost its cosine.

use etalon_math::{Density, Frame, SolidAngle};
use etalon_transport::{Bsdf, BsdfSample, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// A scattering model that may have lost its cosine.
#[derive(Clone, Copy)]
pub struct FaultyBsdf<B> {
    pub(super) model: B,
    /// The normal whose cosine is missing.
    pub(super) missing: Option<Vec3>,
}

impl<B> FaultyBsdf<B> {
    fn without_cosine(&self, wi: Vec3, value: Vec4) -> Vec4 {
        match self.missing {
            Some(normal) => value / normal.dot(wi).abs().max(1e-3),
            None => value,
        }
    }
}

impl<B: Bsdf> Bsdf for FaultyBsdf<B> {
    fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Vec4 {
        self.without_cosine(wi, self.model.eval(wo, wi, mode))
    }

    fn density(&self, wo: Vec3, wi: Vec3) -> Density<SolidAngle> {
        self.model.density(wo, wi)
    }

    fn eval_and_density(
        &self,
        wo: Vec3,
        wi: Vec3,
        mode: TransportMode,
    ) -> (Vec4, Density<SolidAngle>) {
        let (value, density) = self.model.eval_and_density(wo, wi, mode);
        (self.without_cosine(wi, value), density)
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        let sample = self.model.sample(wo, u_lobe, u, mode)?;
        if sample.chance.is_delta() {
            return Some(sample);
        }
        Some(BsdfSample {
            value: self.without_cosine(sample.wi, sample.value),
            ..sample
        })
    }

    fn discrete(&self, wo: Vec3, index: u32, mode: TransportMode) -> Option<BsdfSample> {
        self.model.discrete(wo, index, mode)
    }

    fn has_continuous(&self) -> bool {
        self.model.has_continuous()
    }

    fn has_discrete(&self) -> bool {
        self.model.has_discrete()
    }

    fn hemisphere(&self) -> Option<Frame> {
        self.model.hemisphere()
    }

    fn null_transmittance(&self) -> Vec4 {
        self.model.null_transmittance()
    }

    fn null_probability(&self) -> Vec4 {
        self.model.null_probability()
    }

    fn albedo(&self, wo: Vec3) -> Vec4 {
        self.model.albedo(wo)
    }

    fn projected_area(&self, direction: Vec3) -> f32 {
        self.model.projected_area(direction)
    }
}
