//! `principled`: Burley's material of artists' parameters (see [`crate::models::disney`]), as Mitsuba has it.
//!
//! With m = metallic, t = spec_trans, b = (1 − m) t and GGX of α = roughness²:
//!
//! ```text
//! base          (1 − m)(1 − t) · f of [`crate::models::disney`], with the sheen's factor (1 − m)
//! reflected     F_p D G / (4 cos θo cos θi)
//!   front:      F_p = (1 − m)(1 − spec_tint) F + m S(colour) + (1 − m) spec_tint S(R0 · tint)
//!   back:       F_p = b F
//! transmitted   b √colour · (1 − F) …, see [`crate::models::roughdielectric`]
//! clear coat    ¼ clearcoat · S(0.04) · D₁ · G₁(α = ¼)
//! S(R)          = R + (1 − R)(1 − cos θd)⁵
//! D₁(m)         = (α² − 1) / (π ln α² (1 + (α² − 1) cos² θm)),   α = lerp(0.1, 0.001, clearcoat_gloss)
//! ```
//!
//! η is `eta`, or 2/(1 − √(0.08 specular)) − 1. A tint is the colour over its luminance
//! (a tabulated one over its mean). From behind only the
//! interface is seen. Directions are chosen by the base, the clear coat, or a visible normal, where reflection has the
//! probability 1 − b (1 − F).

use crate::inputs::inputs;
use crate::interface::fresnel;
use crate::interface::refraction::{half_way, reflect, refract};
use crate::microfacet::{Kind, Microfacet};
use crate::models::disney::{self, DisneyBase, schlick_entering};
use crate::models::roughdielectric::RoughDielectric;
use crate::{Bxdf, MaterialFlags, ShadingContext};
use core::f32::consts::FRAC_1_PI;
use etalon_math::float;
use etalon_params::{Params, Value};
use etalon_sampling::warps::square_to_cosine_hemisphere;
use etalon_transport::{BsdfSample, Build, Textures, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "principled",
    "principled base_color=t:400:0.1,700:0.8 metallic=f:0.7 specular=f:0.6 roughness=f:0.4 \
     spec_tint=f:0.4 anisotropic=f:0.5 sheen=f:0.3 sheen_tint=f:0.2 clearcoat=f:0.6 \
     clearcoat_gloss=f:0.1 spec_trans=f:0.4",
    "principled base_color=u:0.9 spec_trans=f:0.9 roughness=f:0.6 eta=f:1.4",
    "principled flatness=f:0.8 roughness=f:0.7 specular=f:0.2",
    "principled metallic=f:1 roughness=f:0.5 base_color=t:400:0.9,700:0.4",
];

inputs! {
    /// Parameters, each of which may be a texture.
    Inputs;
    /// Their values at a point.
    Values {
        /// Colour of the base and of metals; squared, the colour of transmission.
        base_color: spectrum = 0.5,
        /// Roughness; α is its square.
        roughness: share = 0.5,
        /// How much the roughness differs along x and y.
        anisotropic: share = 0.0,
        /// The share of metal.
        metallic: share = 0.0,
        /// Transmitting share of the non-metal.
        spec_trans: share = 0.0,
        /// How much the base's colour tints the reflection.
        spec_tint: share = 0.0,
        /// Sheen.
        sheen: amount = 0.0,
        /// How much the base's colour tints the sheen.
        sheen_tint: share = 0.0,
        /// The share of a base that scatters below the surface.
        flatness: share = 0.0,
        /// The clear coat.
        clearcoat: amount = 0.0,
        /// How smooth the clear coat is.
        clearcoat_gloss: share = 0.0,
    }
}

/// `principled` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    inputs: Inputs,
    eta: f32,
    transmits: bool,
    /// Sampling rates of the base, the main interface and the clear coat.
    rates: Vec3,
}

impl Description {
    /// Reads [`Inputs`], `eta` or `specular` (0.5), and the rates `diffuse_reflectance_sampling_rate`,
    /// `main_specular_sampling_rate` and `clearcoat_sampling_rate` (1).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let rate = |name: &str| sampling_rate(params, name);
        let rates = Vec3::new(
            rate("diffuse_reflectance_sampling_rate"),
            rate("main_specular_sampling_rate"),
            rate("clearcoat_sampling_rate"),
        );
        let transmits = is_used(params, "spec_trans");
        let eta = if params.has("eta") {
            if params.has("specular") {
                params.error_at("specular", "give either `eta` or `specular`");
                params.ignore(&["specular"]);
            }
            let positive = |eta: f64| eta > 0.0 && eta.is_finite();
            params.float_where("eta", 1.5, "a positive finite number", positive)
        } else {
            let accepted = "a number from 0 to below 12.5";
            let fits = |s: f64| (0.0..12.5).contains(&s);
            let specular = params.float_where("specular", 0.5, accepted, fits);
            // A transmitting material needs an interface.
            let least = if transmits { 1e-3 } else { 0.0 };
            2.0 / (1.0 - (0.08 * specular.max(least)).sqrt()) - 1.0
        };
        Some(Self {
            inputs: Inputs::from_params(params, build),
            eta: if transmits && eta == 1.0 {
                1.001
            } else {
                eta as f32
            },
            transmits,
            rates,
        })
    }

    /// Its flags.
    pub fn flags(&self) -> MaterialFlags {
        match self.transmits {
            true => MaterialFlags::refracting(self),
            false => MaterialFlags::reflecting(self),
        }
    }

    /// The model at a point.
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> Principled {
        let at = self.inputs.at(site);
        let tinted = at.spec_tint > 0.0 || at.sheen_tint > 0.0;
        let tint = disney::tint(site, self.inputs.base_color, at.base_color, tinted);
        let dielectric = 1.0 - at.metallic;
        let spec_trans = if self.transmits { at.spec_trans } else { 0.0 };
        let diffuse = dielectric * (1.0 - spec_trans);
        let rates = Vec3::new(diffuse, 1.0, 0.25 * at.clearcoat) * self.rates;
        let total = rates.element_sum();
        Principled {
            colour: at.base_color,
            tint,
            alpha: disney::microfacet(at.roughness, at.anisotropic)
                .alpha
                .into(),
            eta: self.eta,
            metallic: at.metallic,
            through: dielectric * spec_trans,
            tinted: dielectric * at.spec_tint,
            roughness: at.roughness,
            flatness: at.flatness,
            sheen: dielectric * at.sheen,
            sheen_tint: at.sheen_tint,
            clearcoat: at.clearcoat,
            coat_alpha: 0.1 + at.clearcoat_gloss * (0.001 - 0.1),
            base_probability: if total > 0.0 { rates.x / total } else { 0.0 },
            coat_probability: if total > 0.0 { rates.z / total } else { 0.0 },
        }
    }
}

/// The sampling rate of a lobe, relative to its energy.
pub(crate) fn sampling_rate(params: &Params<'_>, name: &str) -> f32 {
    let accepted = "a finite number, 0 or more";
    params.float_where(name, 1.0, accepted, |rate| rate >= 0.0 && rate.is_finite()) as f32
}

/// Whether a share is given, and not the number 0.
pub(crate) fn is_used(params: &Params<'_>, name: &str) -> bool {
    params
        .property(name)
        .is_some_and(|property| match property.value {
            Value::Float(number) => number != 0.0,
            Value::Integer(number) => number != 0,
            _ => true,
        })
}

/// The material at a point.
#[derive(Clone, Copy, Debug)]
pub struct Principled {
    /// The base's colour, per lane.
    colour: Vec4,
    /// The same with luminance one.
    tint: Vec4,
    /// α along x and y.
    alpha: Vec2,
    eta: f32,
    /// m.
    metallic: f32,
    /// b.
    through: f32,
    /// (1 − m) spec_tint.
    tinted: f32,
    roughness: f32,
    flatness: f32,
    /// (1 − m) sheen.
    sheen: f32,
    sheen_tint: f32,
    clearcoat: f32,
    coat_alpha: f32,
    base_probability: f32,
    coat_probability: f32,
}

impl Principled {
    #[inline]
    fn microfacet(&self) -> Microfacet {
        Microfacet::new(Kind::Ggx, self.alpha, true)
    }

    /// The base; of a fully transmitting material only its sheen remains.
    #[inline]
    fn base(&self) -> DisneyBase {
        DisneyBase {
            colour: self.colour * (1.0 - self.metallic - self.through).max(0.0),
            sheen: DisneyBase::sheen_colour(self.sheen, self.sheen_tint, self.tint),
            roughness: self.roughness,
            flatness: self.flatness,
        }
    }

    /// F_p, for a cosine to the half-way normal and the dielectric's reflectance.
    #[inline]
    fn fresnel(&self, cos: f32, dielectric: f32) -> Vec4 {
        // Σ w S(R) = Σ wR + (Σ w − Σ wR)(1 − cos θ)⁵.
        let normal = self.metallic * self.colour
            + (self.tinted * disney::normal_reflectance(self.eta)) * self.tint;
        let weight = self.metallic + self.tinted;
        let schlick = normal + (weight - normal) * schlick_entering(cos, self.eta);
        schlick + (1.0 - weight) * dielectric
    }

    /// The interface from the side of `wo`.
    fn rough(&self) -> RoughDielectric {
        RoughDielectric {
            eta: Vec4::splat(self.eta),
            reflectance: Vec4::ONE,
            transmittance: self.colour.max(Vec4::ZERO).sqrt() * self.through,
            microfacet: self.microfacet(),
        }
    }

    /// The probability that the main interface is sampled, in front.
    #[inline]
    fn interface_probability(&self) -> f32 {
        (1.0 - self.base_probability - self.coat_probability).max(0.0)
    }

    /// D₁.
    #[inline]
    fn coat_d(&self, m: Vec3) -> f32 {
        let a2 = self.coat_alpha * self.coat_alpha;
        let area = 1.0 + (a2 - 1.0) * m.z * m.z;
        FRAC_1_PI * (a2 - 1.0) / (float::ln(a2) * area)
    }

    /// A normal of the clear coat, with the density D₁ cos θ.
    #[inline]
    fn coat_normal(&self, u: Vec2) -> Vec3 {
        let a2 = self.coat_alpha * self.coat_alpha;
        let cos2 = (1.0 - float::exp(float::ln(a2) * (1.0 - u.y))) / (1.0 - a2);
        let (sin, cos) = float::sin_cos_turns(u.x);
        let radius = float::safe_sqrt(1.0 - cos2);
        Vec3::new(cos * radius, sin * radius, float::safe_sqrt(cos2))
    }

    /// Two directions in front.
    fn front(&self, wo: Vec3, wi: Vec3) -> (Vec4, Vec4) {
        let mut value = self.base().eval(wo, wi);
        let mut density = self.base_probability * wi.z * FRAC_1_PI;
        if let Some((m, cos)) = half_way(wo, wi) {
            let fresnel = fresnel::dielectric(cos, self.eta).0;
            let microfacet = self.microfacet();
            let d = microfacet.d(m);
            let reflected = self.fresnel(cos, fresnel);
            let shadowing = microfacet.g1(wo, m) * microfacet.g1(wi, m);
            value += reflected * (d * shadowing / (4.0 * wo.z));
            let reflects = 1.0 - self.through * (1.0 - fresnel);
            let normals = self.interface_probability() * reflects * microfacet.density(wo, m, d);
            let mut normals = normals / (4.0 * cos);
            if self.clearcoat > 0.0 {
                let (d, coat) = (
                    self.coat_d(m),
                    Microfacet::new(Kind::Ggx, Vec2::splat(0.25), true),
                );
                let fresnel = 0.04 + 0.96 * schlick_entering(cos, self.eta);
                let shadowing = coat.g1(wo, m) * coat.g1(wi, m);
                value += Vec4::splat(0.25 * self.clearcoat * fresnel * d * shadowing * wi.z);
                normals += self.coat_probability * d * m.z / (4.0 * cos);
            }
            density += normals;
        }
        (value, Vec4::splat(density))
    }
}

impl Bxdf for Principled {
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> (Vec4, Vec4) {
        if wo.z > 0.0 && wi.z > 0.0 {
            return self.front(wo, wi);
        }
        if wo.z == 0.0 || wi.z == 0.0 || !(self.through > 0.0) {
            return (Vec4::ZERO, Vec4::ZERO);
        }
        let (value, density) = self.rough().eval_and_density(wo, wi, mode);
        if wo.z < 0.0 {
            let reflected = if wi.z < 0.0 { self.through } else { 1.0 };
            (value * reflected, density)
        } else {
            (
                value,
                density * (self.interface_probability() * self.through),
            )
        }
    }

    fn sample(
        &self,
        wo: Vec3,
        mut u_lobe: f32,
        u: Vec2,
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        if !(wo.z > 0.0) {
            return (self.through > 0.0)
                .then(|| self.rough().sample(wo, u_lobe, u, mode))?
                .and_then(|sample| self.continuous(wo, sample.wi, sample.eta, mode));
        }
        let wi = if u_lobe < self.base_probability {
            square_to_cosine_hemisphere(u)
        } else if u_lobe < self.base_probability + self.coat_probability {
            reflect(wo, self.coat_normal(u))
        } else {
            let m = self.microfacet().sample(wo, u.to_array());
            let cos = wo.dot(m);
            if !(cos > 0.0) {
                return None;
            }
            let before = self.base_probability + self.coat_probability;
            u_lobe = (u_lobe - before) / (1.0 - before);
            let (fresnel, cos_t) = fresnel::dielectric(cos, self.eta);
            if u_lobe >= 1.0 - self.through * (1.0 - fresnel) {
                let wi = refract(wo, m, self.eta, cos_t);
                return (wi.z < 0.0).then(|| self.continuous(wo, wi, self.eta, mode))?;
            }
            reflect(wo, m)
        };
        // Light that would be reflected into the surface is lost.
        (wi.z > 0.0).then(|| self.continuous(wo, wi, 1.0, mode))?
    }

    fn has_continuous(&self) -> bool {
        true
    }

    fn has_discrete(&self) -> bool {
        false
    }

    fn transmits(&self) -> bool {
        self.through > 0.0
    }

    fn albedo(&self, _: Vec3) -> Vec4 {
        self.colour
    }
}
