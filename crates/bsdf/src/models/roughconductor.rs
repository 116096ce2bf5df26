//! A rough conductor.
//!
//! ```text
//! f(wo, wi) = ρ F(wo·m; η, k) D(m) G(wo, wi, m) / (4 cos θo cos θi)      m = half-way vector
//! ```
//!
//! Torrance & Sparrow (1967), Cook & Torrance (1982); Walter, Marschner, Li & Torrance (2007),
//! eq. 20. Sampled through the normals visible from `wo`: density visible(wo, m) / (4 wo·m).

use crate::interface::fresnel;
use crate::interface::metal::Metal;
use crate::interface::refraction::{half_vector, reflect};
use crate::lane_bsdf_at_point::{LaneBxdf, albedo_toward_normal, nothing, spectra};
use crate::microfacet::Microfacet;
use crate::microfacet::roughness::Roughness;
use crate::{Bxdf, TextureSite};
use etalon_math::lane::{Lane, Mask, Select, Spectral, Vector};
use etalon_params::Params;
use etalon_transport::{
    BsdfSample, Build, LaneBsdfSample, SpectrumKind, TextureId, Textures, TransportMode,
};
use glam::{Vec2, Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "roughconductor alpha=f:0.2",
    "roughconductor alpha_u=f:0.6 alpha_v=f:0.2 eta=t:400:1.5,700:0.2 k=t:400:1.8,700:3.5",
    "roughconductor alpha_u=f:0.15 alpha_v=f:0.5 distribution=s:ggx",
    "roughconductor alpha=f:0.5 distribution=s:ggx masking=s:correlated",
    "roughconductor alpha=f:0.4 distribution=s:ggx sample_visible=b:false eta=u:0.2 k=u:3.9",
    "roughconductor alpha=f:0.3 sample_visible=b:false",
];

/// `roughconductor` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    metal: Metal,
    reflectance: TextureId,
    roughness: Roughness,
}

impl Description {
    /// Reads the metal (see [`Metal`]), `specular_reflectance` (1) and the roughness (see
    /// [`Roughness`]).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let reflectance = build.texture(
            params,
            "specular_reflectance",
            Some(1.0),
            SpectrumKind::Reflectance,
        );
        let metal = Metal::from_params(params, build);
        let roughness = Roughness::from_params(params, build);
        Some(Self {
            metal: metal?,
            reflectance,
            roughness: roughness?,
        })
    }

    /// The model at a point.
    #[inline]
    pub fn resolve<T: Textures>(&self, site: &TextureSite<'_, T>) -> RoughConductor {
        Self::in_lanes(|_| (self, site))
    }

    /// The models at several points.
    #[inline]
    pub(crate) fn in_lanes<'m, 's, F: Lane, T: Textures + 's>(
        at: impl Fn(usize) -> (&'m Self, &'s TextureSite<'s, T>),
    ) -> RoughConductor<F> {
        let [eta, k] = Metal::in_lanes::<F, T>(|i| {
            let (description, site) = at(i);
            (&description.metal, site)
        });
        RoughConductor {
            eta,
            k,
            reflectance: spectra::<F, _, T>(&at, |description| description.reflectance),
            microfacet: Roughness::in_lanes(|i| {
                let (description, site) = at(i);
                (&description.roughness, site)
            }),
        }
    }
}

/// A rough metal.
#[derive(Clone, Copy, Debug)]
pub struct RoughConductor<F: Lane = f32> {
    /// Real part of the index, per wavelength.
    pub eta: F::Spectrum,
    /// Imaginary part of the index, per wavelength.
    pub k: F::Spectrum,
    /// Factor of the reflectance, per wavelength.
    pub reflectance: F::Spectrum,
    /// The distribution of normals.
    pub microfacet: Microfacet<F>,
}

impl<F: Lane> LaneBxdf<F> for RoughConductor<F> {
    const CONTINUOUS: bool = true;
    const TRANSMITS: bool = false;

    #[inline(always)]
    fn eval_lanes(&self, wo: F::Vector, wi: F::Vector) -> (F::Spectrum, F::Spectrum) {
        let (has_normal, m, cos) = half_vector::<F>(wo, wi);
        let reflects = wo.z().gt(F::ZERO) & wi.z().gt(F::ZERO) & has_normal;
        if !reflects.any() {
            return nothing::<F>();
        }
        let d = self.microfacet.d(m);
        let shadowing = self.microfacet.g(wo, wi, m);
        let value = self.reflectance
            * fresnel::conductor(cos, self.eta, self.k)
            * (d * shadowing / (wo.z() * 4.0));
        let density = self.microfacet.density(wo, m, d) / (cos * 4.0);
        reflects.select((value, F::Spectrum::uniform(density)), nothing::<F>())
    }

    #[inline(always)]
    fn sample_lanes(&self, wo: F::Vector, _: F, u: [F; 2]) -> LaneBsdfSample<F> {
        let wi = reflect(wo, self.microfacet.sample(wo, u));
        LaneBsdfSample::continuous(wi, self.eval_lanes(wo, wi), F::ONE)
    }

    #[inline(always)]
    fn albedo_lanes(&self, wo: F::Vector) -> F::Spectrum {
        albedo_toward_normal(self, wo)
    }
}

impl Bxdf for RoughConductor {
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        self.eval_lanes(wo, wi)
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, _: TransportMode) -> Option<BsdfSample> {
        self.sample_lanes(wo, u_lobe, u.to_array()).only()
    }

    fn has_continuous(&self) -> bool {
        true
    }

    fn has_discrete(&self) -> bool {
        false
    }

    fn transmits(&self) -> bool {
        false
    }
}
