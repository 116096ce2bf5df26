//! The unit square and the unit disk, concentrically (Shirley & Chiu 1997).
//!
//! Concentric squares become concentric circles. With p = 2u − 1 and |pₓ| > |p_y|, the radius
//! is pₓ and the angle (π/4)·p_y/pₓ; otherwise the roles of the axes are exchanged.

use core::f32::consts::FRAC_1_PI;
use etalon_math::lane::{Int, Lane, Select, atan, sin_cos_turns};
use glam::Vec2;

/// The density of [`square_to_concentric_disk`] per unit of area, anywhere on the disk: 1/π.
pub const CONCENTRIC_DISK_DENSITY: f32 = FRAC_1_PI;

/// A point of the unit disk, uniform by area.
#[inline]
pub fn square_to_concentric_disk(u: Vec2) -> Vec2 {
    concentric_disk(u.to_array()).into()
}

/// [`square_to_concentric_disk`] in lanes.
#[inline(always)]
pub fn concentric_disk<F: Lane>(u: [F; 2]) -> [F; 2] {
    let (_, point) = square_to_polar(u);
    point
}

/// The signed radius of the point, in [−1, 1], and the point: the radius is exact, the point's
/// own length only up to rounding.
#[inline]
pub(super) fn square_to_polar<F: Lane>(u: [F; 2]) -> (F, [F; 2]) {
    let p = u.map(|u| u * 2.0 - 1.0);
    // Exchanged by bits: a branch would be guessed wrong half the time.
    let zeros = F::Int::splat(0);
    let tall = p[0].abs().le(p[1].abs()).select(!zeros, zeros);
    let [radius, lesser] = exchanged(p, tall);
    // The angle from the nearest axis, at most an eighth of a turn; at the centre, any.
    let ratio = Lane::eq(radius, F::ZERO).select(F::ZERO, lesser / radius);
    let (sin, cos) = sin_cos_turns(ratio * 0.125);
    (radius, exchanged([radius * cos, radius * sin], tall))
}

/// The two numbers, exchanged where `mask` is all ones rather than zero.
#[inline]
fn exchanged<F: Lane>(numbers: [F; 2], mask: F::Int) -> [F; 2] {
    let [a, b] = numbers.map(F::to_bits);
    let change = (a ^ b) & mask;
    [F::from_bits(a ^ change), F::from_bits(b ^ change)]
}

/// The point of the square that becomes `point`; the inverse of [`square_to_concentric_disk`].
#[inline]
pub fn concentric_disk_to_square(point: Vec2) -> Vec2 {
    polar_to_square(point.length(), point.to_array()).into()
}

/// As [`concentric_disk_to_square`] in lanes, with a distance from the centre that is more precise than that
/// of `point`, of which only the direction is used.
#[inline(always)]
pub(super) fn polar_to_square<F: Lane>(radius: F, [x, y]: [F; 2]) -> [F; 2] {
    let wide = y.abs().lt(x.abs());
    let (greater, lesser) = wide.select((x, y), (y, x));
    let centre = Lane::eq(greater, F::ZERO);
    let radius = radius.copysign(greater);
    let lesser = radius * (atan(lesser / greater) * (4.0 * FRAC_1_PI));
    let p = wide.select([radius, lesser], [lesser, radius]);
    centre.select([F::ZERO; 2], p).map(|p| (p + F::ONE) * 0.5)
}
