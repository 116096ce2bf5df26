//! A smooth conductor: a coloured mirror.
//!
//! ```text
//! f(wo, wi) |cos θi| = ρ F(cos θo; η, k) δ(wi = mirror of wo)      from the front
//! ```
//!
//! With F Fresnel's equations for a complex index (see [`crate::interface::fresnel::conductor`]).

use crate::interface::fresnel;
use crate::interface::metal::Metal;
use crate::interface::refraction::reflect;
use crate::lane_bsdf_at_point::{LaneBxdf, albedo_toward_normal, nothing, spectra};
use crate::{Bxdf, TextureSite};
use etalon_math::lane::{Lane, Spectral, Vector};
use etalon_params::Params;
use etalon_transport::{
    BsdfSample, Build, LaneBsdfSample, SpectrumKind, TextureId, Textures, TransportMode,
};
use glam::{Vec2, Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "conductor",
    "conductor eta=t:400:1.5,700:0.2 k=t:400:1.8,700:3.5",
];

/// `conductor` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    metal: Metal,
    reflectance: TextureId,
}

impl Description {
    /// Reads the metal (see [`Metal`]) and `specular_reflectance` (1).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let reflectance = build.texture(
            params,
            "specular_reflectance",
            Some(1.0),
            SpectrumKind::Reflectance,
        );
        Some(Self {
            metal: Metal::from_params(params, build)?,
            reflectance,
        })
    }

    /// The model at a point.
    #[inline]
    pub fn resolve<T: Textures>(&self, site: &TextureSite<'_, T>) -> Conductor {
        Self::in_lanes(|_| (self, site))
    }

    /// The models at several points.
    #[inline]
    pub(crate) fn in_lanes<'m, 's, F: Lane, T: Textures + 's>(
        at: impl Fn(usize) -> (&'m Self, &'s TextureSite<'s, T>),
    ) -> Conductor<F> {
        let [eta, k] = Metal::in_lanes::<F, T>(|i| {
            let (description, site) = at(i);
            (&description.metal, site)
        });
        Conductor {
            eta,
            k,
            reflectance: spectra::<F, _, T>(&at, |description| description.reflectance),
        }
    }
}

/// A coloured mirror.
#[derive(Clone, Copy, Debug)]
pub struct Conductor<F: Lane = f32> {
    /// Real part of the index, per wavelength.
    pub eta: F::Spectrum,
    /// Imaginary part of the index, per wavelength.
    pub k: F::Spectrum,
    /// Factor of the reflectance, per wavelength.
    pub reflectance: F::Spectrum,
}

impl<F: Lane> LaneBxdf<F> for Conductor<F> {
    const CONTINUOUS: bool = false;
    const TRANSMITS: bool = false;

    #[inline(always)]
    fn eval_lanes(&self, _: F::Vector, _: F::Vector) -> (F::Spectrum, F::Spectrum) {
        nothing::<F>()
    }

    #[inline(always)]
    fn sample_lanes(&self, wo: F::Vector, _: F, _: [F; 2]) -> LaneBsdfSample<F> {
        let wi = reflect(wo, F::Vector::broadcast(Vec3::Z));
        let fresnel = fresnel::conductor(wo.z().min(F::ONE), self.eta, self.k);
        let certain = F::Spectrum::uniform(F::ONE);
        let mut sample =
            LaneBsdfSample::discrete(wi, (self.reflectance * fresnel, certain), F::ONE);
        sample.found = wo.z().gt(F::ZERO);
        sample
    }

    #[inline(always)]
    fn albedo_lanes(&self, wo: F::Vector) -> F::Spectrum {
        albedo_toward_normal(self, wo)
    }
}

impl Bxdf for Conductor {
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        self.eval_lanes(wo, wi)
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, _: TransportMode) -> Option<BsdfSample> {
        self.sample_lanes(wo, u_lobe, u.to_array()).only()
    }

    fn discrete(&self, wo: Vec3, index: u32, mode: TransportMode) -> Option<BsdfSample> {
        (index == 0)
            .then(|| self.sample(wo, 0.0, Vec2::ZERO, mode))
            .flatten()
    }

    fn has_continuous(&self) -> bool {
        false
    }

    fn has_discrete(&self) -> bool {
        true
    }
}
