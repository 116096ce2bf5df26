//! Mirror and refracted directions about a microfacet's normal.

pub use etalon_math::reflection::{half_way, reflect};
use glam::Vec3;

/// The refracted direction for `wo` on the side of the unit normal `m`, the relative index `eta`
/// (medium entered over medium left) and the cosine `cos_t` that Fresnel's equations gave
/// (Snell's law in vector form). Brought to unit length: a large ratio of indices magnifies the
/// rounding of `wo`.
#[inline]
pub fn refract(wo: Vec3, m: Vec3, eta: f32, cos_t: f32) -> Vec3 {
    (m * (wo.dot(m) / eta - cos_t) - wo / eta).normalize()
}
