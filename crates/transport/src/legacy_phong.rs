//! The classic Phong material: what it is at a point, as plain data.
//!
//! The model of Phong (1975) with the reflected and refracted light of Whitted (1980) is no BSDF:
//! its ambient term shines without light, its highlight is neither reciprocal nor bounded in
//! energy, and its light may refuse to fade with distance. It has a meaning to recursive ray
//! tracing only, so it is no [`crate::Bsdf`] but these numbers, which [`crate::Surfaces::legacy_phong`]
//! tells whoever can use them. The equation stands where it is evaluated, at the head of the
//! integrator `whitted`.

use glam::{Vec3, Vec4};

/// A classic Phong material at a point. Spectra have one value per lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegacyPhong {
    /// Radiance that is there without light, kₐ times the ambient light (W·sr⁻¹·m⁻²·nm⁻¹).
    pub ambient: Vec4,
    /// k_d: what a surface that faces a lamp shows of its light.
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
    /// Unit normal by which light and reflections go, outside: the shading normal, or what a map has made of it.
    pub normal: Vec3,
    /// The share of the surface that is there; the rest lets light pass straight on.
    pub opacity: f32,
}
