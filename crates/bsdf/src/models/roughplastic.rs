//! A diffuse base under a rough dielectric coat.
//!
//! ```text
//! f(wo, wi) = ρs F(wo·m) D(m) G(wo, wi, m) / (4 cos θo cos θi) + f_base(wo, wi)
//! ```
//!
//! from the front, with the rough interface's transmittance T and internal reflectance R in
//! f_base (see [`crate::models::coat`] and [`crate::interface::rough_fresnel`]). Mitsuba's plugin of that name.

use crate::interface::fresnel;
use crate::interface::refraction::{half_way, reflect};
use crate::interface::rough_fresnel::RoughFresnel;
use crate::microfacet::Microfacet;
use crate::microfacet::roughness;
use crate::models::coat::{Coat, Coating};
use crate::{Bxdf, ShadingContext};
use core::f32::consts::FRAC_1_PI;
use etalon_params::Params;
use etalon_sampling::warps::square_to_cosine_hemisphere;
use etalon_transport::{BsdfSample, Build, Textures, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "roughplastic alpha=f:0.2",
    "roughplastic alpha=f:0.4 distribution=s:ggx nonlinear=b:true diffuse_reflectance=t:400:0.1,700:0.9",
    "roughplastic alpha=f:0.3 diffuse_reflectance=u:0",
    "roughplastic alpha=f:0.3 specular_reflectance=u:0 sample_visible=b:false",
];

/// `roughplastic` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    coating: Coating,
    microfacet: Microfacet,
    interface: Box<RoughFresnel>,
}

impl Description {
    /// Reads what [`Coating`] does, `distribution` (beckmann), `alpha` (0.1, one number) and
    /// `sample_visible` (true).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let microfacet = roughness::constant_from_params(params);
        let coating = Coating::from_params(params, build)?;
        Some(Self {
            interface: Box::new(RoughFresnel::new(microfacet, coating.eta as f32)),
            coating,
            microfacet,
        })
    }

    /// The model at a point.
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> RoughPlastic<'_> {
        RoughPlastic {
            coat: self.coating.resolve(site, self.interface.internal),
            microfacet: self.microfacet,
            interface: &self.interface,
        }
    }
}

/// A diffuse base under a rough coat.
#[derive(Clone, Copy, Debug)]
pub struct RoughPlastic<'a> {
    /// The coat and the base.
    pub coat: Coat,
    /// The coat's distribution of normals.
    pub microfacet: Microfacet,
    /// Transmittance of the rough coating.
    pub interface: &'a RoughFresnel,
}

impl Bxdf for RoughPlastic<'_> {
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        if !(wo.z > 0.0 && wi.z > 0.0) {
            return (Vec4::ZERO, Vec4::ZERO);
        }
        let Some((m, cos)) = half_way(wo, wi) else {
            return (Vec4::ZERO, Vec4::ZERO);
        };
        let d = self.microfacet.d(m);
        let shadowing = self.microfacet.g1(wo, m) * self.microfacet.g1(wi, m);
        let reflected = fresnel::dielectric(cos, self.coat.eta).0 * d * shadowing / (4.0 * wo.z);
        let transmitted = self.interface.transmittance(wo.z);
        let value = self.coat.specular * reflected
            + self
                .coat
                .base(transmitted, self.interface.transmittance(wi.z), wi.z);
        let specular = self.coat.specular_probability(transmitted);
        let density = specular * self.microfacet.density(wo, m, d) / (4.0 * cos)
            + (1.0 - specular) * wi.z * FRAC_1_PI;
        (value, Vec4::splat(density))
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        if !(wo.z > 0.0) {
            return None;
        }
        let transmitted = self.interface.transmittance(wo.z);
        let wi = if u_lobe < self.coat.specular_probability(transmitted) {
            reflect(wo, self.microfacet.sample(wo, u.to_array()))
        } else {
            square_to_cosine_hemisphere(u)
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

    fn albedo(&self, _: Vec3) -> Vec4 {
        self.coat.diffuse
    }
}
