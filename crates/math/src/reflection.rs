//! Mirror directions and half vectors.

use crate::lane::{Lane, Vector};
use glam::Vec3;

/// The mirror image of `wo` on the unit normal `m`; both leave the point.
#[inline(always)]
pub fn reflect<F: Lane, V: Vector<F>>(wo: V, m: V) -> V {
    m * (wo.dot_product(m) * 2.0) - wo
}

/// The unit vector half-way between two directions on one side, and the cosine to either; `None`
/// if they are opposite, both in the horizon.
#[inline]
pub fn half_way(wo: Vec3, wi: Vec3) -> Option<(Vec3, f32)> {
    let (found, m, cos) = half_vector::<f32>(wo, wi);
    found.then_some((m, cos))
}

/// The same in lanes; the first result says where it exists.
#[inline(always)]
pub fn half_vector<F: Lane>(wo: F::Vector, wi: F::Vector) -> (F::Mask, F::Vector, F) {
    let sum = wo + wi;
    let scale = F::ONE / sum.norm();
    let m = sum * scale;
    let cos = wo.dot_product(m);
    let found = scale.lt(F::splat(f32::INFINITY)) & cos.gt(F::ZERO);
    (found, m, cos)
}
