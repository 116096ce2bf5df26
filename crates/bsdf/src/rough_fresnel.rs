//! Fresnel reflectance and transmittance of a rough dielectric interface.
//!
//! ```text
//! T(θ) = ∫ visible(w, m) (1 − F(w·m)) G1(w_t, m) dm      w_t = refraction of w about m
//! R(θ) = ∫ visible(w, m)      F(w·m)  G1(w_r, m) dm      w_r = reflection of w about m
//! ```
//!
//! The integrals run over the unit square that the visible normals are sampled from, by
//! Gauss–Legendre quadrature. Single scattering only, so R + T < 1 for rough interfaces.

use crate::fresnel;
use crate::microfacet::Microfacet;
use crate::refraction::{reflect, refract};
use etalon_math::float64;
use glam::{Vec2, Vec3};

/// Number of cosines at which the transmittance is tabulated, equally spaced over [0, 1].
pub const COSINES: usize = 64;

/// Quadrature nodes per dimension.
const NODES: usize = 32;

/// What `roughplastic` must know of its coat.
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
        let nodes = gauss_legendre(NODES);
        let mut transmittance = [0.0; COSINES];
        let mut internal = 0.0;
        for (i, entry) in transmittance.iter_mut().enumerate() {
            let cos = (i as f32 / (COSINES - 1) as f32).max(1e-6);
            let w = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
            *entry = integrate(&microfacet, w, &nodes, |m, cos_m| {
                let (f, cos_t) = fresnel::dielectric(cos_m, eta);
                let through = refract(w, m, eta, cos_t);
                if through.z < 0.0 {
                    (1.0 - f) * microfacet.g1(through, m)
                } else {
                    0.0
                }
            }) as f32;
            let reflectance = integrate(&microfacet, w, &nodes, |m, cos_m| {
                let back = reflect(w, m);
                if back.z > 0.0 {
                    fresnel::dielectric(cos_m, eta.recip()).0 * microfacet.g1(back, m)
                } else {
                    0.0
                }
            });
            internal += 2.0 * reflectance * f64::from(cos) / COSINES as f64;
        }
        Self {
            transmittance,
            internal: internal as f32,
        }
    }

    /// T at the cosine `cos` in [0, 1], linear between the table's entries.
    #[inline]
    pub fn transmittance(&self, cos: f32) -> f32 {
        let x = cos.clamp(0.0, 1.0) * (COSINES - 1) as f32;
        let i = (x as usize).min(COSINES - 2);
        let t = x - i as f32;
        self.transmittance[i] * (1.0 - t) + self.transmittance[i + 1] * t
    }
}

/// The mean of `f(m, w·m)` over the normals visible from `w`.
fn integrate(
    microfacet: &Microfacet,
    w: Vec3,
    nodes: &[(f64, f64)],
    f: impl Fn(Vec3, f32) -> f32,
) -> f64 {
    let mut sum = 0.0;
    for &(x, weight_x) in nodes {
        for &(y, weight_y) in nodes {
            let m = microfacet.sample(w, Vec2::new(x as f32, y as f32));
            let cos = w.dot(m);
            if cos > 0.0 {
                sum += weight_x * weight_y * f64::from(f(m, cos));
            }
        }
    }
    sum
}

/// Nodes and weights of Gauss–Legendre quadrature on [0, 1], by Newton's method on the Legendre
/// polynomials (Press et al. 2007, section 4.6).
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            let mut x = float64::cos(core::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5));
            let mut derivative = 1.0;
            for _ in 0..8 {
                let (mut p, mut previous) = (1.0, 0.0);
                for k in 0..n {
                    let k = k as f64;
                    (p, previous) = (((2.0 * k + 1.0) * x * p - k * previous) / (k + 1.0), p);
                }
                derivative = n as f64 * (x * p - previous) / (x * x - 1.0);
                x -= p / derivative;
            }
            (
                0.5 * (1.0 + x),
                1.0 / ((1.0 - x * x) * derivative * derivative),
            )
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::microfacet::Kind;

    #[test]
    fn quadrature_is_exact_for_polynomials() {
        let nodes = gauss_legendre(NODES);
        for power in [0, 1, 5, 40, 63] {
            let sum: f64 = nodes.iter().map(|(x, w)| w * x.powi(power)).sum();
            assert!(
                (sum - 1.0 / f64::from(power + 1)).abs() < 1e-13,
                "{power} {sum}"
            );
        }
    }

    #[test]
    fn smooth_limit_is_fresnel() {
        let coat = RoughFresnel::new(Microfacet::new(Kind::Ggx, Vec2::splat(1e-4), true), 1.5);
        for i in [5, 20, 40, 63] {
            let cos = i as f32 / 63.0;
            let smooth = 1.0 - fresnel::dielectric(cos, 1.5).0;
            assert!((coat.transmittance(cos) - smooth).abs() < 1e-4, "{i}");
        }
    }

    #[test]
    fn more_nodes_change_nothing() {
        let fine = gauss_legendre(160);
        let coarse = gauss_legendre(NODES);
        for kind in [Kind::Beckmann, Kind::Ggx] {
            for alpha in [0.1, 0.5] {
                let microfacet = Microfacet::new(kind, Vec2::splat(alpha), true);
                for cos in [0.05f32, 0.3, 0.7, 1.0] {
                    let w = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
                    let f = |m: Vec3, c: f32| {
                        microfacet.g1(reflect(w, m), m) * (1.0 - fresnel::dielectric(c, 1.5).0)
                    };
                    let (a, b) = (
                        integrate(&microfacet, w, &coarse, f),
                        integrate(&microfacet, w, &fine, f),
                    );
                    assert!((a - b).abs() < 2e-3, "{kind:?} {alpha} {cos}: {a} {b}");
                }
            }
        }
    }
}
