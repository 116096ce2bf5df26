//! Lambertian reflection from the front of a surface.
//!
//! ```text
//! f(wo, wi) = ρ / π      if cos θo > 0 and cos θi > 0
//! ```
//!
//! Lambert (1760), *Photometria*. Sampled with density cos θi / π.

use crate::{Bxdf, ShadingContext};
use core::f32::consts::FRAC_1_PI;
use etalon_math::Density;
use etalon_params::Params;
use etalon_sampling::warps::square_to_cosine_hemisphere;
use etalon_transport::{
    BsdfSample, Build, SamplePdf, SpectrumKind, TextureId, Textures, TransportMode,
};
use glam::{Vec2, Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &["diffuse", "diffuse reflectance=t:400:0.1,700:0.9"];

/// `diffuse` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    reflectance: TextureId,
}

impl Description {
    /// With a given reflectance texture.
    pub fn new(reflectance: TextureId) -> Self {
        Self { reflectance }
    }

    /// Reads `reflectance` (0.5).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        Some(Self {
            reflectance: build.texture(params, "reflectance", Some(0.5), SpectrumKind::Reflectance),
        })
    }

    /// The model at a point.
    #[inline]
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> Diffuse {
        Diffuse {
            reflectance: site.spectrum(self.reflectance),
        }
    }
}

/// Lambertian reflection.
#[derive(Clone, Copy, Debug)]
pub struct Diffuse {
    /// ρ, the fraction of light reflected, per lane.
    pub reflectance: Vec4,
}

impl Bxdf for Diffuse {
    #[inline]
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        let density = if wo.z > 0.0 && wi.z > 0.0 {
            wi.z * FRAC_1_PI
        } else {
            0.0
        };
        (self.reflectance * density, Vec4::splat(density))
    }

    #[inline]
    fn sample(&self, wo: Vec3, _: f32, u: Vec2, _: TransportMode) -> Option<BsdfSample> {
        if !(wo.z > 0.0) {
            return None;
        }
        let wi = square_to_cosine_hemisphere(u);
        let density = wi.z * FRAC_1_PI;
        Some(BsdfSample {
            wi,
            value: self.reflectance * density,
            chance: SamplePdf::Continuous(Density::uniform(density)),
            eta: 1.0,
            is_null: false,
        })
    }

    #[inline]
    fn has_continuous(&self) -> bool {
        true
    }

    fn has_discrete(&self) -> bool {
        false
    }

    fn transmits(&self) -> bool {
        false
    }

    #[inline]
    fn albedo(&self, _: Vec3) -> Vec4 {
        self.reflectance
    }
}
