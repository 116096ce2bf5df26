//! A diffuse base under a rough dielectric coat.
//!
//! ```text
//! f(wo, wi) = ρs F(wo·m) D(m) G(wo, wi, m) / (4 cos θo cos θi) + f_base(wo, wi)
//! ```
//!
//! from the front, with the rough interface's transmittance T and internal reflectance R in
//! f_base (see [`crate::models::coat`] and [`crate::interface::rough_fresnel`]). Mitsuba's plugin of that name.

use crate::interface::fresnel;
use crate::interface::refraction::{half_vector, reflect};
use crate::interface::rough_fresnel::RoughFresnel;
use crate::lane_bsdf_at_point::{LaneBxdf, nothing};
use crate::microfacet::Microfacet;
use crate::microfacet::roughness;
use crate::models::coat::{Coat, Coating};
use crate::{Bxdf, TextureSite};
use core::f32::consts::FRAC_1_PI;
use etalon_math::lane::{Lane, Mask, Select, Spectral, Vector, branch};
use etalon_params::Params;
use etalon_sampling::warps::cosine_hemisphere;
use etalon_transport::{BsdfSample, Build, LaneBsdfSample, Textures, TransportMode};
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
    #[inline]
    pub fn resolve<T: Textures>(&self, site: &TextureSite<'_, T>) -> RoughPlastic<'_> {
        Self::in_lanes(|_| (self, site))
    }

    /// The models at several points.
    #[inline]
    pub(crate) fn in_lanes<'m, 's, F: Lane, T: Textures + 's>(
        at: impl Fn(usize) -> (&'m Self, &'s TextureSite<'s, T>),
    ) -> RoughPlastic<'m, F> {
        let coating = |i: usize| {
            let (description, site) = at(i);
            (&description.coating, site)
        };
        RoughPlastic {
            coat: Coating::in_lanes(coating, F::from_fn(|i| at(i).0.interface.internal)),
            microfacet: Microfacet::of_lanes(|i| &at(i).0.microfacet),
            interface: F::array(|i| &*at(i).0.interface),
        }
    }
}

/// A diffuse base under a rough coat.
#[derive(Clone, Copy, Debug)]
pub struct RoughPlastic<'a, F: Lane = f32> {
    /// The coat and the base.
    pub coat: Coat<F>,
    /// The coat's distribution of normals.
    pub microfacet: Microfacet<F>,
    /// Transmittance of the rough coating.
    pub interface: F::Array<&'a RoughFresnel>,
}

impl<F: Lane> RoughPlastic<'_, F> {
    /// T at a cosine.
    #[inline(always)]
    fn transmitted(&self, cos: F) -> F {
        RoughFresnel::transmittance(self.interface, cos)
    }
}

impl<F: Lane> LaneBxdf<F> for RoughPlastic<'_, F> {
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
        let shadowing = self.microfacet.g1(wo, m) * self.microfacet.g1(wi, m);
        let fresnel = fresnel::dielectric(cos, self.coat.eta).0;
        let reflected = fresnel * d * shadowing / (wo.z() * 4.0);
        let transmitted = self.transmitted(wo.z());
        let value = self.coat.specular * reflected
            + (self.coat).base(transmitted, self.transmitted(wi.z()), wi.z());
        let specular = self.coat.specular_probability(transmitted);
        let density = specular * self.microfacet.density(wo, m, d) / (cos * 4.0)
            + (F::ONE - specular) * wi.z() * FRAC_1_PI;
        reflects.select((value, F::Spectrum::uniform(density)), nothing::<F>())
    }

    #[inline(always)]
    fn sample_lanes(&self, wo: F::Vector, u_lobe: F, u: [F; 2]) -> LaneBsdfSample<F> {
        let transmitted = self.transmitted(wo.z());
        let wi = branch!(
            u_lobe.lt(self.coat.specular_probability(transmitted)),
            reflect(wo, self.microfacet.sample(wo, u)),
            cosine_hemisphere::<F>(u)
        );
        LaneBsdfSample::continuous(wi, self.eval_lanes(wo, wi), F::ONE)
    }

    #[inline(always)]
    fn albedo_lanes(&self, _: F::Vector) -> F::Spectrum {
        self.coat.diffuse
    }
}

impl Bxdf for RoughPlastic<'_> {
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

    fn albedo(&self, wo: Vec3) -> Vec4 {
        self.albedo_lanes(wo)
    }
}
