//! The distribution of Trowbridge & Reitz (1975), known as GGX (Walter et al. 2007).

use etalon_math::float;
use glam::{Vec2, Vec3};

/// G1 for α² tan² θ (Walter et al. 2007, eq. 34).
#[inline]
pub fn g1(roughness2: f32) -> f32 {
    2.0 / (1.0 + (1.0 + roughness2).sqrt())
}

/// Slopes for α = 1 as they are on the surface: tan² θ = u/(1 − u) (ibid., eq. 35).
#[inline]
pub fn sample_slopes(u: Vec2) -> Vec2 {
    let radius = (u.x / (1.0 - u.x)).sqrt();
    let (sin, cos) = float::sin_cos_turns(u.y);
    Vec2::new(cos, sin) * radius
}

/// A normal for α = 1 as seen from `v` (z > 0), not normalised: half-way between `v` and a
/// uniform point of the spherical cap z > −v.z (Dupuy & Benyoub 2023,
/// *Sampling Visible GGX Normals with Spherical Caps*).
#[inline]
pub fn sample_visible_normal(v: Vec3, u: Vec2) -> Vec3 {
    // z = 1 − u (1 + v.z), and sin² = (1 − z)(1 + z) without cancellation at the pole.
    let below = u.x * (1.0 + v.z);
    let z = 1.0 - below;
    let radius = float::safe_sqrt(below * (2.0 - below));
    let (sin, cos) = float::sin_cos_turns(u.y);
    Vec3::new(radius * cos, radius * sin, z) + v
}
