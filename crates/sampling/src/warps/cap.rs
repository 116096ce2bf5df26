//! Cones of directions about +z, uniform by solid angle: any cap of the sphere, the hemisphere
//! and the whole sphere.
//!
//! Lambert's equal-area projection takes the disk to the cap: with r the distance from the
//! disk's centre and m = 1 − cos θₘₐₓ,
//!
//! ```text
//! 1 − cos θ = r² m,     p(ω) = 1 / (2π m)
//! ```
//!
//! A cone is given by m rather than by its cosine, which in single precision cannot tell
//! cones narrower than 0.02° from a line.

use super::disk::{polar_to_square, square_to_polar};
use core::f32::consts::{FRAC_1_PI, TAU};
use etalon_math::lane::{Lane, Select, Vector};
use glam::{Vec2, Vec3};

/// The density of [`square_to_uniform_hemisphere`] per steradian, above the horizon: 1/(2π).
pub const UNIFORM_HEMISPHERE_DENSITY: f32 = 0.5 * FRAC_1_PI;

/// The density of [`square_to_uniform_sphere`] per steradian: 1/(4π).
pub const UNIFORM_SPHERE_DENSITY: f32 = 0.25 * FRAC_1_PI;

/// A unit direction, uniform in the cone of all directions with
/// 1 − cos θ ≤ `one_minus_cos_max` ∈ (0, 2].
#[inline]
pub fn square_to_uniform_cone(u: Vec2, one_minus_cos_max: f32) -> Vec3 {
    uniform_cone::<f32>(u.to_array(), one_minus_cos_max)
}

/// The same in lanes.
#[inline(always)]
fn uniform_cone<F: Lane>(u: [F; 2], one_minus_cos_max: F) -> F::Vector {
    let (radius, [x, y]) = square_to_polar(u);
    let one_minus_cos = radius * radius * one_minus_cos_max;
    // sin θ / r, since sin² θ = (1 − cos θ)(1 + cos θ).
    let scale = (one_minus_cos_max * (F::splat(2.0) - one_minus_cos)).sqrt();
    F::Vector::from_xyz(x * scale, y * scale, F::ONE - one_minus_cos)
}

/// The inverse of [`square_to_uniform_cone`], for a unit direction inside the cone.
#[inline]
pub fn uniform_cone_to_square(direction: Vec3, one_minus_cos_max: f32) -> Vec2 {
    cone_to_square::<f32>(direction, one_minus_cos_max).into()
}

/// The same in lanes.
#[inline(always)]
fn cone_to_square<F: Lane>(direction: F::Vector, one_minus_cos_max: F) -> [F; 2] {
    let [x, y, z] = direction.xyz();
    let above = (x * x + y * y) / (F::ONE + z);
    let one_minus_cos = z.gt(F::ZERO).select(above, F::ONE - z);
    let radius = (one_minus_cos / one_minus_cos_max).sqrt().min(F::ONE);
    polar_to_square(radius, [x, y])
}

/// The density of [`square_to_uniform_cone`] per steradian, inside the cone:
/// 1/(2π `one_minus_cos_max`).
#[inline]
pub fn uniform_cone_density(one_minus_cos_max: f32) -> f32 {
    1.0 / (TAU * one_minus_cos_max)
}

/// A unit direction, uniform over the hemisphere z ≥ 0.
#[inline]
pub fn square_to_uniform_hemisphere(u: Vec2) -> Vec3 {
    square_to_uniform_cone(u, 1.0)
}

/// The inverse of [`square_to_uniform_hemisphere`].
#[inline]
pub fn uniform_hemisphere_to_square(direction: Vec3) -> Vec2 {
    uniform_cone_to_square(direction, 1.0)
}

/// A unit direction, uniform over the sphere. The centre of the square becomes +z, its border −z.
#[inline]
pub fn square_to_uniform_sphere(u: Vec2) -> Vec3 {
    uniform_sphere::<f32>(u.to_array())
}

/// The same in lanes.
#[inline(always)]
pub fn uniform_sphere<F: Lane>(u: [F; 2]) -> F::Vector {
    uniform_cone(u, F::splat(2.0))
}

/// The inverse of [`square_to_uniform_sphere`].
#[inline]
pub fn uniform_sphere_to_square(direction: Vec3) -> Vec2 {
    sphere_to_square::<f32>(direction).into()
}

/// The same in lanes.
#[inline(always)]
pub fn sphere_to_square<F: Lane>(direction: F::Vector) -> [F; 2] {
    cone_to_square(direction, F::splat(2.0))
}
