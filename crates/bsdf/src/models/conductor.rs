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
use crate::{Bxdf, ShadingContext};
use etalon_math::DeltaProbability;
use etalon_params::Params;
use etalon_transport::{
    BsdfSample, Build, SamplePdf, SpectrumKind, TextureId, Textures, TransportMode,
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
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> Conductor {
        let [eta, k] = Metal::in_lanes::<f32, T>(|_| (&self.metal, site));
        Conductor {
            eta,
            k,
            reflectance: site.spectrum(self.reflectance),
        }
    }
}

/// A coloured mirror.
#[derive(Clone, Copy, Debug)]
pub struct Conductor {
    /// Real part of the index, per lane.
    pub eta: Vec4,
    /// Imaginary part of the index, per lane.
    pub k: Vec4,
    /// Factor of the reflectance, per lane.
    pub reflectance: Vec4,
}

impl Bxdf for Conductor {
    fn eval_and_density(&self, _: Vec3, _: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        (Vec4::ZERO, Vec4::ZERO)
    }

    fn sample(&self, wo: Vec3, _: f32, _: Vec2, _: TransportMode) -> Option<BsdfSample> {
        if !(wo.z > 0.0) {
            return None;
        }
        Some(BsdfSample {
            wi: reflect(wo, Vec3::Z),
            value: self.reflectance * fresnel::conductor(wo.z.min(1.0), self.eta, self.k),
            chance: SamplePdf::Discrete(DeltaProbability::uniform(1.0)),
            eta: 1.0,
            is_null: false,
        })
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
