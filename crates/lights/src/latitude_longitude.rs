//! The latitude-longitude map between directions and the unit square, as Mitsuba has it.
//!
//! ```text
//! d = (sin φ sin θ, cos θ, −cos φ sin θ),   u = φ/2π,   v = θ/π
//! dω = 2π² sin θ du dv
//! ```
//!
//! The image's centre (u = ½) is seen along +Z, its upper border is +Y; u grows to the left of a
//! viewer who looks along +Z.

use core::f32::consts::{FRAC_1_PI, PI, TAU};
use etalon_math::float;
use glam::{Vec2, Vec3};

/// The place in the unit square of a unit direction; u in [0, 1).
#[inline]
pub fn to_square(direction: Vec3) -> Vec2 {
    let turns = float::atan2(direction.x, -direction.z) / TAU;
    // atan2 of the horizontal and vertical parts keeps its precision at the poles.
    let horizontal = Vec2::new(direction.x, direction.z).length();
    let theta = float::atan2(horizontal, direction.y);
    let u = turns - turns.floor();
    Vec2::new(if u < 1.0 { u } else { 0.0 }, theta * FRAC_1_PI)
}

/// The unit direction at a place of the unit square, and sin θ there.
#[inline]
pub fn to_direction(uv: Vec2) -> (Vec3, f32) {
    let (sin_phi, cos_phi) = float::sin_cos(TAU * uv.x);
    let (sin_theta, cos_theta) = float::sin_cos(PI * uv.y);
    let direction = Vec3::new(sin_phi * sin_theta, cos_theta, -cos_phi * sin_theta);
    (direction, sin_theta)
}

/// 2π² sin θ: solid angle per unit area of the square.
#[inline]
pub fn stretch(sin_theta: f32) -> f32 {
    2.0 * PI * PI * sin_theta
}
