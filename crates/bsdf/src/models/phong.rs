//! The Phong model that conserves energy: a diffuse part and a lobe about the mirror direction.
//!
//! ```text
//! f(wo, wi) = ρd / π + ρs (n + 2)/(2π) cosⁿα      if cos θo > 0 and cos θi > 0
//! ```
//!
//! α is the angle between `wi` and the mirror image of `wo`, taken as a right angle where it is
//! larger. Lafortune & Willems (1994), *Using the Modified Phong Reflectance Model for Physically
//! Based Rendering*: it is reciprocal, and reflects no more than it receives since ρd + ρs ≤ 1.
//! Where the two given amount to more, both are reduced alike. The lobe is sampled with density
//! (n + 1)/(2π) cosⁿα; of its directions those below the surface are lost.

use crate::interface::refraction::reflect;
use crate::{Bxdf, ShadingContext};
use core::f32::consts::{FRAC_1_PI, TAU};
use etalon_math::{Frame, float};
use etalon_params::Params;
use etalon_sampling::warps::square_to_cosine_hemisphere;
use etalon_transport::{BsdfSample, Build, SpectrumKind, TextureId, Textures, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "phong",
    "phong exponent=f:4 diffuse_reflectance=u:0 specular_reflectance=t:400:0.2,700:0.9",
    "phong exponent=f:90 diffuse_reflectance=t:400:0.1,700:0.6 specular_reflectance=u:0.4",
];

/// `phong` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    diffuse: TextureId,
    specular: TextureId,
    exponent: f32,
}

impl Description {
    /// Reads `diffuse_reflectance` (0.5), `specular_reflectance` (0.2) and `exponent` (30).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let mut factor =
            |name, default| build.texture(params, name, Some(default), SpectrumKind::Reflectance);
        let diffuse = factor("diffuse_reflectance", 0.5);
        let specular = factor("specular_reflectance", 0.2);
        let exponent = params.float_where("exponent", 30.0, "a number from 0 to 1000000", |n| {
            (0.0..=1e6).contains(&n)
        });
        Some(Self {
            diffuse,
            specular,
            exponent: exponent as f32,
        })
    }

    /// The model at a point.
    #[inline]
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> Phong {
        Phong::new(
            site.spectrum(self.diffuse),
            site.spectrum(self.specular),
            self.exponent,
        )
    }
}

/// A diffuse part and a lobe about the mirror direction.
#[derive(Clone, Copy, Debug)]
pub struct Phong {
    /// ρd, per lane.
    diffuse: Vec4,
    /// ρs, per lane.
    specular: Vec4,
    /// n.
    exponent: f32,
    /// The probability of sampling the lobe: its share of both, over all lanes together, so that
    /// every lane has the same.
    lobe: f32,
}

impl Phong {
    /// The model with reflectances brought to a sum of at most 1.
    #[inline]
    pub fn new(diffuse: Vec4, specular: Vec4, exponent: f32) -> Self {
        let excess = (diffuse + specular).max(Vec4::ONE);
        let (diffuse, specular) = (diffuse / excess, specular / excess);
        let (d, s) = (diffuse.element_sum(), specular.element_sum());
        Self {
            diffuse,
            specular,
            exponent,
            lobe: if s > 0.0 { s / (d + s) } else { 0.0 },
        }
    }
}

impl Bxdf for Phong {
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        if !(wo.z > 0.0 && wi.z > 0.0) {
            return (Vec4::ZERO, Vec4::ZERO);
        }
        let cos = reflect(wo, Vec3::Z).dot(wi).clamp(0.0, 1.0);
        let lobe = float::pow(cos, self.exponent) / TAU;
        let n = self.exponent;
        let value = self.diffuse * FRAC_1_PI + self.specular * ((n + 2.0) * lobe);
        let density = self.lobe * (n + 1.0) * lobe + (1.0 - self.lobe) * wi.z * FRAC_1_PI;
        (value * wi.z, Vec4::splat(density))
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        if !(wo.z > 0.0) {
            return None;
        }
        let wi = if u_lobe < self.lobe {
            let cos = float::pow(1.0 - u.x, 1.0 / (self.exponent + 1.0));
            let sin = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
            let (y, x) = float::sin_cos(TAU * u.y);
            let local = Vec3::new(x * sin, y * sin, cos);
            Frame::from_normal(reflect(wo, Vec3::Z)).to_world(local)
        } else {
            square_to_cosine_hemisphere(u)
        };
        self.continuous(wo, wi, 1.0, mode)
    }

    fn has_continuous(&self) -> bool {
        true
    }

    fn has_discrete(&self) -> bool {
        false
    }

    /// ρd, the reflectance of the diffuse part.
    fn albedo(&self, _: Vec3) -> Vec4 {
        self.diffuse
    }
}
