//! A rough interface between two dielectrics.
//!
//! ```text
//! reflected    f = ρ F D G / (4 |cos θo cos θi|)                            m ∥ wo + wi
//! transmitted  f = τ (1 − F) D G s η² |wo·m| |wi·m| / (|cos θo cos θi| (wo·m + η wi·m)²)
//!                                                                           m ∥ wo + η wi
//! ```
//!
//! Walter, Marschner, Li & Torrance (2007), *Microfacet Models for Refraction through Rough
//! Surfaces*, eqs. 20 and 21; η is the index entered over the index left, s = 1/η² for radiance
//! and 1 for importance. Sampled through the normals visible from `wo`, then by F at that normal.
//!
//! With dispersion each lane has its own η, hence its own normal m for a pair of directions, and
//! its own density: all four lanes stay alive.

use crate::interface::fresnel;
use crate::interface::refraction::{half_way, reflect, refract};
use crate::interface::relative_index::RelativeIndex;
use crate::microfacet::Microfacet;
use crate::microfacet::roughness::Roughness;
use crate::{Bxdf, ShadingContext};
use etalon_math::Density;
use etalon_params::Params;
use etalon_transport::{
    BsdfSample, Build, SamplePdf, SpectrumKind, TextureId, Textures, TransportMode,
};
use glam::{Vec2, Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "roughdielectric alpha=f:0.3",
    "roughdielectric alpha_u=f:0.2 alpha_v=f:0.5 distribution=s:ggx int_ior=f:1.8",
    "roughdielectric alpha=f:0.4 sample_visible=b:false specular_reflectance=u:0.8 \
     specular_transmittance=u:0.6",
    "roughdielectric alpha=f:0.3 distribution=s:ggx int_ior=s:cauchy:1.4,0.05",
    "roughdielectric alpha=f:0.35 ext_ior=s:diamond int_ior=s:sellmeier:1.03961212,0.231792344,\
     1.01046945,0.00600069867,0.0200179144,103.560653",
];

/// `roughdielectric` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    eta: RelativeIndex,
    reflectance: TextureId,
    transmittance: TextureId,
    roughness: Roughness,
}

impl Description {
    /// Reads `int_ior` (bk7), `ext_ior` (air), which must differ, `specular_reflectance` (1),
    /// `specular_transmittance` (1) and the roughness (see [`Roughness`]).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let mut factor = |name| build.texture(params, name, Some(1.0), SpectrumKind::Reflectance);
        let reflectance = factor("specular_reflectance");
        let transmittance = factor("specular_transmittance");
        let eta = RelativeIndex::from_params(params, build, "bk7");
        let roughness = Roughness::from_params(params, build);
        let eta = eta?;
        if matches!(eta, RelativeIndex::Constant(1.0)) {
            params.error("the indices inside and outside must differ");
            return None;
        }
        Some(Self {
            eta,
            reflectance,
            transmittance,
            roughness: roughness?,
        })
    }

    /// The model at a point.
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> RoughDielectric {
        RoughDielectric {
            eta: self.eta.eval(site),
            reflectance: site.spectrum(self.reflectance),
            transmittance: site.spectrum(self.transmittance),
            microfacet: self.roughness.resolve(site),
        }
    }
}

/// A rough interface.
#[derive(Clone, Copy, Debug)]
pub struct RoughDielectric {
    /// Index inside over index outside, per lane.
    pub eta: Vec4,
    /// Factor of the reflected light, per lane.
    pub reflectance: Vec4,
    /// Factor of the refracted light, per lane.
    pub transmittance: Vec4,
    /// The distribution of normals.
    pub microfacet: Microfacet,
}

impl RoughDielectric {
    /// The relative index of the medium on the far side from `wo`, and the mirror that brings
    /// `wo` to the upper side (the distribution of normals is the same from below).
    #[inline]
    fn above(&self, wo: Vec3) -> (Vec4, Vec3) {
        if wo.z > 0.0 {
            (self.eta, Vec3::ONE)
        } else {
            (self.eta.recip(), Vec3::new(1.0, 1.0, -1.0))
        }
    }

    /// The distribution from which normals are drawn: without visible normals a little rougher,
    /// which bounds the weights (Walter et al. 2007, section 5.3).
    #[inline]
    fn sampled(&self, wo: Vec3) -> Microfacet {
        if self.microfacet.sample_visible {
            self.microfacet
        } else {
            self.microfacet.scaled(1.2 - 0.2 * wo.z.abs().sqrt())
        }
    }

    /// D and the density of a normal, when seen from `wo` above.
    #[inline]
    fn normal_density(&self, wo: Vec3, m: Vec3) -> (f32, f32) {
        let d = self.microfacet.d(m);
        if self.microfacet.sample_visible {
            (d, self.microfacet.density(wo, m, d))
        } else {
            let sampled = self.sampled(wo);
            (d, sampled.density(wo, m, sampled.d(m)))
        }
    }

    /// Reflection between two directions above.
    fn reflection(&self, wo: Vec3, wi: Vec3, eta: Vec4) -> (Vec4, Vec4) {
        let Some((m, cos)) = half_way(wo, wi) else {
            return (Vec4::ZERO, Vec4::ZERO);
        };
        let (d, density) = self.normal_density(wo, m);
        let shadowing = self.microfacet.g1(wo, m) * self.microfacet.g1(wi, m);
        let fresnel = fresnel::dielectric_spectrum(cos, eta);
        (
            self.reflectance * fresnel * (d * shadowing / (4.0 * wo.z)),
            fresnel * (density / (4.0 * cos)),
        )
    }

    /// Transmission of one lane from `wo` above to `wi` below, without the factor τ.
    fn transmission(&self, wo: Vec3, wi: Vec3, eta: f32, mode: TransportMode) -> (f32, f32) {
        let half = wo + wi * eta;
        let length = half.length();
        if !(length > 1e-12) {
            return (0.0, 0.0);
        }
        let m = half / length.copysign(half.z);
        let (cos_o, cos_i) = (wo.dot(m), wi.dot(m));
        // A microfacet seen from its back, or one that does not separate the directions.
        if !(cos_o > 0.0 && cos_i < 0.0) {
            return (0.0, 0.0);
        }
        let through = 1.0 - fresnel::dielectric(cos_o, eta).0;
        let (d, density) = self.normal_density(wo, m);
        let shadowing = self.microfacet.g1(wo, m) * self.microfacet.g1(wi, m);
        // |∂m/∂wi|, of which wo·m + η wi·m = ±|wo + η wi| (ibid., eq. 17).
        let jacobian = eta * eta * -cos_i / (length * length);
        let scale = match mode {
            TransportMode::Radiance => 1.0 / (eta * eta),
            TransportMode::Importance => 1.0,
        };
        (
            scale * through * d * shadowing * cos_o * jacobian / wo.z,
            through * density * jacobian,
        )
    }
}

impl Bxdf for RoughDielectric {
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> (Vec4, Vec4) {
        if wo.z == 0.0 || wi.z == 0.0 {
            return (Vec4::ZERO, Vec4::ZERO);
        }
        let (eta, mirror) = self.above(wo);
        let (wo, wi) = (wo * mirror, wi * mirror);
        if wi.z > 0.0 {
            return self.reflection(wo, wi, eta);
        }
        let (value, density) = if eta == Vec4::splat(eta.x) {
            let (value, density) = self.transmission(wo, wi, eta.x, mode);
            (Vec4::splat(value), Vec4::splat(density))
        } else {
            let lanes = eta
                .to_array()
                .map(|eta| self.transmission(wo, wi, eta, mode));
            (
                Vec4::from_array(lanes.map(|lane| lane.0)),
                Vec4::from_array(lanes.map(|lane| lane.1)),
            )
        };
        (self.transmittance * value, density)
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let (eta, mirror) = self.above(wo);
        let up = wo * mirror;
        let m = self.sampled(up).sample(up, u.to_array());
        let cos = up.dot(m);
        if !(cos > 0.0) {
            return None;
        }
        let (fresnel, cos_t) = fresnel::dielectric(cos, eta.x);
        // Light that would leave on the wrong side is lost.
        let (wi, eta) = if u_lobe < fresnel {
            let wi = reflect(up, m);
            (wi.z > 0.0).then_some((wi, 1.0))
        } else {
            let wi = refract(up, m, eta.x, cos_t);
            (wi.z < 0.0).then_some((wi, eta.x))
        }?;
        let wi = wi * mirror;
        let (value, density) = self.eval_and_density(wo, wi, mode);
        (density.x > 0.0).then_some(BsdfSample {
            wi,
            value,
            chance: SamplePdf::Continuous(Density::per_lane(density)),
            eta,
            is_null: false,
        })
    }

    fn has_continuous(&self) -> bool {
        true
    }

    fn has_discrete(&self) -> bool {
        false
    }
}
