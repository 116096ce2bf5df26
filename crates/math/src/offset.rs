//! Where a ray that leaves a surface may safely start.
//!
//! A hit point is only known to within a box of half-widths `error`; a ray started inside that
//! box may hit the surface it leaves. The origin is therefore moved along the normal by the
//! box's extent in that direction, and by as much as rounding could take back (Pharr, Jakob,
//! Humphreys 2023, "Physically Based Rendering", 4th ed., section 6.8). No epsilon scaled by the scene.

use crate::lane::{Lane, Vector};
use glam::Vec3;

/// γₙ = n·ε / (1 − n·ε): the bound on the relative error of n rounded operations (Higham 2002),
/// with ε the unit round-off of f32 (2⁻²⁴).
#[inline]
pub const fn gamma(n: u32) -> f32 {
    const UNIT: f32 = f32::EPSILON * 0.5;
    let x = n as f32 * UNIT;
    x / (1.0 - x)
}

/// A start for a ray along `direction` out of the surface point `position`, known to within
/// ±`error` in each coordinate, on a surface with unit geometric `normal` (either side).
#[inline]
pub fn offset_origin(position: Vec3, error: Vec3, normal: Vec3, direction: Vec3) -> Vec3 {
    offset_origins::<f32>(position, error, normal, direction)
}

/// The same in lanes.
#[inline(always)]
pub fn offset_origins<F: Lane>(
    position: F::Vector,
    error: F::Vector,
    normal: F::Vector,
    direction: F::Vector,
) -> F::Vector {
    // |p|·ε covers the rounding of the sum below, twice over.
    let reach = error + position.magnitudes() * F::splat(f32::EPSILON);
    let distance = normal.magnitudes().dot_product(reach);
    position + normal * distance.copysign(direction.dot_product(normal))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn origin_leaves_the_error_box_on_the_side_of_the_ray() {
        let p = Vec3::new(1000.0, -3.0, 1e-3);
        let error = Vec3::new(1e-3, 1e-5, 1e-6);
        let n = Vec3::new(1.0, 2.0, -2.0) / 3.0;
        for direction in [n, -n] {
            let o = offset_origin(p, error, n, direction);
            // The farthest corner of the box along the ray's side of the plane.
            let extent = n.abs().dot(error);
            assert!((o - p).dot(direction) >= extent * 0.999);
        }
    }
}
