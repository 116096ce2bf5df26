//! `homogeneous`: a medium that is the same everywhere,
//!
//! ```text
//! σs = α σt,   σa = (1 − α) σt        (m⁻¹, times `scale`)
//! ```
//!
//! and emits σa Lₑ per metre, with the radiance Lₑ (`emission`) that a thick piece would have if it scattered nothing;
//! with the single-scattering albedo α (where that varies in space, `heterogeneous` reads it) and the extinction σt, or σa and σs themselves, or those of a `material`; all are spectra.

use crate::majorants::Segments;
use crate::phases::{PhaseAt, PhaseFunction};
use crate::surface_albedo::{below, single_scattering};
use crate::tracking::{Tracked, Tracking};
use crate::{Boundary, Profile, ProfileAt, materials, volume};
use etalon_params::{Diagnostic, Params};
use etalon_spectrum::Spectrum;
use etalon_transport::{
    Build, Coefficients, Phase, Ray, SpectrumKind, SurfaceInteraction, TextureId, TexturePoint,
    Textures, is_varying, refuse_varying,
};
use glam::{Vec2, Vec3, Vec4};

/// The parametrisation of the coefficients.
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
    /// By the albedo of a half-space of it, and the mean free path.
    Surface {
        albedo: TextureId,
        mean_free_path: TextureId,
        g: f32,
        boundary: Boundary,
    },
}

/// A homogeneous medium. Below a textured surface the coefficients vary over that surface, not in space.
#[derive(Clone, Debug, PartialEq)]
pub struct Homogeneous {
    given: Given,
    scale: f32,
    phase: PhaseFunction,
    emission: Option<TextureId>,
    tracking: Tracking,
    /// Whether the coefficients vary over the surface: a walk keeps those of its point of entry.
    varies: bool,
    /// The diffusion profile that replaces walks below a surface.
    surface: Option<Surface>,
    /// Its extinction is clamped to this (m⁻¹), at the same albedo.
    densest: f32,
    /// Whether no light enters it through null surfaces.
    pub(crate) is_dark: bool,
}

/// A diffusion profile with its parameters other than the coefficients.
#[derive(Clone, Debug, PartialEq)]
struct Surface {
    profile: Profile,
    g: f32,
    boundary: Boundary,
}

/// The same at the wavelengths of a path.
#[derive(Debug)]
pub struct HomogeneousAt<'a, T> {
    medium: &'a Homogeneous,
    coefficients: Coefficients,
    emission: Vec4,
    textures: &'a T,
    lambda: Vec4,
}

impl<T> Clone for HomogeneousAt<'_, T> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for HomogeneousAt<'_, T> {}

/// Nothing absorbs or scatters more (m⁻¹), so that densities of paths stay numbers.
const MOST: f32 = 1e12;

impl Homogeneous {
    /// Reads `albedo` and `sigma_t`, or `sigma_a` and `sigma_s`, or `material`; `scale` and the phase function.
    pub(crate) fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let given = if params.has("material") {
            by_name(params, build)?
        } else if params.has("sigma_a") || params.has("sigma_s") {
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
            phase: {
                let phase = PhaseFunction::of_medium(params, build)?;
                if matches!(&phase, PhaseFunction::Sggx(flakes) if !flakes.is_even()) {
                    params.error("flakes that vary in space need a `heterogeneous` medium");
                    return None;
                }
                phase
            },
            emission: {
                refuse_varying(params, "emission", build);
                volume::emission(params, build)
            },
            tracking: volume::tracking(params, Tracking::Closed),
            varies: false,
            surface: None,
            densest: MOST,
            is_dark: false,
        })
    }

    /// Holds the mean free path to at least `length` (m), with the same albedo: what shorter flights do is lost in the rounding of
    /// coordinates. Whether that makes a difference, as far as coefficients do not vary.
    pub fn hold_flights(&mut self, length: f32, textures: &impl Textures, lambda: Vec4) -> bool {
        let at = TexturePoint::at_uv(Vec2::ZERO);
        let coefficients = self.coefficients(textures, &at, lambda);
        let scatters = coefficients.scattering != Vec4::ZERO || self.varies;
        let densest = 1.0 / length;
        if scatters {
            self.densest = densest.min(MOST);
        }
        scatters && coefficients.extinction().max_element() > densest
    }

    /// Whether it emits light.
    pub fn emits(&self) -> bool {
        self.emission.is_some()
    }

    /// `None`: it has no bounds of its own.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        None
    }

    /// Reads what `homogeneous` has, or `albedo` of a surface and `mean_free_path`, for a closed shape with this `boundary`; with the
    /// diffusion profile that the plugin is, if it is one.
    pub fn of_subsurface(
        params: &Params<'_>,
        boundary: Boundary,
        build: &mut dyn Build,
    ) -> Option<Self> {
        let name = params.node.plugin.value.as_str();
        let is_profile = Profile::BUILT.contains(&name);
        let by_coefficients = ["material", "sigma_a", "sigma_s", "sigma_t"];
        let mut medium = match by_coefficients.iter().any(|name| params.has(name)) {
            true => Self::from_params(params, build)?,
            false => Self::by_surface(params, boundary, build)?,
        };
        if is_profile {
            let Some(g) = medium.phase.mean_cosine() else {
                params.error(
                    "diffusion profiles know the phase functions `isotropic`, `rayleigh` and `hg`",
                );
                return None;
            };
            // A profile takes the coefficients at the point of entry anyway.
            medium.varies = false;
            medium.surface = Some(Surface {
                profile: Profile::from_params(params, g, &boundary)?,
                g,
                boundary,
            });
        }
        Some(medium)
    }

    /// Reads `albedo` of a surface and `mean_free_path`, which may vary over it.
    fn by_surface(params: &Params<'_>, boundary: Boundary, build: &mut dyn Build) -> Option<Self> {
        let albedo = build.texture(params, "albedo", Some(0.8), SpectrumKind::Reflectance);
        let name = "mean_free_path";
        let length = match is_varying(params, name, build) {
            true => build.texture(params, name, Some(1.0), SpectrumKind::Unbounded),
            false => volume::constant(params, name, 1.0, SpectrumKind::Unbounded, build),
        };
        let what = "a finite number above 0";
        let scale = params.float_where("scale", 1.0, what, |s| s > 0.0 && s.is_finite());
        let phase = PhaseFunction::of_medium(params, build)?;
        let Some(g) = phase.mean_cosine() else {
            let message = "the albedo of a surface is known for the phase functions `isotropic`, `rayleigh` and `hg`";
            params.error(message);
            return None;
        };
        Some(Self {
            given: Given::Surface {
                albedo,
                mean_free_path: length,
                g,
                boundary,
            },
            scale: scale as f32,
            phase,
            emission: None,
            tracking: Tracking::Closed,
            varies: ["albedo", name]
                .iter()
                .any(|name| is_varying(params, name, build)),
            surface: None,
            densest: MOST,
            is_dark: false,
        })
    }

    /// The medium at four wavelengths (nm), for a path that enters it at a point of its surface or is in it already. Media that
    /// emit do not vary over their surface.
    #[inline]
    pub fn enter<'a, T: Textures>(
        &'a self,
        at: Option<TexturePoint>,
        textures: &'a T,
        lambda: Vec4,
    ) -> HomogeneousAt<'a, T> {
        let at = (at.filter(|_| !self.emits())).unwrap_or(TexturePoint::at_uv(Vec2::ZERO));
        let coefficients = self.coefficients(textures, &at, lambda);
        let emission = (self.emission).map_or(Vec4::ZERO, |le| {
            coefficients.absorption * textures.spectrum(le, &at, lambda)
        });
        HomogeneousAt {
            medium: self,
            coefficients,
            emission,
            textures,
            lambda,
        }
    }

    /// Whether walks keep the coefficients of the surface point where they enter.
    pub fn varies(&self) -> bool {
        self.varies
    }

    /// Whether a diffusion profile replaces walks in it.
    pub fn diffuses(&self) -> bool {
        self.surface.is_some()
    }

    /// Exitant over entering flux, by the diffusion profile and by the albedo of a half-space, per lane, if it is the profile of one.
    pub fn bias(&self, textures: &impl Textures, lambda: Vec4) -> Option<[Vec4; 2]> {
        let surface = self.surface.as_ref()?;
        let coefficients = self.coefficients(textures, &TexturePoint::at_uv(Vec2::ZERO), lambda);
        let Surface {
            profile,
            g,
            boundary,
        } = surface;
        profile.bias(&coefficients, *g, *boundary)
    }

    /// σa and σs, at a point of the surface where they vary over it.
    pub fn coefficients(
        &self,
        textures: &impl Textures,
        at: &TexturePoint,
        lambda: Vec4,
    ) -> Coefficients {
        let spectrum = |id| textures.spectrum(id, at, lambda);
        match self.given {
            Given::Albedo { albedo, sigma_t } => {
                let extinction = (spectrum(sigma_t) * self.scale).min(Vec4::splat(self.densest));
                let scattering = extinction * spectrum(albedo);
                Coefficients {
                    absorption: (extinction - scattering).max(Vec4::ZERO),
                    scattering,
                }
            }
            Given::Both { sigma_a, sigma_s } => {
                let of = |id| (spectrum(id) * self.scale).min(Vec4::splat(MOST));
                let (absorption, scattering) = (of(sigma_a), of(sigma_s));
                let held = (self.densest / (absorption + scattering)).min(Vec4::ONE);
                Coefficients {
                    absorption: absorption * held,
                    scattering: scattering * held,
                }
            }
            Given::Surface {
                albedo,
                mean_free_path,
                g,
                boundary,
            } => {
                let seen = spectrum(albedo);
                let below = boundary
                    .eta
                    .map_or(seen, |eta| below(seen, eta, boundary.inside));
                let length = spectrum(mean_free_path).max(Vec4::splat(f32::MIN_POSITIVE));
                let extinction = (self.scale / length).min(Vec4::splat(self.densest));
                let scattering = extinction * single_scattering(below, g);
                Coefficients {
                    absorption: (extinction - scattering).max(Vec4::ZERO),
                    scattering,
                }
            }
        }
    }
}

/// The coefficients of a `material`, mm⁻¹ as the scene's unit is 1 mm or `scale` says otherwise.
fn by_name(params: &Params<'_>, build: &mut dyn Build) -> Option<Given> {
    let name = params.string("material")?;
    let Some(coefficients) = materials::named(name) else {
        let span = params
            .property("material")
            .map_or(params.node.span, |p| p.span);
        let unknown = Diagnostic::error(span, format!("no coefficients are known of `{name}`"));
        (params.diagnostics).push(unknown.suggest(name, materials::names()));
        return None;
    };
    let mut spectrum = |rgb: [f64; 3]| Spectrum::unbounded(rgb).ok().map(|s| build.spectrum(s));
    let [sigma_a, sigma_s] = coefficients;
    Some(Given::Both {
        sigma_a: spectrum(sigma_a)?,
        sigma_s: spectrum(sigma_s)?,
    })
}

impl<'a, T: Textures> HomogeneousAt<'a, T> {
    #[inline]
    pub(crate) fn is_dark(&self) -> bool {
        self.medium.is_dark
    }

    /// The diffusion profile below a point of the surface, if it has one.
    pub(crate) fn diffusion(&self, at: &SurfaceInteraction) -> Option<ProfileAt<'a>> {
        let medium = self.medium;
        let Surface {
            profile,
            g,
            boundary,
        } = medium.surface.as_ref()?;
        let coefficients = medium.coefficients(self.textures, &at.into(), self.lambda);
        Some(profile.at(&coefficients, *g, *boundary))
    }
}

impl<'a, T: Textures> Tracked for HomogeneousAt<'a, T> {
    type Phase = PhaseAt<'a, T>;

    #[inline]
    fn coefficients(&self, at: Vec3, direction: Vec3) -> Coefficients {
        self.coefficients * self.phase(at).projected_area(direction)
    }

    #[inline]
    fn phase(&self, at: Vec3) -> PhaseAt<'a, T> {
        self.medium.phase.at(self.textures, at, self.lambda)
    }

    #[inline]
    fn emission(&self, at: Vec3, direction: Vec3) -> Vec4 {
        self.emission * self.phase(at).projected_area(direction)
    }

    #[inline]
    fn majorants(&self, ray: &Ray, _: f32) -> Segments<'_> {
        let extinction = self.coefficients(ray.origin, ray.direction).extinction();
        let control = match self.medium.tracking {
            Tracking::Residual => 0.999 * extinction.min_element(),
            _ => 0.0,
        };
        Segments::constant(extinction.max_element(), control)
    }

    #[inline]
    fn tracking(&self) -> Tracking {
        self.medium.tracking
    }
}
