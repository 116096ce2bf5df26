//! The distribution of Trowbridge & Reitz (1975), known as GGX (Walter et al. 2007).

use etalon_math::lane::{Lane, Vector, sin_cos_turns};

/// G1 for α² tan² θ (Walter et al. 2007, eq. 34).
#[inline(always)]
pub fn g1<F: Lane>(roughness2: F) -> F {
    F::splat(2.0) / ((roughness2 + 1.0).sqrt() + 1.0)
}

/// Slopes for α = 1 as they are on the surface: tan² θ = u/(1 − u) (ibid., eq. 35).
#[inline(always)]
pub fn sample_slopes<F: Lane>([u, v]: [F; 2]) -> [F; 2] {
    let radius = (u / (F::ONE - u)).sqrt();
    let (sin, cos) = sin_cos_turns(v);
    [cos * radius, sin * radius]
}

/// A normal for α = 1 as seen from `from` (z > 0), not normalised: half-way between `from` and a
/// uniform point of the spherical cap z > −from.z (Dupuy & Benyoub 2023,
/// *Sampling Visible GGX Normals with Spherical Caps*).
#[inline(always)]
pub fn sample_visible_normal<F: Lane>(from: F::Vector, [u, v]: [F; 2]) -> F::Vector {
    // z = 1 − u (1 + from.z), and sin² = (1 − z)(1 + z) without cancellation at the pole.
    let below = u * (from.z() + 1.0);
    let z = F::ONE - below;
    let radius = (below * (F::splat(2.0) - below)).safe_sqrt();
    let (sin, cos) = sin_cos_turns(v);
    F::Vector::from_xyz(radius * cos, radius * sin, z) + from
}
