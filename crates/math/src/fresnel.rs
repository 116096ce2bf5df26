//! How much light a smooth interface of dielectrics reflects.

use crate::lane::{Lane, Select};

/// Reflectance of a dielectric for unpolarised light (the mean of the two polarisations: Fresnel 1823; Born & Wolf 1999,
/// *Principles of Optics*, section 1.5), and the cosine of the refracted direction with the inverted
/// normal, for a direction with cosine `cos` (0 or more) and the index `eta` of the medium entered over that of the one
/// left (above 0). Under total reflection (1, 0).
#[inline(always)]
pub fn dielectric<F: Lane>(cos: F, eta: F) -> (F, F) {
    let cos_t2 = F::ONE - (F::ONE - cos) * (cos + 1.0) / (eta * eta);
    let cos_t = cos_t2.sqrt();
    let s = (cos - eta * cos_t) / (cos + eta * cos_t);
    let p = (eta * cos - cos_t) / (eta * cos + cos_t);
    let refracted = ((s * s + p * p) * 0.5, cos_t);
    let absent = Lane::eq(eta, F::ONE);
    let found = cos_t2.gt(F::ZERO).select(refracted, (F::ONE, F::ZERO));
    absent.select((F::ZERO, cos), found)
}
