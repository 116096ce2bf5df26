//! Mitsuba's `pplastic`, as its variants without polarisation render it: a rough reflection, and below it a diffuse base that
//! light reaches and leaves by refraction at a smooth surface.
//!
//! ```text
//! f(wo, wi) = ρs F(wo·m) D(m) G(wo, wi, m) / (4 cos θo cos θi) + ρd / π · (1 − F(cos θo)) (1 − F(cos θi))
//! ```
//!
//! from the front. Baek, Jeon, Tong & Kim (2018), *Simultaneous Acquisition of Polarimetric SVBRDF and Normals*, eqs. 4 to 10, of
//! which the first Stokes component is kept. Both terms are added as they are: light that is reflected back into the base is lost.

use crate::interface::fresnel;
use crate::interface::refraction::{half_way, reflect};
use crate::interface::relative_index::RelativeIndex;
use crate::microfacet::Microfacet;
use crate::microfacet::roughness::Roughness;
use crate::{Bxdf, ShadingContext};
use core::f32::consts::FRAC_1_PI;
use etalon_params::Params;
use etalon_sampling::warps::square_to_cosine_hemisphere;
use etalon_transport::{BsdfSample, Build, SpectrumKind, TextureId, Textures, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "pplastic alpha=f:0.2",
    "pplastic alpha_u=f:0.4 alpha_v=f:0.15 distribution=s:ggx diffuse_reflectance=t:400:0.1,700:0.9",
    "pplastic alpha=f:0.3 diffuse_reflectance=u:0 sample_visible=b:false",
];

/// `pplastic` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    diffuse: TextureId,
    specular: TextureId,
    roughness: Roughness,
    /// Index inside over index outside.
    eta: f32,
}

impl Description {
    /// Reads `diffuse_reflectance` (0.5), `specular_reflectance` (1), `int_ior` (polypropylene), `ext_ior` (air) and what
    /// [`Roughness`] does.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let mut factor =
            |name, default| build.texture(params, name, Some(default), SpectrumKind::Reflectance);
        let diffuse = factor("diffuse_reflectance", 0.5);
        let specular = factor("specular_reflectance", 1.0);
        let roughness = Roughness::from_params(params, build);
        Some(Self {
            diffuse,
            specular,
            eta: RelativeIndex::constant_from_params(params, "polypropylene")? as f32,
            roughness: roughness?,
        })
    }

    /// The model at a point.
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> PolarizedPlastic {
        let (diffuse, specular) = (site.spectrum(self.diffuse), site.spectrum(self.specular));
        let (d, s) = (diffuse.element_sum(), specular.element_sum());
        PolarizedPlastic {
            diffuse,
            specular,
            microfacet: self.roughness.resolve(site),
            eta: self.eta,
            reflection: if s > 0.0 { s / (d + s) } else { 0.0 },
        }
    }
}

/// A diffuse base under a rough reflection.
#[derive(Clone, Copy, Debug)]
pub struct PolarizedPlastic {
    /// ρd, per lane.
    diffuse: Vec4,
    /// ρs, per lane.
    specular: Vec4,
    microfacet: Microfacet,
    eta: f32,
    /// The probability of sampling the rough reflection, the same for all lanes.
    reflection: f32,
}

impl Bxdf for PolarizedPlastic {
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        if !(wo.z > 0.0 && wi.z > 0.0) {
            return (Vec4::ZERO, Vec4::ZERO);
        }
        let Some((m, cos)) = half_way(wo, wi) else {
            return (Vec4::ZERO, Vec4::ZERO);
        };
        let d = self.microfacet.d(m);
        let shadowing = self.microfacet.g(wo, wi, m);
        let reflected = fresnel::dielectric(cos, self.eta).0 * d * shadowing / (4.0 * wo.z);
        let enters = |cos: f32| 1.0 - fresnel::dielectric(cos.min(1.0), self.eta).0;
        let base = enters(wo.z) * enters(wi.z) * wi.z * FRAC_1_PI;
        let density = self.reflection * self.microfacet.density(wo, m, d) / (4.0 * cos)
            + (1.0 - self.reflection) * wi.z * FRAC_1_PI;
        let value = self.specular * reflected + self.diffuse * base;
        (value, Vec4::splat(density))
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        if !(wo.z > 0.0) {
            return None;
        }
        let wi = match u_lobe < self.reflection {
            true => reflect(wo, self.microfacet.sample(wo, u.to_array())),
            false => square_to_cosine_hemisphere(u),
        };
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
