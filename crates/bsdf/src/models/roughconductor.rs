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
use crate::interface::refraction::{half_way, reflect};
use crate::microfacet::Microfacet;
use crate::microfacet::roughness::Roughness;
use crate::{Bxdf, ShadingContext};
use etalon_params::Params;
use etalon_transport::{BsdfSample, Build, SpectrumKind, TextureId, Textures, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "roughconductor alpha=f:0.2",
    "roughconductor alpha_u=f:0.6 alpha_v=f:0.2 eta=t:400:1.5,700:0.2 k=t:400:1.8,700:3.5",
    "roughconductor alpha_u=f:0.15 alpha_v=f:0.5 distribution=s:ggx",
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
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> RoughConductor {
        let (eta, k) = self.metal.resolve(site);
        RoughConductor {
            eta,
            k,
            reflectance: site.spectrum(self.reflectance),
            microfacet: self.roughness.resolve(site),
        }
    }
}

/// A rough metal.
#[derive(Clone, Copy, Debug)]
pub struct RoughConductor {
    /// Real part of the index, per lane.
    pub eta: Vec4,
    /// Imaginary part of the index, per lane.
    pub k: Vec4,
    /// Factor of the reflectance, per lane.
    pub reflectance: Vec4,
    /// The distribution of normals.
    pub microfacet: Microfacet,
}

impl Bxdf for RoughConductor {
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        if !(wo.z > 0.0 && wi.z > 0.0) {
            return (Vec4::ZERO, Vec4::ZERO);
        }
        let Some((m, cos)) = half_way(wo, wi) else {
            return (Vec4::ZERO, Vec4::ZERO);
        };
        let d = self.microfacet.d(m);
        let shadowing = self.microfacet.g1(wo, m) * self.microfacet.g1(wi, m);
        let value = self.reflectance
            * fresnel::conductor(cos, self.eta, self.k)
            * (d * shadowing / (4.0 * wo.z));
        let density = self.microfacet.density(wo, m, d) / (4.0 * cos);
        (value, Vec4::splat(density))
    }

    fn sample(&self, wo: Vec3, _: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        if !(wo.z > 0.0) {
            return None;
        }
        let wi = reflect(wo, self.microfacet.sample(wo, u.to_array()));
        self.continuous(wo, wi, 1.0, mode)
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
