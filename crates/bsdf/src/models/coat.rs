//! What `plastic` and `roughplastic` share: a diffuse base under a dielectric coat, without
//! absorption between the two.
//!
//! ```text
//! f_base(wo, wi) = T(θo) T(θi) / η² · ρ / (1 − ρ' R) / π
//! ```
//!
//! T is what the coat lets in from outside at an angle, R the share of diffuse light that it
//! reflects back inside, ρ the base's albedo and ρ' = ρ for the nonlinear variant (all
//! interreflections inside, colours saturate) or 1 for the linear one, as in Mitsuba. (Wolff
//! 1994, *Diffuse-Reflectance Model for Smooth Dielectric Surfaces*; W. Jakob 2010, Mitsuba's
//! `plastic`.)

use core::f32::consts::FRAC_1_PI;
use etalon_params::Params;
use etalon_transport::{Build, SpectrumKind, TextureId, Textures};
use glam::Vec4;

use crate::ShadingContext;
use crate::interface::relative_index::RelativeIndex;

/// Textures and numbers of a coated diffuse base.
#[derive(Clone, Debug)]
pub struct Coating {
    diffuse: TextureId,
    specular: TextureId,
    nonlinear: bool,
    /// Index inside over index outside.
    pub eta: f64,
}

impl Coating {
    /// Reads `diffuse_reflectance` (0.5), `specular_reflectance` (1), `nonlinear` (false),
    /// `int_ior` (polypropylene) and `ext_ior` (air).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let mut factor =
            |name, default| build.texture(params, name, Some(default), SpectrumKind::Reflectance);
        let diffuse = factor("diffuse_reflectance", 0.5);
        let specular = factor("specular_reflectance", 1.0);
        Some(Self {
            diffuse,
            specular,
            nonlinear: params.boolean_or("nonlinear", false),
            eta: RelativeIndex::constant_from_params(params, "polypropylene")?,
        })
    }

    /// The base at a point, for the internal reflectance R.
    #[inline]
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>, internal: f32) -> Coat {
        let eta = self.eta as f32;
        Coat::new(
            eta,
            site.spectrum(self.diffuse),
            site.spectrum(self.specular),
            self.nonlinear,
            internal,
        )
    }
}

/// The plain numbers of a coated base.
#[derive(Clone, Copy, Debug)]
pub struct Coat {
    /// Index inside over index outside.
    pub eta: f32,
    /// Factor of the light reflected by the coat, per lane.
    pub specular: Vec4,
    /// ρ, per lane.
    pub diffuse: Vec4,
    /// ρ / (1 − ρ' R) / (π η²), per lane.
    base: Vec4,
    /// The fraction of the light let in that comes out again, ρ (1 − R) / (1 − ρ' R), per lane.
    returned: Vec4,
}

impl Coat {
    /// A coat of relative index `eta` and internal reflectance `internal` over a base of albedo
    /// `diffuse`.
    #[inline]
    pub fn new(eta: f32, diffuse: Vec4, specular: Vec4, nonlinear: bool, internal: f32) -> Self {
        let through = if nonlinear {
            diffuse / (1.0 - diffuse * internal)
        } else {
            diffuse / (1.0 - internal)
        };
        Self {
            eta,
            specular,
            diffuse,
            base: through * (FRAC_1_PI / (eta * eta)),
            returned: through * (1.0 - internal),
        }
    }

    /// f_base · cos θi for the coat's transmittances at both angles.
    #[inline]
    pub fn base(&self, transmitted_o: f32, transmitted_i: f32, cos_i: f32) -> Vec4 {
        self.base * (transmitted_o * transmitted_i * cos_i)
    }

    /// The probability of sampling the coat's reflection rather than the base: their shares of
    /// the albedo, over all lanes together, so that every lane has the same.
    #[inline]
    pub fn specular_probability(&self, transmitted: f32) -> f32 {
        let specular = self.specular.element_sum() * (1.0 - transmitted);
        let base = self.returned.element_sum() * transmitted;
        let sum = specular + base;
        if sum > 0.0 { specular / sum } else { 0.0 }
    }
}
