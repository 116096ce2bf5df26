//! How much light a smooth interface of dielectrics reflects.

/// Reflectance of a dielectric for unpolarised light (the mean of the two polarisations: Fresnel 1823; Born & Wolf 1999,
/// *Principles of Optics*, section 1.5), and the cosine of the refracted direction with the inverted
/// normal, for a direction with cosine `cos` (0 or more) and the index `eta` of the medium entered over that of the one
/// left (above 0). Under total reflection (1, 0).
#[inline]
pub fn dielectric(cos: f32, eta: f32) -> (f32, f32) {
    if eta == 1.0 {
        return (0.0, cos);
    }
    let cos_t2 = 1.0 - (1.0 - cos) * (1.0 + cos) / (eta * eta);
    if !(cos_t2 > 0.0) {
        return (1.0, 0.0);
    }
    let cos_t = cos_t2.sqrt();
    let s = (cos - eta * cos_t) / (cos + eta * cos_t);
    let p = (eta * cos - cos_t) / (eta * cos + cos_t);
    (0.5 * (s * s + p * p), cos_t)
}
