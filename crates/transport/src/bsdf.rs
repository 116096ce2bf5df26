//! The contract of a scattering model at a point.

use crate::SamplePdf;
use etalon_math::{Density, Frame, SolidAngle};
use glam::{Vec2, Vec3, Vec4};

/// The transported quantity: radiance (paths from the camera) or importance (paths from the
/// lights). They differ under refraction, where radiance scales by η² (Veach 1997, section 5.2),
/// and with shading normals (ibid. 5.3).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransportMode {
    /// `wi` points to where light comes from.
    Radiance,
    /// `wi` points to where light goes; `wo` to where it comes from.
    Importance,
}

/// A sampled direction.
#[derive(Clone, Copy, Debug)]
pub struct BsdfSample {
    /// The sampled direction (unit, leaving the point).
    pub wi: Vec3,
    /// f(wo, wi)·|cos θi| of *all* continuous lobes together if `chance` is continuous; the
    /// energy carried by the sampled discrete direction if it is discrete.
    pub value: Vec4,
    /// Density of `wi` under all continuous lobes together, or probability of the discrete one,
    /// for each lane had it been the one that chose.
    pub chance: SamplePdf,
    /// η of the medium entered over that of the medium left (1 for reflection).
    pub eta: f32,
    /// Whether the surface is passed as if it were not there (`null`, `mask`).
    pub is_null: bool,
}

/// A scattering model at a point: plain data that knows neither textures nor scene.
///
/// Directions are in world space. Evaluation cannot fail. No method has a default body, so that a model that wraps another
/// cannot forget one.
pub trait Bsdf {
    /// f(wo, wi)·|cos θi| of the continuous lobes (sr⁻¹), per lane.
    fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Vec4;

    /// The density with which [`Bsdf::sample`] finds the continuous direction `wi`. Includes
    /// the probability of choosing a continuous lobe at all.
    fn density(&self, wo: Vec3, wi: Vec3) -> Density<SolidAngle>;

    /// [`Bsdf::eval`] and [`Bsdf::density`] together.
    fn eval_and_density(
        &self,
        wo: Vec3,
        wi: Vec3,
        mode: TransportMode,
    ) -> (Vec4, Density<SolidAngle>);

    /// Samples a direction; `None` if the light is absorbed. Lane 0 of the model's wavelengths
    /// chooses; `u_lobe` and `u` are uniform in [0, 1). The result is the null interaction if and only if
    /// `u_lobe` is below lane 0 of [`Bsdf::null_probability`].
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample>;

    /// The discrete direction number `index` as [`Bsdf::sample`] would return it, the null interaction
    /// included; `None` beyond the last. The count does not depend on the choosing lane: a direction
    /// that lane 0 lacks has value and probability zero. For estimators that follow every direction
    /// instead of choosing one.
    fn discrete(&self, wo: Vec3, index: u32, mode: TransportMode) -> Option<BsdfSample>;

    /// Whether any lobe is continuous, i.e. whether light sampling can help.
    fn has_continuous(&self) -> bool;

    /// Whether any lobe other than the null interaction may be discrete, so that [`Bsdf::eval`] misses
    /// part of the scattering. `true` is a safe answer.
    fn has_discrete(&self) -> bool;

    /// The frame about whose normal all continuous directions `wi` lie on the same side as `wo`;
    /// `None` if they may be anywhere, which is a safe answer.
    fn hemisphere(&self) -> Option<Frame>;

    /// The fraction of light that passes as if the surface were not there, per lane.
    fn null_transmittance(&self) -> Vec4;

    /// The probability of the null interaction in [`Bsdf::sample`], per lane.
    fn null_probability(&self) -> Vec4;

    /// Directional albedo or an approximation of it: for the `albedo` channel, and for choices that no
    /// expectation depends on (Russian roulette).
    fn albedo(&self, wo: Vec3) -> Vec4;

    /// The factor on the extinction of oriented particles for light along `direction` (see [`crate::Phase::projected_area`]); 1 on
    /// surfaces.
    fn projected_area(&self, direction: Vec3) -> f32;
}
