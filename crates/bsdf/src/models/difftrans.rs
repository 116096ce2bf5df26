//! Diffuse transmission, as of paper or a leaf: light leaves on the other side, in all directions alike.
//!
//! ```text
//! f(wo, wi) = τ / π      if cos θo and cos θi have different signs
//! ```
//!
//! Mitsuba 0.6's plugin of that name. Sampled with density |cos θi| / π.

use crate::{Bxdf, MaterialFlags, ShadingContext};
use core::f32::consts::FRAC_1_PI;
use etalon_params::Params;
use etalon_sampling::warps::square_to_cosine_hemisphere;
use etalon_transport::{BsdfSample, Build, SpectrumKind, TextureId, Textures, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &["difftrans", "difftrans transmittance=t:400:0.1,700:0.9"];

/// `difftrans` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    transmittance: TextureId,
}

impl Description {
    /// Reads `transmittance` (0.5).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let role = SpectrumKind::Reflectance;
        Some(Self {
            transmittance: build.texture(params, "transmittance", Some(0.5), role),
        })
    }

    /// One lobe, which transmits.
    pub fn flags(&self) -> MaterialFlags {
        MaterialFlags::refracting(self)
    }

    /// The model at a point.
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> DiffuseTransmission {
        DiffuseTransmission {
            transmittance: site.spectrum(self.transmittance),
        }
    }
}

/// Diffuse transmission.
#[derive(Clone, Copy, Debug)]
pub struct DiffuseTransmission {
    /// τ, the fraction of light transmitted, per lane.
    transmittance: Vec4,
}

impl Bxdf for DiffuseTransmission {
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        let density = match wo.z * wi.z < 0.0 {
            true => wi.z.abs() * FRAC_1_PI,
            false => 0.0,
        };
        (self.transmittance * density, Vec4::splat(density))
    }

    fn sample(&self, wo: Vec3, _: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        let up = square_to_cosine_hemisphere(u);
        let wi = Vec3::new(up.x, up.y, up.z.copysign(-wo.z));
        (wo.z != 0.0)
            .then(|| self.continuous(wo, wi, 1.0, mode))
            .flatten()
    }

    fn has_continuous(&self) -> bool {
        true
    }

    fn has_discrete(&self) -> bool {
        false
    }
}
