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
use etalon_math::lane::{Lane, Mask, Select, Spectral};
use etalon_params::Params;
use etalon_transport::{Build, SpectrumKind, TextureId, Textures};

use crate::TextureSite;
use crate::interface::relative_index::RelativeIndex;
use crate::lane_bsdf_at_point::spectra;

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

    /// The bases at several points, for their internal reflectances R.
    #[inline(always)]
    pub(crate) fn in_lanes<'m, 's, F: Lane, T: Textures + 's>(
        at: impl Fn(usize) -> (&'m Self, &'s TextureSite<'s, T>),
        internal: F,
    ) -> Coat<F> {
        let diffuse = spectra::<F, _, T>(&at, |coating| coating.diffuse);
        let nonlinear = F::Mask::from_fn(|i| at(i).0.nonlinear);
        let one = F::Spectrum::uniform(F::ONE);
        let absorbed = nonlinear.select(diffuse, one) * internal;
        let through = diffuse / (one - absorbed);
        let eta = F::from_fn(|i| at(i).0.eta as f32);
        Coat {
            eta,
            specular: spectra::<F, _, T>(&at, |coating| coating.specular),
            diffuse,
            base: through * (F::splat(FRAC_1_PI) / (eta * eta)),
            returned: through * (F::ONE - internal),
        }
    }
}

/// The plain numbers of a coated base.
#[derive(Clone, Copy, Debug)]
pub struct Coat<F: Lane = f32> {
    /// Index inside over index outside.
    pub eta: F,
    /// Factor of the light reflected by the coat, per wavelength.
    pub specular: F::Spectrum,
    /// ρ, per wavelength.
    pub diffuse: F::Spectrum,
    /// ρ / (1 − ρ' R) / (π η²), per wavelength.
    base: F::Spectrum,
    /// The fraction of the light let in that comes out again, ρ (1 − R) / (1 − ρ' R), per wavelength.
    returned: F::Spectrum,
}

impl<F: Lane> Coat<F> {
    /// f_base · cos θi for the coat's transmittances at both angles.
    #[inline(always)]
    pub fn base(&self, transmitted_o: F, transmitted_i: F, cos_i: F) -> F::Spectrum {
        self.base * (transmitted_o * transmitted_i * cos_i)
    }

    /// The probability of sampling the coat's reflection rather than the base: their shares of
    /// the albedo, over all wavelengths together, so that every one has the same.
    #[inline(always)]
    pub fn specular_probability(&self, transmitted: F) -> F {
        let specular = self.specular.sum() * (F::ONE - transmitted);
        let base = self.returned.sum() * transmitted;
        let sum = specular + base;
        sum.gt(F::ZERO).select(specular / sum, F::ZERO)
    }
}
