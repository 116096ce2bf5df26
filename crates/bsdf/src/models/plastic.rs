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
use crate::models::coat::{Coat, Coating};
use crate::{Bxdf, ShadingContext};
use core::f32::consts::FRAC_1_PI;
use etalon_math::{DeltaProbability, Density};
use etalon_params::Params;
use etalon_sampling::warps::square_to_cosine_hemisphere;
use etalon_transport::{BsdfSample, Build, SamplePdf, Textures, TransportMode};
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
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> Plastic {
        Plastic {
            coat: Coating::in_lanes(|_| (&self.coating, site), self.internal),
        }
    }
}

/// A diffuse base under a smooth coat.
#[derive(Clone, Copy, Debug)]
pub struct Plastic {
    /// The coat and the base.
    pub coat: Coat,
}

impl Plastic {
    #[inline]
    fn transmitted(&self, cos: f32) -> f32 {
        1.0 - fresnel::dielectric(cos.min(1.0), self.coat.eta).0
    }

    /// The coat's reflection, where it is chosen with the probability `specular`.
    #[inline]
    fn mirrored(&self, wo: Vec3, transmitted: f32, specular: f32) -> BsdfSample {
        BsdfSample {
            wi: reflect(wo, Vec3::Z),
            value: self.coat.specular * (1.0 - transmitted),
            chance: SamplePdf::Discrete(DeltaProbability::uniform(specular)),
            eta: 1.0,
            is_null: false,
        }
    }
}

impl Bxdf for Plastic {
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        if !(wo.z > 0.0 && wi.z > 0.0) {
            return (Vec4::ZERO, Vec4::ZERO);
        }
        let transmitted = self.transmitted(wo.z);
        let probability = 1.0 - self.coat.specular_probability(transmitted);
        (
            self.coat.base(transmitted, self.transmitted(wi.z), wi.z),
            Vec4::splat(probability * wi.z * FRAC_1_PI),
        )
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        if !(wo.z > 0.0) {
            return None;
        }
        let transmitted = self.transmitted(wo.z);
        let specular = self.coat.specular_probability(transmitted);
        if u_lobe < specular {
            return Some(self.mirrored(wo, transmitted, specular));
        }
        let wi = square_to_cosine_hemisphere(u);
        let (value, density) = self.eval_and_density(wo, wi, mode);
        (density.x > 0.0).then_some(BsdfSample {
            wi,
            value,
            chance: SamplePdf::Continuous(Density::per_lane(density)),
            eta: 1.0,
            is_null: false,
        })
    }

    fn discrete(&self, wo: Vec3, index: u32, _: TransportMode) -> Option<BsdfSample> {
        (index == 0 && wo.z > 0.0).then(|| {
            let transmitted = self.transmitted(wo.z);
            self.mirrored(wo, transmitted, self.coat.specular_probability(transmitted))
        })
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

    fn albedo(&self, _: Vec3) -> Vec4 {
        self.coat.diffuse
    }
}
