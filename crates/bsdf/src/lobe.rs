//! One weighted lobe with its own frame.

use crate::{AnyBxdf, Bxdf};
use etalon_math::Frame;
use etalon_transport::{BsdfSample, SamplePdf, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// A model in its frame, with its share of the light.
#[derive(Clone, Copy, Debug)]
pub struct Lobe<'a> {
    /// The model.
    pub scatter: AnyBxdf<'a>,
    /// The frame of the model's local directions; `n` is the shading normal.
    pub frame: Frame,
    /// Factor of the model's value.
    pub weight: f32,
    /// The probability with which this lobe is chosen for sampling; the same for all lanes.
    pub probability: f32,
}

impl Lobe<'_> {
    /// Weighted value, and density times the probability of this lobe, for world directions.
    #[inline]
    pub fn eval_and_density(
        &self,
        normal: Vec3,
        wo: Vec3,
        wi: Vec3,
        mode: TransportMode,
    ) -> (Vec4, Vec4) {
        let (value, density) =
            self.scatter
                .eval_and_density(self.frame.to_local(wo), self.frame.to_local(wi), mode);
        let factor = match mode {
            TransportMode::Radiance => self.weight,
            TransportMode::Importance => self.weight * self.adjoint(normal, wo, wi),
        };
        (value * factor, density * self.probability)
    }

    /// A sampled world direction, as if this lobe were alone but weighted.
    #[inline]
    pub fn sample(
        &self,
        normal: Vec3,
        wo: Vec3,
        u_lobe: f32,
        u: Vec2,
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        let local = self
            .scatter
            .sample(self.frame.to_local(wo), u_lobe, u, mode)?;
        Some(self.in_world(normal, wo, mode, local))
    }

    /// The discrete direction number `index` of this lobe, weighted.
    pub fn discrete(
        &self,
        normal: Vec3,
        wo: Vec3,
        index: u32,
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        let local = self
            .scatter
            .discrete(self.frame.to_local(wo), index, mode)?;
        Some(self.in_world(normal, wo, mode, local))
    }

    #[inline]
    fn in_world(
        &self,
        normal: Vec3,
        wo: Vec3,
        mode: TransportMode,
        local: BsdfSample,
    ) -> BsdfSample {
        let wi = self.frame.to_world(local.wi);
        let factor = match mode {
            TransportMode::Radiance => self.weight,
            TransportMode::Importance => self.weight * self.adjoint(normal, wo, wi),
        };
        let chance = match local.chance {
            SamplePdf::Continuous(density) => SamplePdf::Continuous(density * self.probability),
            SamplePdf::Discrete(atom) => {
                SamplePdf::Discrete(etalon_math::DeltaProbability(atom.0 * self.probability))
            }
        };
        BsdfSample {
            wi,
            value: local.value * factor,
            chance,
            ..local
        }
    }

    /// The factor by which a shading normal makes importance scatter differently from radiance,
    /// |wo·nₛ| |wi·n_g| / (|wo·n_g| |wi·nₛ|) (Veach 1997, section 5.3, eq. 5.19): exactly 1
    /// where the two normals agree, zero where `wo` or `wi` is edge-on to within rounding.
    #[inline]
    fn adjoint(&self, normal: Vec3, wo: Vec3, wi: Vec3) -> f32 {
        let shading = self.frame.n;
        let (cos_o, cos_i) = (wo.dot(normal).abs(), wi.dot(shading).abs());
        if cos_o.min(cos_i) > f32::EPSILON {
            (wo.dot(shading) * wi.dot(normal)).abs() / (cos_o * cos_i)
        } else {
            0.0
        }
    }
}
