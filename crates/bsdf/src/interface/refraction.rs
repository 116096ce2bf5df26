//! Mirror and refracted directions about a microfacet's normal.

use etalon_math::lane::{Lane, Vector};
pub use etalon_math::reflection::{half_vector, half_way, reflect};

/// The refracted direction for `wo` on the side of the unit normal `m`, the relative index `eta`
/// (medium entered over medium left) and the cosine `cos_t` that Fresnel's equations gave
/// (Snell's law in vector form). Brought to unit length: a large ratio of indices magnifies the
/// rounding of `wo`.
#[inline(always)]
pub fn refract<F: Lane, V: Vector<F>>(wo: V, m: V, eta: F, cos_t: F) -> V {
    (m * (wo.dot_product(m) / eta - cos_t) - wo.over(eta)).normalized()
}
