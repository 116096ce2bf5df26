//! Lambertian reflection from the front of a surface.
//!
//! ```text
//! f(wo, wi) = ρ / π      if cos θo > 0 and cos θi > 0
//! ```
//!
//! Lambert (1760), *Photometria*. Sampled with density cos θi / π.

use crate::lane_bsdf_at_point::{LaneBxdf, spectra};
use crate::{Bxdf, TextureSite};
use core::f32::consts::FRAC_1_PI;
use etalon_math::lane::{Lane, Mask, Select, Spectral, Vector};
use etalon_params::Params;
use etalon_sampling::warps::cosine_hemisphere;
use etalon_transport::{
    BsdfSample, Build, LaneBsdfSample, SpectrumKind, TextureId, Textures, TransportMode,
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
    pub fn resolve<T: Textures>(&self, site: &TextureSite<'_, T>) -> Diffuse {
        Self::in_lanes(|_| (self, site))
    }

    /// The models at several points.
    #[inline]
    pub(crate) fn in_lanes<'m, 's, F: Lane, T: Textures + 's>(
        at: impl Fn(usize) -> (&'m Self, &'s TextureSite<'s, T>),
    ) -> Diffuse<F> {
        Diffuse {
            reflectance: spectra::<F, _, T>(&at, |description| description.reflectance),
        }
    }
}

/// Lambertian reflection.
#[derive(Clone, Copy, Debug)]
pub struct Diffuse<F: Lane = f32> {
    /// ρ, the fraction of light reflected, per wavelength.
    pub reflectance: F::Spectrum,
}

impl<F: Lane> LaneBxdf<F> for Diffuse<F> {
    const CONTINUOUS: bool = true;
    const TRANSMITS: bool = false;

    #[inline(always)]
    fn eval_lanes(&self, wo: F::Vector, wi: F::Vector) -> (F::Spectrum, F::Spectrum) {
        let in_front = wo.z().gt(F::ZERO) & wi.z().gt(F::ZERO);
        let density = in_front.select(wi.z() * FRAC_1_PI, F::ZERO);
        (self.reflectance * density, F::Spectrum::uniform(density))
    }

    #[inline(always)]
    fn sample_lanes(&self, wo: F::Vector, _: F, u: [F; 2]) -> LaneBsdfSample<F> {
        let wi = cosine_hemisphere::<F>(u);
        let density = wi.z() * FRAC_1_PI;
        LaneBsdfSample {
            found: wo.z().gt(F::ZERO),
            wi,
            value: self.reflectance * density,
            chance: F::Spectrum::uniform(density),
            is_delta: F::Mask::splat(false),
            eta: F::ONE,
        }
    }

    #[inline(always)]
    fn albedo_lanes(&self, _: F::Vector) -> F::Spectrum {
        self.reflectance
    }
}

impl Bxdf for Diffuse {
    #[inline]
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        self.eval_lanes(wo, wi)
    }

    #[inline]
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, _: TransportMode) -> Option<BsdfSample> {
        self.sample_lanes(wo, u_lobe, u.to_array()).only()
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
    fn albedo(&self, wo: Vec3) -> Vec4 {
        self.albedo_lanes(wo)
    }
}
