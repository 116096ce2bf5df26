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
use crate::interface::refraction::{half_vector, reflect, refract};
use crate::interface::relative_index::RelativeIndex;
use crate::lane_bsdf_at_point::{LaneBxdf, albedo_toward_normal, nothing, spectra};
use crate::microfacet::Microfacet;
use crate::microfacet::roughness::Roughness;
use crate::{Bxdf, TextureSite};
use etalon_math::lane::{Lane, Mask, Select, Spectral, Vector, branch};
use etalon_params::Params;
use etalon_transport::{
    BsdfSample, Build, LaneBsdfSample, SpectrumKind, TextureId, Textures, TransportMode,
};
use glam::{Vec2, Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "roughdielectric alpha=f:0.3",
    "roughdielectric alpha_u=f:0.2 alpha_v=f:0.5 distribution=s:ggx int_ior=f:1.8",
    "roughdielectric alpha=f:0.4 masking=s:correlated",
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
    #[inline]
    pub fn resolve<T: Textures>(&self, site: &TextureSite<'_, T>) -> RoughDielectric {
        Self::in_lanes(|_| (self, site))
    }

    /// The models at several points.
    #[inline]
    pub(crate) fn in_lanes<'m, 's, F: Lane, T: Textures + 's>(
        at: impl Fn(usize) -> (&'m Self, &'s TextureSite<'s, T>),
    ) -> RoughDielectric<F> {
        let eta = |i: usize| {
            let (description, site) = at(i);
            description.eta.eval(site)
        };
        RoughDielectric {
            eta: F::Spectrum::of_lanes(eta),
            reflectance: spectra::<F, _, T>(&at, |description| description.reflectance),
            transmittance: spectra::<F, _, T>(&at, |description| description.transmittance),
            microfacet: Roughness::in_lanes(|i| {
                let (description, site) = at(i);
                (&description.roughness, site)
            }),
        }
    }
}

/// A rough interface.
#[derive(Clone, Copy, Debug)]
pub struct RoughDielectric<F: Lane = f32> {
    /// Index inside over index outside, per wavelength.
    pub eta: F::Spectrum,
    /// Factor of the reflected light, per wavelength.
    pub reflectance: F::Spectrum,
    /// Factor of the refracted light, per wavelength.
    pub transmittance: F::Spectrum,
    /// The distribution of normals.
    pub microfacet: Microfacet<F>,
}

impl<F: Lane> RoughDielectric<F> {
    /// The relative index of the medium on the far side from `wo`, and the factor of z that brings
    /// `wo` to the upper side (the distribution of normals is the same from below).
    #[inline(always)]
    fn above(&self, wo: F::Vector) -> (F::Spectrum, F) {
        let inverse = F::Spectrum::uniform(F::ONE) / self.eta;
        let is_above = wo.z().gt(F::ZERO);
        is_above.select((self.eta, F::ONE), (inverse, F::splat(-1.0)))
    }

    /// The distribution from which normals are drawn: without visible normals a little rougher,
    /// which bounds the weights (Walter et al. 2007, section 5.3).
    #[inline(always)]
    fn sampled(&self, wo: F::Vector) -> Microfacet<F> {
        let rougher = F::splat(1.2) - wo.z().abs().sqrt() * 0.2;
        let visible = self.microfacet.sample_visible;
        self.microfacet.scaled(visible.select(F::ONE, rougher))
    }

    /// D and the density of a normal, when seen from `wo` above.
    #[inline(always)]
    fn normal_density(&self, wo: F::Vector, m: F::Vector) -> (F, F) {
        let d = self.microfacet.d(m);
        let sampled = self.sampled(wo);
        let sampled_d = branch!(self.microfacet.sample_visible, d, sampled.d(m));
        (d, sampled.density(wo, m, sampled_d))
    }

    /// Reflection between two directions above.
    #[inline(always)]
    fn reflection(
        &self,
        wo: F::Vector,
        wi: F::Vector,
        eta: F::Spectrum,
    ) -> (F::Spectrum, F::Spectrum) {
        let (has_normal, m, cos) = half_vector::<F>(wo, wi);
        let (d, density) = self.normal_density(wo, m);
        let shadowing = self.microfacet.g(wo, wi, m);
        let fresnel = fresnel::dielectric_spectrum(cos, eta).0;
        let value = self.reflectance * fresnel * (d * shadowing / (wo.z() * 4.0));
        let density = fresnel * (density / (cos * 4.0));
        has_normal.select((value, density), nothing::<F>())
    }

    /// Transmission of one wavelength from `wo` above to `wi` below, without the factor τ.
    #[inline(always)]
    fn transmission(&self, wo: F::Vector, wi: F::Vector, eta: F, mode: TransportMode) -> [F; 2] {
        let half = wo + wi * eta;
        let length = half.norm();
        let m = half.over(length.copysign(half.z()));
        let (cos_o, cos_i) = (wo.dot_product(m), wi.dot_product(m));
        // Not a microfacet seen from its back, nor one that does not separate the directions.
        let separates = cos_o.gt(F::ZERO) & cos_i.lt(F::ZERO) & length.gt(F::splat(1e-12));
        if !separates.any() {
            return [F::ZERO; 2];
        }
        let through = F::ONE - fresnel::dielectric(cos_o, eta).0;
        let (d, density) = self.normal_density(wo, m);
        let shadowing = self.microfacet.g(wo, wi, m);
        // |∂m/∂wi|, of which wo·m + η wi·m = ±|wo + η wi| (ibid., eq. 17).
        let jacobian = eta * eta * -cos_i / (length * length);
        let scale = match mode {
            TransportMode::Radiance => F::ONE / (eta * eta),
            TransportMode::Importance => F::ONE,
        };
        let value = scale * through * d * shadowing * cos_o * jacobian / wo.z();
        separates.select([value, through * density * jacobian], [F::ZERO; 2])
    }

    /// The same of every wavelength, with τ.
    #[inline(always)]
    fn refraction(
        &self,
        wo: F::Vector,
        wi: F::Vector,
        eta: F::Spectrum,
        mode: TransportMode,
    ) -> (F::Spectrum, F::Spectrum) {
        let (value, density) = if eta.is_uniform().all() {
            let [value, density] = self.transmission(wo, wi, eta.hero(), mode);
            (F::Spectrum::uniform(value), F::Spectrum::uniform(density))
        } else {
            let [a, b, c, d] = (eta.waves()).map(|eta| self.transmission(wo, wi, eta, mode));
            (
                F::Spectrum::from_waves([a[0], b[0], c[0], d[0]]),
                F::Spectrum::from_waves([a[1], b[1], c[1], d[1]]),
            )
        };
        (self.transmittance * value, density)
    }

    /// [`Bxdf::eval_and_density`] in lanes.
    #[inline(always)]
    pub(crate) fn eval_in(
        &self,
        wo: F::Vector,
        wi: F::Vector,
        mode: TransportMode,
    ) -> (F::Spectrum, F::Spectrum) {
        let in_surface = Lane::eq(wo.z(), F::ZERO) | Lane::eq(wi.z(), F::ZERO);
        let (eta, side) = self.above(wo);
        let (wo, wi) = (turned(wo, side), turned(wi, side));
        let both = branch!(
            wi.z().gt(F::ZERO),
            self.reflection(wo, wi, eta),
            self.refraction(wo, wi, eta, mode)
        );
        in_surface.select(nothing::<F>(), both)
    }

    /// [`Bxdf::sample`] in lanes.
    #[inline(always)]
    pub(crate) fn sample_in(
        &self,
        wo: F::Vector,
        u_lobe: F,
        u: [F; 2],
        mode: TransportMode,
    ) -> LaneBsdfSample<F> {
        let (eta, side) = self.above(wo);
        let (up, eta) = (turned(wo, side), eta.hero());
        let m = self.sampled(up).sample(up, u);
        let cos = up.dot_product(m);
        let (fresnel, cos_t) = fresnel::dielectric(cos, eta);
        let reflects = u_lobe.lt(fresnel);
        let refracted = refract(up, m, eta, cos_t);
        let (wi, eta) = reflects.select((reflect(up, m), F::ONE), (refracted, eta));
        // Light that would leave on the wrong side is lost.
        let is_above = wi.z().gt(F::ZERO);
        let leaves = (reflects & is_above) | (!reflects & wi.z().lt(F::ZERO));
        let wi = turned(wi, side);
        let mut sample = LaneBsdfSample::continuous(wi, self.eval_in(wo, wi, mode), eta);
        sample.found = sample.found & leaves & cos.gt(F::ZERO);
        sample
    }
}

/// The direction with z times `side`.
#[inline(always)]
fn turned<F: Lane, V: Vector<F>>(w: V, side: F) -> V {
    let [x, y, z] = w.xyz();
    V::from_xyz(x, y, z * side)
}

impl<F: Lane> LaneBxdf<F> for RoughDielectric<F> {
    const CONTINUOUS: bool = true;
    const TRANSMITS: bool = true;

    #[inline(always)]
    fn eval_lanes(&self, wo: F::Vector, wi: F::Vector) -> (F::Spectrum, F::Spectrum) {
        self.eval_in(wo, wi, TransportMode::Radiance)
    }

    #[inline(always)]
    fn sample_lanes(&self, wo: F::Vector, u_lobe: F, u: [F; 2]) -> LaneBsdfSample<F> {
        self.sample_in(wo, u_lobe, u, TransportMode::Radiance)
    }

    #[inline(always)]
    fn albedo_lanes(&self, wo: F::Vector) -> F::Spectrum {
        albedo_toward_normal(self, wo)
    }
}

impl Bxdf for RoughDielectric {
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> (Vec4, Vec4) {
        self.eval_in(wo, wi, mode)
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        self.sample_in(wo, u_lobe, u.to_array(), mode).only()
    }

    fn has_continuous(&self) -> bool {
        true
    }

    fn has_discrete(&self) -> bool {
        false
    }
}
