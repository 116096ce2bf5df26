//! Distributions of microfacet normals.
//!
//! ```text
//! visible(wo, m) = G1(wo, m) |wo·m| D(m) / |cos θo|     (Heitz 2014, eq. 2)
//! G(wo, wi, m)   = G1(wo, m) · G1(wi, m)                (Smith 1967, separable)
//! ```
//!
//! D and G1 are those of Beckmann (1963) and of Trowbridge & Reitz (1975), "GGX", with roughness
//! α along x and y (Walter, Marschner, Li & Torrance 2007; Heitz 2014,
//! *Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs*).

pub mod beckmann;
pub mod ggx;
pub mod roughness;

use core::f32::consts::FRAC_1_PI;
use etalon_math::float;
use glam::{Vec2, Vec3};

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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Microfacet {
    /// The shape.
    pub kind: Kind,
    /// Roughness along x and y, at least [`LEAST_ALPHA`].
    pub alpha: Vec2,
    /// Whether normals are sampled as they are seen from `wo` or, as older renderers do, as
    /// they are on the surface.
    pub sample_visible: bool,
}

impl Microfacet {
    /// A distribution; a roughness below [`LEAST_ALPHA`] (as textures may have) is raised to it.
    #[inline]
    pub fn new(kind: Kind, alpha: Vec2, sample_visible: bool) -> Self {
        Self {
            kind,
            alpha: alpha.max(Vec2::splat(LEAST_ALPHA)),
            sample_visible,
        }
    }

    /// The same distribution, rougher by `factor`.
    #[inline]
    pub fn scaled(&self, factor: f32) -> Self {
        Self::new(self.kind, self.alpha * factor, self.sample_visible)
    }

    /// D(m): density of microfacet area by normal (sr⁻¹ per unit of surface area).
    #[inline]
    pub fn d(&self, m: Vec3) -> f32 {
        let slopes = m.truncate() / self.alpha;
        let (s2, c2) = (slopes.length_squared(), m.z * m.z);
        let area = self.alpha.x * self.alpha.y;
        let d = match self.kind {
            Kind::Beckmann => FRAC_1_PI * float::exp(-s2 / c2) / (area * c2 * c2),
            Kind::Ggx => {
                let root = s2 + c2;
                FRAC_1_PI / (area * root * root)
            }
        };
        // Normals in the horizon are none, and a value too small to matter is a danger in ratios.
        if d * m.z > 1e-20 { d } else { 0.0 }
    }

    /// α² tan² θ of a direction, with the roughness seen along its azimuth.
    #[inline]
    fn projected_roughness2(&self, v: Vec3) -> f32 {
        (v.truncate() * self.alpha).length_squared() / (v.z * v.z)
    }

    /// G1(v, m), the share of microfacets with normal `m` that are visible from `v`: zero from
    /// behind. For Beckmann the rational approximation of Walter et al. (2007, eq. 27), within
    /// 0.35 % of the exact function, which is what Mitsuba and most renderers have.
    #[inline]
    pub fn g1(&self, v: Vec3, m: Vec3) -> f32 {
        if !(v.dot(m) * v.z > 0.0) {
            return 0.0;
        }
        let t2 = self.projected_roughness2(v);
        match self.kind {
            Kind::Beckmann => beckmann::g1_rational(t2),
            Kind::Ggx => ggx::g1(t2),
        }
    }

    /// The same, exactly as the visible normals are distributed.
    #[inline]
    fn g1_exact(&self, v: Vec3) -> f32 {
        let t2 = self.projected_roughness2(v);
        match self.kind {
            Kind::Beckmann => beckmann::g1_exact(t2),
            Kind::Ggx => ggx::g1(t2),
        }
    }

    /// Per steradian, the density with which [`Microfacet::sample`] finds the normal `m` for
    /// `wo` with z > 0, when D(m) is `d`.
    #[inline]
    pub fn density(&self, wo: Vec3, m: Vec3, d: f32) -> f32 {
        if self.sample_visible {
            let cos = wo.dot(m);
            if cos > 0.0 && d > 0.0 {
                self.g1_exact(wo) * cos * d / wo.z
            } else {
                0.0
            }
        } else {
            d * m.z
        }
    }

    /// A normal for `wo` with z > 0.
    #[inline]
    pub fn sample(&self, wo: Vec3, u: Vec2) -> Vec3 {
        if !self.sample_visible {
            let slopes = match self.kind {
                Kind::Beckmann => beckmann::sample_slopes(u),
                Kind::Ggx => ggx::sample_slopes(u),
            };
            return normal_of_slopes(slopes * self.alpha);
        }
        // Stretched so that the roughness becomes 1 (Heitz & d'Eon 2014, section 3).
        let stretched = (wo.truncate() * self.alpha).extend(wo.z).normalize();
        match self.kind {
            Kind::Beckmann => {
                normal_of_slopes(beckmann::sample_visible_slopes(stretched, u) * self.alpha)
            }
            Kind::Ggx => {
                let m = ggx::sample_visible_normal(stretched, u);
                (m.truncate() * self.alpha)
                    .extend(m.z.max(1e-7))
                    .normalize()
            }
        }
    }
}

/// The unit normal of the facet z = x·slopes.x + y·slopes.y.
#[inline]
fn normal_of_slopes(slopes: Vec2) -> Vec3 {
    (-slopes).extend(1.0).normalize()
}
