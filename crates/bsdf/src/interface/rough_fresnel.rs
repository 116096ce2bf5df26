//! Fresnel reflectance and transmittance of a rough dielectric interface.
//!
//! ```text
//! T(θ) = ∫ visible(w, m) (1 − F(w·m)) G1(w_t, m) dm      w_t = refraction of w about m
//! R(θ) = ∫ visible(w, m)      F(w·m)  G1(w_r, m) dm      w_r = reflection of w about m
//! ```
//!
//! The integrals run over the unit square that the visible normals are sampled from, by
//! Gauss–Legendre quadrature, over half of it by symmetry. Single scattering only, so R + T < 1
//! for rough interfaces.

use crate::interface::fresnel;
use crate::interface::refraction::{reflect, refract};
use crate::microfacet::Microfacet;
use crate::quadrature::gauss_legendre;
use etalon_math::lane::{Int, Lane};
use glam::Vec3;

/// Number of cosines at which the transmittance is tabulated, equally spaced over [0, 1].
pub const COSINES: usize = 64;

/// Quadrature nodes across the square; half as many along the dimension that is symmetric.
const NODES: usize = 48;

/// The quantities of its coating that `roughplastic` needs.
#[derive(Clone, Debug)]
pub struct RoughFresnel {
    transmittance: [f32; COSINES],
    /// The share of diffuse light inside that the coat reflects back.
    pub internal: f32,
}

impl RoughFresnel {
    /// Tabulates the coat of relative index `eta` with isotropic roughness.
    ///
    /// The internal reflectance is 2·mean(R(θ) cos θ) over the table's cosines, both ends
    /// included at full weight: the integral's value within 1.5 %, and exactly what Mitsuba 3
    /// computes, so that diffuse energy agrees with it.
    pub fn new(microfacet: Microfacet, eta: f32) -> Self {
        let microfacet = Microfacet {
            sample_visible: true,
            ..microfacet
        };
        let mut transmittance = [0.0; COSINES];
        let mut internal = 0.0;
        for (i, entry) in transmittance.iter_mut().enumerate() {
            let cos = (i as f32 / (COSINES - 1) as f32).max(1e-6);
            let w = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
            let normals = visible_normals(&microfacet, w, NODES);
            *entry = mean(&normals, w, |m, cos_m| {
                transmitted(&microfacet, w, m, cos_m, eta)
            }) as f32;
            let reflectance = mean(&normals, w, |m, cos_m| {
                reflected(&microfacet, w, m, cos_m, eta.recip())
            });
            internal += 2.0 * reflectance * f64::from(cos) / COSINES as f64;
        }
        Self {
            transmittance,
            internal: internal as f32,
        }
    }

    /// T of each lane's coat at the cosine `cos` in [0, 1], linear between the table's entries.
    #[inline(always)]
    pub fn transmittance<F: Lane>(coats: F::Array<&Self>, cos: F) -> F {
        let x = cos.clamp(0.0, 1.0) * (COSINES - 1) as f32;
        let before = x.floor().min(F::splat((COSINES - 2) as f32));
        let (t, index) = (x - before, before.to_int());
        let entry = |next: usize| {
            F::from_fn(|i| coats.as_ref()[i].transmittance[index.lane(i) as usize + next])
        };
        entry(0) * (F::ONE - t) + entry(1) * t
    }
}

/// (1 − F) G1 of the refracted direction.
fn transmitted(microfacet: &Microfacet, w: Vec3, m: Vec3, cos: f32, eta: f32) -> f32 {
    let (f, cos_t) = fresnel::dielectric(cos, eta);
    let through = refract(w, m, eta, cos_t);
    if through.z < 0.0 {
        (1.0 - f) * microfacet.g1(through, m)
    } else {
        0.0
    }
}

/// F G1 of the reflected direction.
fn reflected(microfacet: &Microfacet, w: Vec3, m: Vec3, cos: f32, eta: f32) -> f32 {
    let back = reflect(w, m);
    if back.z > 0.0 {
        fresnel::dielectric(cos, eta).0 * microfacet.g1(back, m)
    } else {
        0.0
    }
}

/// Normals visible from `w` in the xz plane with the weights of their quadrature, which sum to 1.
fn visible_normals(microfacet: &Microfacet, w: Vec3, nodes: usize) -> Vec<(Vec3, f64)> {
    let across = gauss_legendre(nodes);
    let along: Vec<(f64, f64)> = gauss_legendre(nodes / 2)
        .into_iter()
        .map(|(y, weight)| (0.5 * y, weight))
        .collect();
    let mut normals = Vec::with_capacity(across.len() * along.len());
    for &(x, weight_x) in &across {
        for &(y, weight_y) in &along {
            let m = microfacet.sample(w, [x as f32, y as f32]);
            normals.push((m, weight_x * weight_y));
        }
    }
    normals
}

/// The mean of `f(m, w·m)` over normals visible from `w`.
fn mean(normals: &[(Vec3, f64)], w: Vec3, f: impl Fn(Vec3, f32) -> f32) -> f64 {
    normals
        .iter()
        .map(|&(m, weight)| (m, w.dot(m), weight))
        .filter(|(_, cos, _)| *cos > 0.0)
        .map(|(m, cos, weight)| weight * f64::from(f(m, cos)))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::microfacet::Kind;
    use glam::Vec2;

    #[test]
    fn smooth_limit_is_fresnel() {
        let coat = RoughFresnel::new(Microfacet::new(Kind::Ggx, Vec2::splat(1e-4), true), 1.5);
        for i in [5, 20, 40, 63] {
            let cos = i as f32 / 63.0;
            let smooth = 1.0 - fresnel::dielectric(cos, 1.5).0;
            assert!(
                (RoughFresnel::transmittance([&coat], cos) - smooth).abs() < 1e-4,
                "{i}"
            );
        }
    }

    #[test]
    fn more_nodes_change_little() {
        for kind in [Kind::Beckmann, Kind::Ggx] {
            for alpha in [0.05, 0.1, 0.5] {
                let microfacet = Microfacet::new(kind, Vec2::splat(alpha), true);
                for cos in [0.05f32, 0.3, 0.7, 1.0] {
                    let w = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
                    let both = |nodes| {
                        let normals = visible_normals(&microfacet, w, nodes);
                        [
                            mean(&normals, w, |m, c| transmitted(&microfacet, w, m, c, 1.5)),
                            mean(&normals, w, |m, c| {
                                reflected(&microfacet, w, m, c, 1.0 / 1.5)
                            }),
                        ]
                    };
                    let ([t, r], [exact_t, exact_r]) = (both(NODES), both(256));
                    assert!(
                        (t - exact_t).abs() < 1e-3,
                        "{kind:?} {alpha} {cos}: {t} {exact_t}"
                    );
                    // Total reflection begins with an infinite slope.
                    assert!(
                        (r - exact_r).abs() < 3e-3,
                        "{kind:?} {alpha} {cos}: {r} {exact_r}"
                    );
                }
            }
        }
    }
}
