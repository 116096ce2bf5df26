//! A diffuse base under a smooth dielectric coat.
//!
//! ```text
//! f(wo, wi) |cos θi| = ρs F(θo) δ(wi = mirror of wo) + f_base(wo, wi) cos θi
//! ```
//!
//! from the front, with T = 1 − F in f_base (see [`crate::models::coat`]) and the internal
//! reflectance of [`crate::interface::fresnel::internal_diffuse_reflectance`]. Mitsuba's plugin of that
//! name.

use crate::interface::fresnel;
use crate::interface::refraction::reflect;
use crate::lane_bsdf_at_point::{LaneBxdf, nothing};
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
    "plastic",
    "plastic nonlinear=b:true int_ior=f:1.9 diffuse_reflectance=t:400:0.1,700:0.9",
];

/// `plastic` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    coating: Coating,
    internal: f32,
}

impl Description {
    /// Reads what [`Coating`] does.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let coating = Coating::from_params(params, build)?;
        Some(Self {
            internal: fresnel::internal_diffuse_reflectance(coating.eta) as f32,
            coating,
        })
    }

    /// The model at a point.
    #[inline]
    pub fn resolve<T: Textures>(&self, site: &TextureSite<'_, T>) -> Plastic {
        Self::in_lanes(|_| (self, site))
    }

    /// The models at several points.
    #[inline]
    pub(crate) fn in_lanes<'m, 's, F: Lane, T: Textures + 's>(
        at: impl Fn(usize) -> (&'m Self, &'s TextureSite<'s, T>),
    ) -> Plastic<F> {
        let coating = |i: usize| {
            let (description, site) = at(i);
            (&description.coating, site)
        };
        Plastic {
            coat: Coating::in_lanes(coating, F::from_fn(|i| at(i).0.internal)),
        }
    }
}

/// A diffuse base under a smooth coat.
#[derive(Clone, Copy, Debug)]
pub struct Plastic<F: Lane = f32> {
    /// The coat and the base.
    pub coat: Coat<F>,
}

impl<F: Lane> Plastic<F> {
    #[inline(always)]
    fn transmitted(&self, cos: F) -> F {
        F::ONE - fresnel::dielectric(cos.min(F::ONE), self.coat.eta).0
    }

    /// The direction of the coat's reflection, and its value and probability where T is `transmitted`.
    #[inline(always)]
    fn mirrored(&self, wo: F::Vector, transmitted: F) -> (F::Vector, (F::Spectrum, F::Spectrum)) {
        let wi = reflect(wo, F::Vector::broadcast(Vec3::Z));
        let value = self.coat.specular * (F::ONE - transmitted);
        let probability = self.coat.specular_probability(transmitted);
        (wi, (value, F::Spectrum::uniform(probability)))
    }
}

impl<F: Lane> LaneBxdf<F> for Plastic<F> {
    const CONTINUOUS: bool = true;
    const TRANSMITS: bool = false;

    #[inline(always)]
    fn eval_lanes(&self, wo: F::Vector, wi: F::Vector) -> (F::Spectrum, F::Spectrum) {
        let in_front = wo.z().gt(F::ZERO) & wi.z().gt(F::ZERO);
        if !in_front.any() {
            return nothing::<F>();
        }
        let transmitted = self.transmitted(wo.z());
        let probability = F::ONE - self.coat.specular_probability(transmitted);
        let value = (self.coat).base(transmitted, self.transmitted(wi.z()), wi.z());
        let density = F::Spectrum::uniform(probability * wi.z() * FRAC_1_PI);
        in_front.select((value, density), nothing::<F>())
    }

    #[inline(always)]
    fn sample_lanes(&self, wo: F::Vector, u_lobe: F, u: [F; 2]) -> LaneBsdfSample<F> {
        let transmitted = self.transmitted(wo.z());
        let is_delta = u_lobe.lt(self.coat.specular_probability(transmitted));
        let (wi, value_and_chance) = branch!(is_delta, self.mirrored(wo, transmitted), {
            let wi = cosine_hemisphere::<F>(u);
            (wi, self.eval_lanes(wo, wi))
        });
        let mut sample = LaneBsdfSample::continuous(wi, value_and_chance, F::ONE);
        sample.is_delta = is_delta;
        sample.found = sample.found & wo.z().gt(F::ZERO);
        sample
    }

    #[inline(always)]
    fn albedo_lanes(&self, _: F::Vector) -> F::Spectrum {
        self.coat.diffuse
    }
}

impl Bxdf for Plastic {
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        self.eval_lanes(wo, wi)
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, _: TransportMode) -> Option<BsdfSample> {
        self.sample_lanes(wo, u_lobe, u.to_array()).only()
    }

    fn discrete(&self, wo: Vec3, index: u32, _: TransportMode) -> Option<BsdfSample> {
        let (wi, value_and_chance) = self.mirrored(wo, self.transmitted(wo.z));
        let mut sample = LaneBsdfSample::<f32>::discrete(wi, value_and_chance, 1.0);
        sample.found = index == 0 && wo.z > 0.0;
        sample.only()
    }

    fn has_continuous(&self) -> bool {
        true
    }

    fn has_discrete(&self) -> bool {
        true
    }

    fn transmits(&self) -> bool {
        false
    }

    fn albedo(&self, wo: Vec3) -> Vec4 {
        self.albedo_lanes(wo)
    }
}
