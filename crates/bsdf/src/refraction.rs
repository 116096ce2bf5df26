//! Mirror and refracted directions about a microfacet's normal.

use glam::Vec3;

/// The mirror image of `wo` about the unit normal `m`.
#[inline]
pub fn reflect(wo: Vec3, m: Vec3) -> Vec3 {
    m * (2.0 * wo.dot(m)) - wo
}

/// The refracted direction for `wo` on the side of the unit normal `m`, the relative index `eta`
/// (medium entered over medium left) and the cosine `cos_t` that Fresnel's equations gave
/// (Snell's law in vector form). Brought to unit length: a large ratio of indices magnifies the
/// rounding of `wo`.
#[inline]
pub fn refract(wo: Vec3, m: Vec3, eta: f32, cos_t: f32) -> Vec3 {
    (m * (wo.dot(m) / eta - cos_t) - wo / eta).normalize()
}

/// The unit vector half-way between two directions on one side, and the cosine to either; `None`
/// if they are opposite, both in the horizon.
#[inline]
pub fn half_way(wo: Vec3, wi: Vec3) -> Option<(Vec3, f32)> {
    let m = (wo + wi).try_normalize()?;
    let cos = wo.dot(m);
    (cos > 0.0).then_some((m, cos))
}
