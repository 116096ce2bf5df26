//! A ray made ready for boxes and triangles.

use etalon_transport::Departure;
use glam::{Vec3, Vec3A};

/// Rays and geometry are nearer than this (m) to the origin of space, or not met.
pub(crate) const FARTHEST: f32 = 1e30;

/// No t, and no product of a coordinate and 1/d, is larger.
pub(crate) const FINITE: f32 = 1e37;

/// A ray with the quantities that intersection tests derive from it, in the space of one accelerator.
///
/// **Triangles** (Woop, Benthin & Wald 2013, "Watertight Ray/Triangle Intersection", JCGT 2(1)):
/// the largest component of the direction is the axis `k[2]`; shearing by `shear` along it takes
/// the ray to the axis itself. The sheared position of a corner does not depend on the triangle, so
/// triangles with a common edge agree on which side of it the ray passes.
///
/// **Boxes**: `t = plane · inverse − scaled_origin`, where both are conservative, see
/// [`TraversalRay::new`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct TraversalRay {
    pub(crate) origin: Vec3,
    pub(crate) direction: Vec3,
    /// Axes: two small ones, then the direction's largest.
    pub(crate) k: [usize; 3],
    /// The origin's coordinates along those axes.
    pub(crate) permuted: [f32; 3],
    /// d[k₀]/d[k₂], d[k₁]/d[k₂], 1/d[k₂].
    pub(crate) shear: [f32; 3],
    /// Triangles nearer than this (in t) are checked for rounding, see
    /// [`Block`](crate::accelerator::block::Block).
    pub(crate) near: f32,
    /// 1 for a negative direction, 0 otherwise, per axis.
    pub(crate) sign: [usize; 3],
    /// 1/d, finite.
    pub(crate) inverse: [f32; 3],
    /// (o + e)/d for the planes that are entered and (o − e)/d for those that are left.
    pub(crate) entered: [f32; 3],
    pub(crate) left: [f32; 3],
    /// The surface that the ray leaves.
    pub(crate) departure: Departure,
    /// The moment within the shutter interval.
    pub(crate) time: f32,
}

/// The axis along which a direction is largest.
#[inline(always)]
pub(crate) fn largest_axis(direction: Vec3) -> usize {
    let size = direction.abs();
    // Without branches: they would not be predictable.
    let beyond_x = !((size.x >= size.y) & (size.x >= size.z));
    let beyond_y = !(size.y >= size.z);
    usize::from(beyond_x) + usize::from(beyond_x & beyond_y)
}

/// The axes of a triangle test: two, then the largest.
#[inline(always)]
pub(crate) fn axes(largest: usize) -> [usize; 3] {
    [(largest + 1) % 3, (largest + 2) % 3, largest]
}

impl TraversalRay {
    /// Prepares a ray for geometry whose coordinates are all at most `extent` in magnitude.
    ///
    /// The triangle test errs by at most 2ε|p − o| in each coordinate of a corner. Every box is
    /// therefore widened by e = 4ε(extent + max|o|), which also covers the rounding of the box test
    /// itself. The relative error of 1/d is not included: the caller adds it to the far side. A
    /// component of the direction is never so small that t could overflow: e/d stays far beyond
    /// any scene, so a ray in the plane of a box's face is inside the box.
    #[inline(always)]
    pub(crate) fn new(origin: Vec3, direction: Vec3, extent: f32) -> Self {
        let d = direction.to_array();
        let [x, y, z] = axes(largest_axis(direction));
        let farthest = origin.abs().max_element();
        let reach = extent + farthest;
        let pad = 4.0 * f32::EPSILON * reach + f32::MIN_POSITIVE;
        let largest = Vec3A::splat((FINITE / reach).min(FINITE));
        let wide = Vec3A::from(direction);
        let inverse = wide.recip().clamp(-largest, largest);
        let outward = Vec3A::splat(pad).copysign(wide);
        let from = Vec3A::from(origin);
        let negative = wide.is_negative_bitmask();
        let sign = |axis: u32| (negative >> axis) as usize & 1;
        let o = origin.to_array();
        let mut probe = Self {
            origin,
            direction,
            k: [x, y, z],
            permuted: [o[x], o[y], o[z]],
            shear: (Vec3A::new(d[x], d[y], 1.0) / d[z]).to_array(),
            near: 256.0 * f32::EPSILON * farthest / d[z].abs(),
            sign: [sign(0), sign(1), sign(2)],
            inverse: inverse.to_array(),
            entered: ((from + outward) * inverse).to_array(),
            left: ((from - outward) * inverse).to_array(),
            departure: Departure::NONE,
            time: 0.0,
        };
        if !(reach < FARTHEST && direction.is_finite()) {
            // Enters every box at +∞ and leaves it at −∞: nothing is hit.
            probe.inverse = [1.0; 3];
            probe.entered = [f32::NEG_INFINITY; 3];
            probe.left = [f32::INFINITY; 3];
        }
        probe
    }
}
