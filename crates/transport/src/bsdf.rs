//! The contract of a scattering model at a point.

use crate::SamplePdf;
use etalon_math::{Density, Frame, SolidAngle};
use glam::{Vec2, Vec3, Vec4};

/// What is being transported: radiance (paths from the camera) or importance (paths from the
/// lights). Only refraction tells them apart: radiance is compressed by η² (Veach 1997,
/// section 5.2), and so does a shading normal (ibid. 5.3).
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
    /// Whether the ray goes straight on as if the surface were not there (`null`, `mask`).
    pub is_null: bool,
}

/// A scattering model at a point: plain data that knows neither textures nor scene.
///
/// Directions are in world space. Evaluation cannot fail. No question has a default answer, so that a model that wraps another
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

    /// Samples a direction; `None` if the light is absorbed. Lane 0 of the wavelengths for
    /// which the model was made chooses; `u_lobe` and `u` are uniform in [0, 1). Light passes straight on
    /// if `u_lobe` is below the chooser's [`Bsdf::null_probability`], and only then.
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample>;

    /// The discrete direction number `index`, as [`Bsdf::sample`] would sample it (what passes
    /// straight on counts too); `None` beyond the last. There are as many whichever lane chooses:
    /// one that lane 0 does not have has value and probability zero. For estimators that follow
    /// every direction instead of choosing.
    fn discrete(&self, wo: Vec3, index: u32, mode: TransportMode) -> Option<BsdfSample>;

    /// Whether any lobe is continuous, i.e. whether light sampling can help.
    fn has_continuous(&self) -> bool;

    /// Whether any lobe may be discrete, passing straight on aside. `true` is always right, for
    /// those who need to know which directions [`Bsdf::eval`] cannot speak of.
    fn has_discrete(&self) -> bool;

    /// The frame about whose normal all continuous directions `wi` lie on the same side as `wo`;
    /// `None`, which is always right, if they may be anywhere.
    fn hemisphere(&self) -> Option<Frame>;

    /// The fraction of light that goes straight on as if the surface were not there.
    fn null_transmittance(&self) -> Vec4;

    /// The probability with which [`Bsdf::sample`] passes straight on, per lane.
    fn null_probability(&self) -> Vec4;

    /// Directional albedo or an approximation of it: for the `albedo` channel, and for choices that no
    /// expectation depends on (Russian roulette).
    fn albedo(&self, wo: Vec3) -> Vec4;

    /// The factor on the extinction of oriented particles for light along `direction` (see [`crate::Phase::projected_area`]); 1 on
    /// surfaces.
    fn projected_area(&self, direction: Vec3) -> f32;
}
