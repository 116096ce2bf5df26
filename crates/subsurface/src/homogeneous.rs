//! `homogeneous`: a medium that is the same everywhere,
//!
//! ```text
//! σs = α σt,   σa = (1 − α) σt        (m⁻¹, times `scale`)
//! ```
//!
//! with the single-scattering albedo α and the extinction σt, both spectra.

use crate::{AnyPhase, volume};
use etalon_params::Params;
use etalon_transport::{
    Build, Coefficients, Medium, Ray, SpectrumKind, TextureId, TexturePoint, Textures,
};
use glam::{Vec2, Vec3, Vec4};

/// A medium that is the same everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Homogeneous {
    albedo: TextureId,
    sigma_t: TextureId,
    scale: f32,
    phase: AnyPhase,
}

/// The same at the wavelengths of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HomogeneousAt {
    coefficients: Coefficients,
    phase: AnyPhase,
}

impl Homogeneous {
    /// Reads `albedo`, `sigma_t`, `scale` and the phase function.
    pub(crate) fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let albedo = volume::constant(params, "albedo", 0.75, SpectrumKind::Reflectance, build);
        let sigma_t = volume::constant(params, "sigma_t", 1.0, SpectrumKind::Unbounded, build);
        let what = "a finite number not below 0";
        let scale = params.float_where("scale", 1.0, what, |s| s >= 0.0 && s.is_finite());
        Some(Self {
            albedo,
            sigma_t,
            scale: scale as f32,
            phase: AnyPhase::of_medium(params)?,
        })
    }

    /// The medium at four wavelengths (nm).
    #[inline]
    pub fn resolve(&self, textures: &impl Textures, lambda: Vec4) -> HomogeneousAt {
        let at = TexturePoint::at_uv(Vec2::ZERO);
        let extinction = textures.spectrum(self.sigma_t, &at, lambda) * self.scale;
        let scattering = extinction * textures.spectrum(self.albedo, &at, lambda);
        HomogeneousAt {
            coefficients: Coefficients {
                absorption: (extinction - scattering).max(Vec4::ZERO),
                scattering,
            },
            phase: self.phase,
        }
    }
}

impl Medium for HomogeneousAt {
    type Phase = AnyPhase;

    #[inline]
    fn majorant(&self, _: &Ray, _: f32) -> f32 {
        self.coefficients.extinction().max_element()
    }

    #[inline]
    fn coefficients(&self, _: Vec3) -> Coefficients {
        self.coefficients
    }

    #[inline]
    fn phase(&self, _: Vec3) -> AnyPhase {
        self.phase
    }

    #[inline]
    fn is_homogeneous(&self) -> bool {
        true
    }
}
