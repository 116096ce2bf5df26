//! A model that scatters as a script says: whatever is drawn, its direction is the next step of the path.

use etalon_math::{Density, Frame, SolidAngle};
use etalon_transport::{Bsdf, BsdfSample, SamplePdf, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// A model that scatters as the script says.
#[derive(Clone, Copy)]
pub(crate) struct Scripted<B> {
    pub(crate) model: B,
    pub(crate) wi: Option<Vec3>,
    pub(crate) sharp: bool,
}

/// Squared distance of unit vectors that are the same direction.
pub(crate) const SAME: f32 = 1e-10;

/// The discrete direction `wi`, if the first lane scatters that way.
pub(crate) fn discrete(
    model: &impl Bsdf,
    wo: Vec3,
    wi: Vec3,
    mode: TransportMode,
) -> Option<BsdfSample> {
    (0..)
        .map_while(|index| model.discrete(wo, index, mode))
        .find(|s| !s.is_null && s.chance.lanes().x > 0.0 && s.wi.distance_squared(wi) < SAME)
}

impl<B: Bsdf> Bsdf for Scripted<B> {
    fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Vec4 {
        self.model.eval(wo, wi, mode)
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
        self.model.eval_and_density(wo, wi, mode)
    }
    fn sample(&self, wo: Vec3, _: f32, _: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        let wi = self.wi?;
        if self.sharp {
            return discrete(&self.model, wo, wi, mode);
        }
        let density = self.model.density(wo, wi);
        (density.hero() > 0.0).then(|| BsdfSample {
            wi,
            value: self.model.eval(wo, wi, mode),
            chance: SamplePdf::Continuous(density),
            eta: 1.0,
            is_null: false,
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
