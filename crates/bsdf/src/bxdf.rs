//! The contract of scattering models, in their local frame.

use etalon_math::Density;
use etalon_transport::{BsdfSample, SamplePdf, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// A scattering model with plain parameters, in the local frame whose z is the shading normal.
///
/// Evaluation cannot fail: directions at or below the horizon, or degenerate ones, give zero.
pub trait Bxdf: Copy {
    /// f(wo, wi)·|cos θi| of the continuous lobes (sr⁻¹), and the density per steradian with which
    /// [`Bxdf::sample`] finds the continuous direction `wi` — both per lane, and both zero for a
    /// direction that the other says cannot be.
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> (Vec4, Vec4);

    /// Samples a direction, as [`etalon_transport::Bsdf::sample`] but in the local frame.
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample>;

    /// The same, where continuous directions must follow their density and have their value: in mixtures, and where the normal is
    /// tilted. The discrete ones are those of [`Bxdf::sample`]. A model that does not sample by a walk keeps this.
    #[inline]
    fn sample_by_density(
        &self,
        wo: Vec3,
        u_lobe: f32,
        u: Vec2,
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        self.sample(wo, u_lobe, u, mode)
    }

    /// Whether [`Bxdf::sample`] finds continuous directions by a random walk: then only the mean of its value over its density is
    /// that of [`Bxdf::eval_and_density`], whose values are estimates, too. Most models have an equation, and keep this.
    #[inline]
    fn samples_by_walk(&self) -> bool {
        false
    }

    /// The sample of a continuous direction that was found; `None` where its density is 0 in the lane that chose.
    #[inline]
    fn continuous(&self, wo: Vec3, wi: Vec3, eta: f32, mode: TransportMode) -> Option<BsdfSample> {
        let (value, density) = self.eval_and_density(wo, wi, mode);
        (density.x > 0.0).then_some(BsdfSample {
            wi,
            value,
            chance: SamplePdf::Continuous(Density::per_lane(density)),
            eta,
            is_null: false,
        })
    }

    /// The discrete direction number `index`, as [`Bxdf::sample`] would sample it; `None` beyond
    /// the last. A model without any keeps this.
    #[inline]
    fn discrete(&self, _wo: Vec3, _index: u32, _mode: TransportMode) -> Option<BsdfSample> {
        None
    }

    /// Whether any lobe is continuous.
    fn has_continuous(&self) -> bool;

    /// Whether any lobe may be discrete.
    fn has_discrete(&self) -> bool;

    /// Whether a continuous lobe may lead to the other side; `true` is always right.
    fn transmits(&self) -> bool {
        true
    }

    /// What the `albedo` channel shows, as in Mitsuba, which may exceed 1: the reflectance of a diffuse base whichever
    /// side is seen; of other models the value toward the normal, times π; nothing of mirrors.
    fn albedo(&self, wo: Vec3) -> Vec4 {
        self.eval_and_density(wo, Vec3::Z, TransportMode::Radiance)
            .0
            * core::f32::consts::PI
    }
}
