//! `homogeneous`: a medium that is the same everywhere,
//!
//! ```text
//! σs = α σt,   σa = (1 − α) σt        (m⁻¹, times `scale`)
//! ```
//!
//! with the single-scattering albedo α and the extinction σt, or σa and σs themselves; all are spectra.

use crate::majorants::Segments;
use crate::phases::{PhaseAt, PhaseFunction};
use crate::volume;
use etalon_params::Params;
use etalon_transport::{
    Build, Coefficients, MajorantSegment, Medium, Ray, SpectrumKind, TextureId, TexturePoint,
    Textures,
};
use glam::{Vec2, Vec3, Vec4};

/// How the coefficients are given.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Given {
    Albedo {
        albedo: TextureId,
        sigma_t: TextureId,
    },
    Both {
        sigma_a: TextureId,
        sigma_s: TextureId,
    },
}

/// A medium that is the same everywhere.
#[derive(Clone, Debug, PartialEq)]
pub struct Homogeneous {
    given: Given,
    scale: f32,
    phase: PhaseFunction,
}

/// The same at the wavelengths of a path.
#[derive(Debug)]
pub struct HomogeneousAt<'a, T> {
    coefficients: Coefficients,
    phase: &'a PhaseFunction,
    textures: &'a T,
}

impl Homogeneous {
    /// Reads `albedo` and `sigma_t`, or `sigma_a` and `sigma_s`; `scale` and the phase function.
    pub(crate) fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let given = if params.has("sigma_a") || params.has("sigma_s") {
            for name in ["albedo", "sigma_t"] {
                if params.property(name).is_some() {
                    let message =
                        format!("`{name}` and `sigma_a` or `sigma_s` are two ways to say the same");
                    params.error_at(name, message);
                }
            }
            let mut of = |name| volume::constant(params, name, 0.0, SpectrumKind::Unbounded, build);
            Given::Both {
                sigma_a: of("sigma_a"),
                sigma_s: of("sigma_s"),
            }
        } else {
            Given::Albedo {
                albedo: volume::constant(params, "albedo", 0.75, SpectrumKind::Reflectance, build),
                sigma_t: volume::constant(params, "sigma_t", 1.0, SpectrumKind::Unbounded, build),
            }
        };
        let what = "a finite number not below 0";
        let scale = params.float_where("scale", 1.0, what, |s| s >= 0.0 && s.is_finite());
        Some(Self {
            given,
            scale: scale as f32,
            phase: PhaseFunction::of_medium(params, build)?,
        })
    }

    /// The medium at four wavelengths (nm).
    #[inline]
    pub fn resolve<'a, T: Textures>(
        &'a self,
        textures: &'a T,
        lambda: Vec4,
    ) -> HomogeneousAt<'a, T> {
        let at = TexturePoint::at_uv(Vec2::ZERO);
        let spectrum = |id| textures.spectrum(id, &at, lambda);
        let coefficients = match self.given {
            Given::Albedo { albedo, sigma_t } => {
                let extinction = spectrum(sigma_t) * self.scale;
                let scattering = extinction * spectrum(albedo);
                Coefficients {
                    absorption: (extinction - scattering).max(Vec4::ZERO),
                    scattering,
                }
            }
            Given::Both { sigma_a, sigma_s } => Coefficients {
                absorption: spectrum(sigma_a) * self.scale,
                scattering: spectrum(sigma_s) * self.scale,
            },
        };
        HomogeneousAt {
            coefficients,
            phase: &self.phase,
            textures,
        }
    }
}

impl<T> HomogeneousAt<'_, T> {
    /// The stretches of a ray.
    #[inline]
    pub(crate) fn segments(&self, _: &Ray, _: f32) -> Segments<'_> {
        Segments::constant(self.coefficients.extinction().max_element())
    }
}

impl<'a, T: Textures> Medium for HomogeneousAt<'a, T> {
    type Phase = PhaseAt<'a, T>;

    #[inline]
    fn majorants(&self, ray: &Ray, t_max: f32) -> impl Iterator<Item = MajorantSegment> {
        self.segments(ray, t_max)
    }

    #[inline]
    fn coefficients(&self, _: Vec3) -> Coefficients {
        self.coefficients
    }

    #[inline]
    fn phase(&self, at: Vec3) -> PhaseAt<'a, T> {
        self.phase.at(self.textures, at)
    }

    #[inline]
    fn is_homogeneous(&self) -> bool {
        true
    }
}
