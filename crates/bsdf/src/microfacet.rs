//! Distributions of microfacet normals.
//!
//! ```text
//! visible(wo, m) = G1(wo, m) |wo·m| D(m) / |cos θo|     (Heitz 2014, eq. 2)
//! G(wo, wi, m)   = G1(wo, m) · G1(wi, m)                (Smith 1967, separable)
//!              or  1 / (1/G1(wo, m) + 1/G1(wi, m) − 1)  (correlated by height; Heitz 2014, eq. 99)
//! ```
//!
//! D and G1 are those of Beckmann (1963) and of Trowbridge & Reitz (1975), "GGX", with roughness
//! α along x and y (Walter, Marschner, Li & Torrance 2007; Heitz 2014,
//! *Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs*).

pub mod beckmann;
pub mod ggx;
pub mod roughness;

use core::f32::consts::FRAC_1_PI;
use etalon_math::lane::{Lane, Mask, Select, Vector, branch, exp};
use glam::Vec2;

/// The shape of a distribution of slopes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Gaussian slopes.
    Beckmann,
    /// Slopes with the long tails of Trowbridge & Reitz.
    Ggx,
}

/// The least roughness; Mitsuba's. Below it single precision cannot tell the normals apart.
pub const LEAST_ALPHA: f32 = 1e-4;

/// A distribution of microfacet normals about +z. All normals have z > 0.
#[derive(Clone, Copy, Debug)]
pub struct Microfacet<F: Lane = f32> {
    /// Whether the shape is [`Kind::Ggx`], not [`Kind::Beckmann`].
    pub is_ggx: F::Mask,
    /// Roughness along x and y, at least [`LEAST_ALPHA`].
    pub alpha: [F; 2],
    /// Whether normals are sampled as they are seen from `wo` or, as older renderers do, as
    /// they are on the surface.
    pub sample_visible: F::Mask,
    /// Whether a facet that is seen from one direction is the likelier to be seen from another, as a high one is: then
    /// masking and shadowing are correlated. Otherwise they are independent.
    pub correlated: F::Mask,
}

impl Microfacet {
    /// A distribution; a roughness below [`LEAST_ALPHA`] (as textures may have) is raised to it.
    #[inline]
    pub fn new(kind: Kind, alpha: Vec2, sample_visible: bool) -> Self {
        Self::in_lanes(|_| kind, alpha.to_array(), |_| sample_visible)
    }
}

impl<F: Lane> Microfacet<F> {
    /// Several distributions, as by [`Microfacet::new`].
    #[inline(always)]
    pub fn in_lanes(
        kind: impl Fn(usize) -> Kind,
        alpha: [F; 2],
        sample_visible: impl Fn(usize) -> bool,
    ) -> Self {
        let least = F::splat(LEAST_ALPHA);
        Self {
            is_ggx: F::Mask::from_fn(|i| kind(i) == Kind::Ggx),
            alpha: [alpha[0].max(least), alpha[1].max(least)],
            sample_visible: F::Mask::from_fn(sample_visible),
            correlated: F::Mask::splat(false),
        }
    }

    /// The same distributions with masking and shadowing correlated, where that is asked for.
    #[inline(always)]
    pub fn with_correlated(self, correlated: impl Fn(usize) -> bool) -> Self {
        Self {
            correlated: F::Mask::from_fn(correlated),
            ..self
        }
    }

    /// The same distributions in lanes.
    #[inline(always)]
    pub fn of_lanes<'m>(at: impl Fn(usize) -> &'m Microfacet) -> Self {
        Self {
            is_ggx: F::Mask::from_fn(|i| at(i).is_ggx),
            alpha: [0, 1].map(|axis| F::from_fn(|i| at(i).alpha[axis])),
            sample_visible: F::Mask::from_fn(|i| at(i).sample_visible),
            correlated: F::Mask::from_fn(|i| at(i).correlated),
        }
    }

    /// The same distribution, rougher by `factor`, which is 1 or more.
    #[inline(always)]
    pub fn scaled(&self, factor: F) -> Self {
        let [x, y] = self.alpha;
        Self {
            alpha: [x * factor, y * factor],
            ..*self
        }
    }

    /// D(m): density of microfacet area by normal (sr⁻¹ per unit of surface area).
    #[inline(always)]
    pub fn d(&self, m: F::Vector) -> F {
        let ([x, y, cos], [alpha_x, alpha_y]) = (m.xyz(), self.alpha);
        let (x, y) = (x / alpha_x, y / alpha_y);
        let (s2, c2) = (x * x + y * y, cos * cos);
        let area = alpha_x * alpha_y;
        let root = s2 + c2;
        let d = branch!(
            self.is_ggx,
            F::splat(FRAC_1_PI) / (area * root * root),
            exp(-s2 / c2) * FRAC_1_PI / (area * c2 * c2)
        );
        // Normals in the horizon are none, and a value too small to matter is a danger in ratios.
        (d * cos).gt(F::splat(1e-20)).select(d, F::ZERO)
    }

    /// α² tan² θ of a direction, with the roughness seen along its azimuth.
    #[inline(always)]
    fn projected_roughness2(&self, v: F::Vector) -> F {
        let ([x, y, cos], [alpha_x, alpha_y]) = (v.xyz(), self.alpha);
        let (x, y) = (x * alpha_x, y * alpha_y);
        (x * x + y * y) / (cos * cos)
    }

    /// G1(v, m), the share of microfacets with normal `m` that are visible from `v`: zero from
    /// behind. For Beckmann the rational approximation of Walter et al. (2007, eq. 27), within
    /// 0.35 % of the exact function, which is what Mitsuba and most renderers have.
    #[inline(always)]
    pub fn g1(&self, v: F::Vector, m: F::Vector) -> F {
        let t2 = self.projected_roughness2(v);
        let share = branch!(self.is_ggx, ggx::g1(t2), beckmann::g1_rational(t2));
        let in_front = (v.dot_product(m) * v.z()).gt(F::ZERO);
        in_front.select(share, F::ZERO)
    }

    /// G(wo, wi, m), the share of microfacets with normal `m` that are visible from both directions, be they on the same
    /// side or not (pbrt-v4, too, has one formula for both).
    #[inline(always)]
    pub fn g(&self, wo: F::Vector, wi: F::Vector, m: F::Vector) -> F {
        let (masked, shadowed) = (self.g1(wo, m), self.g1(wi, m));
        let both = masked * shadowed;
        let least = F::splat(f32::MIN_POSITIVE);
        branch!(
            self.correlated,
            both / (masked + shadowed - both).max(least),
            both
        )
    }

    /// [`Microfacet::g1`], exactly as the visible normals are distributed.
    #[inline(always)]
    fn g1_exact(&self, v: F::Vector) -> F {
        let t2 = self.projected_roughness2(v);
        branch!(self.is_ggx, ggx::g1(t2), beckmann::g1_exact(t2))
    }

    /// Per steradian, the density with which [`Microfacet::sample`] finds the normal `m` for
    /// `wo` with z > 0, when D(m) is `d`.
    #[inline(always)]
    pub fn density(&self, wo: F::Vector, m: F::Vector, d: F) -> F {
        let cos = wo.dot_product(m);
        let visible = cos.gt(F::ZERO) & d.gt(F::ZERO);
        branch!(
            self.sample_visible,
            visible.select(self.g1_exact(wo) * cos * d / wo.z(), F::ZERO),
            d * m.z()
        )
    }

    /// A normal for `wo` with z > 0.
    #[inline(always)]
    pub fn sample(&self, wo: F::Vector, u: [F; 2]) -> F::Vector {
        branch!(
            self.sample_visible,
            self.sample_visible_normal(wo, u),
            self.normal_of_slopes(branch!(
                self.is_ggx,
                ggx::sample_slopes(u),
                beckmann::sample_slopes(u)
            ))
        )
    }

    /// A normal as it is seen from `wo`: found for the surface stretched so that its roughness is 1 (Heitz & d'Eon 2014,
    /// section 3).
    #[inline(always)]
    fn sample_visible_normal(&self, wo: F::Vector, u: [F; 2]) -> F::Vector {
        let ([x, y, z], [alpha_x, alpha_y]) = (wo.xyz(), self.alpha);
        let stretched = F::Vector::from_xyz(x * alpha_x, y * alpha_y, z).normalized();
        branch!(
            self.is_ggx,
            {
                let [x, y, z] = ggx::sample_visible_normal::<F>(stretched, u).xyz();
                let z = z.max(F::splat(1e-7));
                F::Vector::from_xyz(x * alpha_x, y * alpha_y, z).normalized()
            },
            self.normal_of_slopes(beckmann::sample_visible_slopes(stretched, u))
        )
    }

    /// The unit normal of the facet with these slopes, for α = 1.
    #[inline(always)]
    fn normal_of_slopes(&self, [x, y]: [F; 2]) -> F::Vector {
        let [alpha_x, alpha_y] = self.alpha;
        F::Vector::from_xyz(-(x * alpha_x), -(y * alpha_y), F::ONE).normalized()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// G of GGX by Λ(v) = (√(1 + α² tan² θ) − 1)/2 (Heitz 2014, eq. 72): 1/(1 + Λₒ)/(1 + Λᵢ) and 1/(1 + Λₒ + Λᵢ), the latter the
    /// greater one; none for facets seen from behind. Rejects one rule for the other, and 0/0.
    #[test]
    fn both_rules_of_masking() {
        let alpha = 0.4;
        let separable = Microfacet::new(Kind::Ggx, Vec2::splat(alpha), true);
        let correlated = separable.with_correlated(|_| true);
        let lambda = |v: Vec3| {
            let tan2 = f64::from((v.x * v.x + v.y * v.y) / (v.z * v.z));
            0.5 * ((1.0 + f64::from(alpha * alpha) * tan2).sqrt() - 1.0)
        };
        for (wo, wi) in [
            (Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.28, 0.0, 0.96)),
            (Vec3::new(0.995, 0.0, 0.1), Vec3::new(-0.9, 0.3, 0.3)),
            (Vec3::new(0.0, 0.6, 0.8), Vec3::new(0.0, -0.8, 0.6)),
        ] {
            let (wo, wi) = (wo.normalize(), wi.normalize());
            let m = (wo + wi).normalize();
            let (o, i) = (lambda(wo), lambda(wi));
            let close = |found: f32, expected: f64| {
                assert!(
                    (f64::from(found) / expected - 1.0).abs() < 1e-5,
                    "{wo} {wi}: {found} {expected}"
                );
            };
            close(separable.g(wo, wi, m), 1.0 / ((1.0 + o) * (1.0 + i)));
            close(correlated.g(wo, wi, m), 1.0 / (1.0 + o + i));
            assert_eq!(correlated.g(wo, wi, -m), 0.0);
        }
    }
}
