//! A smooth interface between two dielectrics.
//!
//! ```text
//! f(wo, wi) |cos θi| = ρ F δ(wi = mirror of wo) + τ (1 − F) s δ(wi = refraction of wo)
//! ```
//!
//! F by Fresnel's equations, the direction by Snell's law, s = 1/η² for radiance (which is
//! compressed on its way into the denser medium) and 1 for importance (Veach 1997, section 5.2).
//!
//! With dispersion each lane has its own η. A refracted direction is that of lane 0; the lanes
//! that would have gone elsewhere have probability and value zero there, so that one
//! wavelength survives. Reflection keeps all four.

use crate::interface::fresnel;
use crate::interface::refraction::reflect;
use crate::interface::relative_index::RelativeIndex;
use crate::{Bxdf, ShadingContext};
use etalon_math::DeltaProbability;
use etalon_params::Params;
use etalon_transport::{
    BsdfSample, Build, SamplePdf, SpectrumKind, TextureId, Textures, TransportMode,
};
use glam::{Vec2, Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "dielectric",
    "dielectric int_ior=f:1 ext_ior=f:1.7",
    "dielectric int_ior=s:cauchy:1.5,0.01 specular_reflectance=u:0.5 specular_transmittance=u:0.7",
];

/// `dielectric` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    eta: RelativeIndex,
    reflectance: TextureId,
    transmittance: TextureId,
}

impl Description {
    /// Reads `int_ior` (bk7), `ext_ior` (air), `specular_reflectance` (1) and
    /// `specular_transmittance` (1).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let mut factor = |name| build.texture(params, name, Some(1.0), SpectrumKind::Reflectance);
        let reflectance = factor("specular_reflectance");
        let transmittance = factor("specular_transmittance");
        Some(Self {
            eta: RelativeIndex::from_params(params, build, "bk7")?,
            reflectance,
            transmittance,
        })
    }

    /// The model at a point.
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> Dielectric {
        Dielectric {
            eta: self.eta.eval(site),
            reflectance: site.spectrum(self.reflectance),
            transmittance: site.spectrum(self.transmittance),
            mirrored: 0.0,
        }
    }
}

/// A smooth interface.
#[derive(Clone, Copy, Debug)]
pub struct Dielectric {
    /// Index inside over index outside, per lane.
    pub eta: Vec4,
    /// Factor of the reflected light, per lane.
    pub reflectance: Vec4,
    /// Factor of the refracted light, per lane.
    pub transmittance: Vec4,
    /// Share of light that is mirrored independently of Fresnel's equations; nonzero only in [`crate::models::mixture`].
    pub mirrored: f32,
}

impl Bxdf for Dielectric {
    fn eval_and_density(&self, _: Vec3, _: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        (Vec4::ZERO, Vec4::ZERO)
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, _: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        let (eta, fresnel) = self.interface(wo)?;
        if u_lobe < fresnel.x {
            Some(self.reflected(wo, fresnel))
        } else {
            self.refracted(wo, eta, fresnel, mode)
        }
    }

    fn discrete(&self, wo: Vec3, index: u32, mode: TransportMode) -> Option<BsdfSample> {
        let (eta, fresnel) = self.interface(wo)?;
        match index {
            0 => Some(self.reflected(wo, fresnel)),
            // Other lanes may refract where lane 0 is reflected, so there always are two.
            1 => Some(
                (self.refracted(wo, eta, fresnel, mode)).unwrap_or(BsdfSample {
                    wi: -wo,
                    value: Vec4::ZERO,
                    chance: SamplePdf::Discrete(DeltaProbability(Vec4::ZERO)),
                    eta: 1.0,
                    is_null: false,
                }),
            ),
            _ => None,
        }
    }

    fn has_continuous(&self) -> bool {
        false
    }

    fn has_discrete(&self) -> bool {
        true
    }
}

impl Dielectric {
    /// The relative index of the medium entered, whichever side `wo` is on, and the share that is
    /// reflected; `None` for a direction in the surface.
    #[inline]
    fn interface(&self, wo: Vec3) -> Option<(Vec4, Vec4)> {
        let eta = if wo.z > 0.0 {
            self.eta
        } else {
            self.eta.recip()
        };
        (wo.z != 0.0).then(|| {
            let fresnel = fresnel::dielectric_spectrum(wo.z.abs(), eta);
            (eta, fresnel + self.mirrored * (1.0 - fresnel))
        })
    }

    #[inline]
    fn reflected(&self, wo: Vec3, fresnel: Vec4) -> BsdfSample {
        BsdfSample {
            wi: reflect(wo, Vec3::Z),
            value: self.reflectance * fresnel,
            chance: SamplePdf::Discrete(DeltaProbability(fresnel)),
            eta: 1.0,
            is_null: false,
        }
    }

    #[inline]
    fn refracted(
        &self,
        wo: Vec3,
        eta: Vec4,
        fresnel: Vec4,
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        let (_, cos_t) = fresnel::dielectric(wo.z.abs(), eta.x);
        let together = Vec4::select(eta.cmpeq(Vec4::splat(eta.x)), Vec4::ONE, Vec4::ZERO);
        let transmitted = (1.0 - fresnel) * together;
        let scale = match mode {
            TransportMode::Radiance => 1.0 / (eta.x * eta.x),
            TransportMode::Importance => 1.0,
        };
        (transmitted.x > 0.0).then(|| BsdfSample {
            wi: Vec3::new(-wo.x / eta.x, -wo.y / eta.x, cos_t.copysign(-wo.z)).normalize(),
            value: self.transmittance * transmitted * scale,
            chance: SamplePdf::Discrete(DeltaProbability(transmitted)),
            eta: eta.x,
            is_null: false,
        })
    }
}
