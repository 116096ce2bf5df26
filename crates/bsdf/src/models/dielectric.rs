//! A smooth interface between two dielectrics.
//!
//! ```text
//! f(wo, wi) |cos θi| = ρ F δ(wi = mirror of wo) + τ (1 − F) s δ(wi = refraction of wo)
//! ```
//!
//! F by Fresnel's equations, the direction by Snell's law, s = 1/η² for radiance (which is
//! compressed on its way into the denser medium) and 1 for importance (Veach 1997, section 5.2).
//!
//! With dispersion each lane has its own η. A refracted direction is that of lane 0; the lanes
//! that would have gone elsewhere have probability and value zero there, so that one
//! wavelength survives. Reflection keeps all four.

use crate::interface::fresnel;
use crate::interface::refraction::reflect;
use crate::interface::relative_index::RelativeIndex;
use crate::lane_bsdf_at_point::{LaneBxdf, albedo_toward_normal, nothing, spectra};
use crate::{Bxdf, TextureSite};
use etalon_math::lane::{Lane, Select, Spectral, Vector, branch};
use etalon_params::Params;
use etalon_transport::{
    BsdfSample, Build, LaneBsdfSample, SpectrumKind, TextureId, Textures, TransportMode,
};
use glam::{Vec2, Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "dielectric",
    "dielectric int_ior=f:1 ext_ior=f:1.7",
    "dielectric int_ior=s:cauchy:1.5,0.01 specular_reflectance=u:0.5 specular_transmittance=u:0.7",
];

/// `dielectric` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    eta: RelativeIndex,
    reflectance: TextureId,
    transmittance: TextureId,
}

impl Description {
    /// Reads `int_ior` (bk7), `ext_ior` (air), `specular_reflectance` (1) and
    /// `specular_transmittance` (1).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let mut factor = |name| build.texture(params, name, Some(1.0), SpectrumKind::Reflectance);
        let reflectance = factor("specular_reflectance");
        let transmittance = factor("specular_transmittance");
        Some(Self {
            eta: RelativeIndex::from_params(params, build, "bk7")?,
            reflectance,
            transmittance,
        })
    }

    /// The model at a point.
    #[inline]
    pub fn resolve<T: Textures>(&self, site: &TextureSite<'_, T>) -> Dielectric {
        Self::in_lanes(|_| (self, site))
    }

    /// The models at several points.
    #[inline]
    pub(crate) fn in_lanes<'m, 's, F: Lane, T: Textures + 's>(
        at: impl Fn(usize) -> (&'m Self, &'s TextureSite<'s, T>),
    ) -> Dielectric<F> {
        let eta = |i: usize| {
            let (description, site) = at(i);
            description.eta.eval(site)
        };
        Dielectric {
            eta: F::Spectrum::of_lanes(eta),
            reflectance: spectra::<F, _, T>(&at, |description| description.reflectance),
            transmittance: spectra::<F, _, T>(&at, |description| description.transmittance),
            mirrored: F::ZERO,
        }
    }
}

/// A smooth interface.
#[derive(Clone, Copy, Debug)]
pub struct Dielectric<F: Lane = f32> {
    /// Index inside over index outside, per wavelength.
    pub eta: F::Spectrum,
    /// Factor of the reflected light, per wavelength.
    pub reflectance: F::Spectrum,
    /// Factor of the refracted light, per wavelength.
    pub transmittance: F::Spectrum,
    /// Share of light that is mirrored independently of Fresnel's equations; nonzero only in [`crate::models::mixture`].
    pub mirrored: F,
}

/// A discrete direction, its value and probability, and the relative index passed.
type Direction<F> = (
    <F as Lane>::Vector,
    (<F as Lane>::Spectrum, <F as Lane>::Spectrum),
    F,
);

/// What happens to light from a direction, whichever side it is on.
struct Split<F: Lane> {
    /// The relative index of the medium entered, per wavelength.
    eta: F::Spectrum,
    /// The share that is reflected, per wavelength.
    reflected: F::Spectrum,
    /// The cosine of the refracted direction, of the wavelength that chooses.
    cos_t: F,
}

impl<F: Lane> Dielectric<F> {
    #[inline(always)]
    fn split(&self, wo: F::Vector) -> Split<F> {
        let one = F::Spectrum::uniform(F::ONE);
        let eta = wo.z().gt(F::ZERO).select(self.eta, one / self.eta);
        let (fresnel, cos_t) = fresnel::dielectric_spectrum::<F>(wo.z().abs(), eta);
        Split {
            eta,
            reflected: fresnel + (one - fresnel) * self.mirrored,
            cos_t,
        }
    }

    #[inline(always)]
    fn reflected(&self, wo: F::Vector, split: &Split<F>) -> Direction<F> {
        let wi = reflect(wo, F::Vector::broadcast(Vec3::Z));
        let value = self.reflectance * split.reflected;
        (wi, (value, split.reflected), F::ONE)
    }

    #[inline(always)]
    fn refracted(&self, wo: F::Vector, split: &Split<F>, mode: TransportMode) -> Direction<F> {
        let hero = split.eta.hero();
        let together = (split.eta).at_each(|eta| Lane::eq(eta, hero).select(F::ONE, F::ZERO));
        let transmitted = (F::Spectrum::uniform(F::ONE) - split.reflected) * together;
        let scale = match mode {
            TransportMode::Radiance => F::ONE / (hero * hero),
            TransportMode::Importance => F::ONE,
        };
        let [x, y, z] = wo.xyz();
        let wi = F::Vector::from_xyz(-x / hero, -y / hero, split.cos_t.copysign(-z)).normalized();
        let value = self.transmittance * transmitted * scale;
        (wi, (value, transmitted), hero)
    }

    /// [`Bxdf::sample`] in lanes.
    #[inline(always)]
    fn sample_in(&self, wo: F::Vector, u_lobe: F, mode: TransportMode) -> LaneBsdfSample<F> {
        let split = self.split(wo);
        let (wi, value_and_chance, eta) = branch!(
            u_lobe.lt(split.reflected.hero()),
            self.reflected(wo, &split),
            self.refracted(wo, &split, mode)
        );
        let mut sample = LaneBsdfSample::discrete(wi, value_and_chance, eta);
        // Not in the surface.
        sample.found = sample.found & !Lane::eq(wo.z(), F::ZERO);
        sample
    }
}

impl<F: Lane> LaneBxdf<F> for Dielectric<F> {
    const CONTINUOUS: bool = false;
    const TRANSMITS: bool = true;

    #[inline(always)]
    fn eval_lanes(&self, _: F::Vector, _: F::Vector) -> (F::Spectrum, F::Spectrum) {
        nothing::<F>()
    }

    #[inline(always)]
    fn sample_lanes(&self, wo: F::Vector, u_lobe: F, _: [F; 2]) -> LaneBsdfSample<F> {
        self.sample_in(wo, u_lobe, TransportMode::Radiance)
    }

    #[inline(always)]
    fn albedo_lanes(&self, wo: F::Vector) -> F::Spectrum {
        albedo_toward_normal(self, wo)
    }
}

impl Bxdf for Dielectric {
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        self.eval_lanes(wo, wi)
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, _: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        self.sample_in(wo, u_lobe, mode).only()
    }

    fn discrete(&self, wo: Vec3, index: u32, mode: TransportMode) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let split = self.split(wo);
        let (wi, value_and_chance, eta) = match index {
            0 => self.reflected(wo, &split),
            1 => self.refracted(wo, &split, mode),
            _ => return None,
        };
        let mut sample = LaneBsdfSample::<f32>::discrete(wi, value_and_chance, eta);
        // Other wavelengths may refract where the one that chooses is reflected, so there always are two.
        sample.found = true;
        sample.only()
    }

    fn has_continuous(&self) -> bool {
        false
    }

    fn has_discrete(&self) -> bool {
        true
    }
}
