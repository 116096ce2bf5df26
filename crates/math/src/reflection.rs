//! Mirror directions and half vectors.

use glam::Vec3;

/// The mirror image of `wo` on the unit normal `m`; both leave the point.
#[inline]
pub fn reflect(wo: Vec3, m: Vec3) -> Vec3 {
    m * (2.0 * wo.dot(m)) - wo
}

/// The unit vector half-way between two directions on one side, and the cosine to either; `None`
/// if they are opposite, both in the horizon.
#[inline]
pub fn half_way(wo: Vec3, wi: Vec3) -> Option<(Vec3, f32)> {
    let m = (wo + wi).try_normalize()?;
    let cos = wo.dot(m);
    (cos > 0.0).then_some((m, cos))
}
