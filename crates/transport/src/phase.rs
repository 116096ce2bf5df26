//! The contract of a phase function: how a point of a medium scatters light.

use etalon_math::{Density, SolidAngle};
use glam::{Vec2, Vec3, Vec4};

/// A sampled direction.
#[derive(Clone, Copy, Debug)]
pub struct PhaseSample {
    /// The sampled direction (unit, leaving the point).
    pub wi: Vec3,
    /// The phase function there (sr⁻¹), per lane.
    pub value: Vec4,
    /// Its density.
    pub density: Density<SolidAngle>,
}

/// A phase function: scattered radiance per unit of incident irradiance, normalised so that its
/// integral over `wi` is one. Both directions leave the point, so light that goes straight on has
/// `wi = −wo`.
pub trait Phase {
    /// p(wo, wi) in sr⁻¹, per lane.
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec4;

    /// The density with which [`Phase::sample`] finds `wi`.
    fn density(&self, wo: Vec3, wi: Vec3) -> Density<SolidAngle>;

    /// Samples a direction with `u` uniform in [0, 1)².
    fn sample(&self, wo: Vec3, u: Vec2) -> PhaseSample;

    /// Factor on the extinction for light along `direction`: the projected area of oriented flakes (SGGX), else 1.
    /// [`crate::Medium::coefficients`] include it.
    #[inline]
    fn projected_area(&self, _direction: Vec3) -> f32 {
        1.0
    }
}
