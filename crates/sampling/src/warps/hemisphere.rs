//! The hemisphere about +z, with density proportional to the cosine:
//! p(ω) = cos θ / π (Malley's method: a disk, uniform by area, lifted to the hemisphere).

use super::disk::{concentric_disk_to_square, square_to_polar};
use core::f32::consts::FRAC_1_PI;
use etalon_math::lane::{Lane, Vector};
use glam::{Vec2, Vec3};

/// The least cosine that [`square_to_cosine_hemisphere`] returns, 2⁻¹². The rim of the disk, at
/// the resolution of its 24-bit radius, covers cosines up to 5·10⁻⁴. Without the bound the
/// cosine would be 0, and so would the density of a sampled direction. The direction's length
/// changes by less than one rounding.
const LEAST_COSINE: f32 = 1.0 / 4096.0;

/// A unit direction with density cos θ / π; its z is always positive.
#[inline]
pub fn square_to_cosine_hemisphere(u: Vec2) -> Vec3 {
    cosine_hemisphere(u.to_array())
}

/// The same in lanes.
#[inline(always)]
pub fn cosine_hemisphere<F: Lane>(u: [F; 2]) -> F::Vector {
    let (radius, [x, y]) = square_to_polar(u);
    let z = ((F::ONE - radius) * (F::ONE + radius)).sqrt();
    F::Vector::from_xyz(x, y, z.max(F::splat(LEAST_COSINE)))
}

/// The inverse of [`square_to_cosine_hemisphere`], for a unit direction.
#[inline]
pub fn cosine_hemisphere_to_square(direction: Vec3) -> Vec2 {
    concentric_disk_to_square(direction.truncate())
}

/// The density of [`square_to_cosine_hemisphere`] per steradian at a direction with the given
/// cosine; zero below the horizon.
#[inline]
pub fn cosine_hemisphere_density(cos_theta: f32) -> f32 {
    cosine_density(cos_theta)
}

/// The same in lanes.
#[inline(always)]
pub fn cosine_density<F: Lane>(cos_theta: F) -> F {
    cos_theta.max(F::ZERO) * FRAC_1_PI
}
