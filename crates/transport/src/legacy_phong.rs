//! The classic Phong material at a point, as plain data.
//!
//! The model of Phong (1975) with the reflected and refracted light of Whitted (1980) is not a BSDF:
//! its ambient term needs no light, its highlight is neither reciprocal nor energy-conserving, and
//! its lights may lack the inverse-square law. It is defined for recursive ray tracing only, so it is
//! not a [`crate::Bsdf`] but the parameters returned by [`crate::Surfaces::legacy_phong`]. The
//! equation is in the documentation of the integrator `whitted`, which evaluates it.

use glam::{Vec3, Vec4};

/// A classic Phong material at a point. Spectra have one value per lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegacyPhong {
    /// Radiance that is there without light, kₐ times the ambient light (W·sr⁻¹·m⁻²·nm⁻¹).
    pub ambient: Vec4,
    /// k_d: diffuse coefficient.
    pub diffuse: Vec4,
    /// kₛ: the same for the middle of the highlight.
    pub specular: Vec4,
    /// k_g: the share of the light that comes from where a mirror would show it.
    pub global: Vec4,
    /// n: the exponent of the highlight.
    pub exponent: f32,
    /// α_t: the share of refracted light in what is seen; the rest is the surface's own.
    pub transparency: f32,
    /// Index of refraction of the side away from the normal over that of the other.
    pub eta: Vec4,
    /// Unit shading normal on the outside, after normal and bump maps.
    pub normal: Vec3,
    /// The share of the surface that is there; the rest lets light pass straight on.
    pub opacity: f32,
}
