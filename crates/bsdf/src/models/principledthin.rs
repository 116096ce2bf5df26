//! `principledthin`: Burley's material for thin sheets (see [`crate::models::disney`]), as Mitsuba has it.
//!
//! Both sides are alike. With t = spec_trans, d = diff_trans/2, and wi' = wi with |z|:
//!
//! ```text
//! base             (1 − t)(1 − d) · f of [`crate::models::disney`]
//! through, diffuse (1 − t) d · colour/π
//! reflected        t F' D G / (4 cos θo cos θi),    F' = lerp(F, R0 tint + (1 − R0 tint)(1 − cos θd)⁵, spec_tint)
//! through, glossy  t colour (1 − F) D' G' / (4 cos θo cos θi)  at wi', m ∥ wo + wi'
//! ```
//!
//! where D' has the roughness (0.65 η − 0.35) · roughness (Burley 2015, section 5.2, figure 15). Light that arrives
//! on the wrong side of m is dropped, as in Mitsuba, though not from the density.

use crate::inputs::inputs;
use crate::interface::fresnel;
use crate::interface::refraction::{half_way, reflect};
use crate::microfacet::Microfacet;
use crate::models::disney::{self, DisneyBase, is_used, sampling_rate, schlick_entering};
use crate::{Bxdf, MaterialFlags, ShadingContext};
use core::f32::consts::FRAC_1_PI;
use etalon_params::Params;
use etalon_sampling::warps::square_to_cosine_hemisphere;
use etalon_transport::{BsdfSample, Build, Textures, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "principledthin",
    "principledthin base_color=t:400:0.1,700:0.8 roughness=f:0.5 spec_trans=f:0.6 diff_trans=f:0.8 \
     spec_tint=f:0.4 anisotropic=f:0.5 sheen=f:0.3 sheen_tint=f:0.2 flatness=f:0.5 eta=f:1.4",
    "principledthin base_color=u:0.8 spec_trans=f:1 roughness=f:0.6 eta=f:1.6",
];

inputs! {
    /// Parameters, each of which may be a texture.
    Inputs;
    /// Their values at a point.
    Values {
        /// The colour.
        base_color: spectrum = 0.5,
        /// Roughness; α is its square.
        roughness: share = 0.5,
        /// How much the roughness differs along x and y.
        anisotropic: share = 0.0,
        /// The share of the glossy lobes.
        spec_trans: share = 0.0,
        /// Index of refraction inside over outside.
        eta: amount = 1.5,
        /// How much the colour tints the reflection.
        spec_tint: share = 0.0,
        /// Sheen.
        sheen: amount = 0.0,
        /// How much the colour tints the sheen.
        sheen_tint: share = 0.0,
        /// The share of a base that scatters below the surface.
        flatness: share = 0.0,
        /// How much of the diffuse light passes, of 2.
        diff_trans: amount = 0.0,
    }
}

/// `principledthin` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    inputs: Inputs,
    transmits: bool,
    /// Sampling rates of diffuse and glossy reflection, glossy and diffuse transmission.
    rates: Vec4,
}

impl Description {
    /// Reads [`Inputs`], and the rates `diffuse_reflectance_sampling_rate`, `specular_reflectance_sampling_rate`,
    /// `specular_transmittance_sampling_rate` and `diffuse_transmittance_sampling_rate` (1).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let rate = |name: &str| sampling_rate(params, name);
        Some(Self {
            inputs: Inputs::from_params(params, build),
            transmits: is_used(params, "spec_trans") || is_used(params, "diff_trans"),
            rates: Vec4::new(
                rate("diffuse_reflectance_sampling_rate"),
                rate("specular_reflectance_sampling_rate"),
                rate("specular_transmittance_sampling_rate"),
                rate("diffuse_transmittance_sampling_rate"),
            ),
        })
    }

    /// Its flags.
    pub fn flags(&self) -> MaterialFlags {
        MaterialFlags {
            transmission: self.transmits,
            ..MaterialFlags::reflecting(self)
        }
    }

    /// The model at a point.
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> PrincipledThin {
        let at = self.inputs.at(site);
        let tinted = at.spec_tint > 0.0 || at.sheen_tint > 0.0;
        let tint = disney::tint(site, self.inputs.base_color, at.base_color, tinted);
        let passing = (0.5 * at.diff_trans).min(1.0);
        let base = (1.0 - at.spec_trans) * (1.0 - passing);
        let diffuse = (1.0 - at.spec_trans) * passing;
        let glossy = 0.5 * at.spec_trans;
        let rates = Vec4::new(base, glossy, glossy, diffuse) * self.rates;
        let total = rates.element_sum();
        PrincipledThin {
            colour: at.base_color,
            tint,
            base,
            diffuse,
            glossy: at.spec_trans,
            spec_tint: at.spec_tint,
            sheen: at.sheen,
            sheen_tint: at.sheen_tint,
            flatness: at.flatness,
            eta: at.eta.max(1e-3),
            roughness: at.roughness,
            anisotropic: at.anisotropic,
            probabilities: if total > 0.0 {
                rates / total
            } else {
                Vec4::ZERO
            },
        }
    }
}

/// The material at a point.
#[derive(Clone, Copy, Debug)]
pub struct PrincipledThin {
    /// The colour, per lane.
    colour: Vec4,
    /// The same with luminance one.
    tint: Vec4,
    /// (1 − t)(1 − d).
    base: f32,
    /// (1 − t) d.
    diffuse: f32,
    /// t.
    glossy: f32,
    spec_tint: f32,
    sheen: f32,
    sheen_tint: f32,
    flatness: f32,
    eta: f32,
    roughness: f32,
    anisotropic: f32,
    /// Of diffuse and glossy reflection, glossy and diffuse transmission.
    probabilities: Vec4,
}

impl PrincipledThin {
    fn base(&self) -> DisneyBase {
        DisneyBase {
            colour: self.colour * self.base,
            sheen: DisneyBase::sheen_colour(self.base * self.sheen, self.sheen_tint, self.tint),
            roughness: self.roughness,
            flatness: self.flatness,
        }
    }

    fn reflecting(&self) -> Microfacet {
        disney::microfacet(self.roughness, self.anisotropic)
    }

    fn passing(&self) -> Microfacet {
        let roughness = (0.65 * self.eta - 0.35) * self.roughness;
        disney::microfacet(roughness, self.anisotropic)
    }

    fn reflection(&self, wo: Vec3, wi: Vec3) -> (Vec4, f32) {
        let mut value = self.base().eval(wo, wi);
        let mut density = self.probabilities.x * wi.z * FRAC_1_PI;
        if let Some((m, cos)) = half_way(wo, wi)
            && self.glossy > 0.0
        {
            let microfacet = self.reflecting();
            let d = microfacet.d(m);
            let shadowing = microfacet.g1(wo, m) * microfacet.g1(wi, m);
            let plain = Vec4::splat(fresnel::dielectric(cos, self.eta).0);
            let tinted = (disney::normal_reflectance(self.eta) * self.tint)
                .lerp(Vec4::ONE, schlick_entering(cos, self.eta));
            let fresnel = plain.lerp(tinted, self.spec_tint);
            value += fresnel * (self.glossy * d * shadowing / (4.0 * wo.z));
            density += self.probabilities.y * microfacet.density(wo, m, d) / (4.0 * cos);
        }
        (value, density)
    }

    fn transmission(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> (Vec4, f32) {
        let mut value = self.colour * (self.diffuse * FRAC_1_PI * -wi.z);
        let mut density = self.probabilities.w * -wi.z * FRAC_1_PI;
        let above = Vec3::new(wi.x, wi.y, -wi.z);
        if let Some((m, cos)) = half_way(wo, above)
            && self.glossy > 0.0
        {
            let microfacet = self.passing();
            let d = microfacet.d(m);
            // Light on the back of a microfacet is dropped, which is not reciprocal.
            let arriving = match mode {
                TransportMode::Radiance => wi,
                TransportMode::Importance => Vec3::new(wo.x, wo.y, -wo.z),
            };
            let shadowing = if arriving.dot(m) < 0.0 {
                microfacet.g1(wo, m) * microfacet.g1(above, m)
            } else {
                0.0
            };
            let through = self.glossy * (1.0 - fresnel::dielectric(cos, self.eta).0);
            value += self.colour * (through * d * shadowing / (4.0 * wo.z));
            density += self.probabilities.z * microfacet.density(wo, m, d) / (4.0 * cos);
        }
        (value, density)
    }
}

impl Bxdf for PrincipledThin {
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> (Vec4, Vec4) {
        let side = Vec3::new(1.0, 1.0, 1.0f32.copysign(wo.z));
        let (wo, wi) = (wo * side, wi * side);
        if wo.z == 0.0 || wi.z == 0.0 {
            return (Vec4::ZERO, Vec4::ZERO);
        }
        let (value, density) = if wi.z > 0.0 {
            self.reflection(wo, wi)
        } else {
            self.transmission(wo, wi, mode)
        };
        (value, Vec4::splat(density))
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        let up = Vec3::new(wo.x, wo.y, wo.z.abs());
        if up.z == 0.0 {
            return None;
        }
        let [base, reflected, passed, _] = self.probabilities.to_array();
        let beyond = Vec3::new(1.0, 1.0, -1.0);
        let mirrored = |microfacet: Microfacet| {
            let wi = reflect(up, microfacet.sample(up, u.to_array()));
            (wi.z > 0.0).then_some(wi)
        };
        let wi = if u_lobe < base {
            square_to_cosine_hemisphere(u)
        } else if u_lobe < base + reflected {
            mirrored(self.reflecting())?
        } else if u_lobe < base + reflected + passed {
            mirrored(self.passing())? * beyond
        } else {
            square_to_cosine_hemisphere(u) * beyond
        };
        let wi = if wo.z > 0.0 { wi } else { wi * beyond };
        self.continuous(wo, wi, 1.0, mode)
    }

    fn has_continuous(&self) -> bool {
        true
    }

    fn has_discrete(&self) -> bool {
        false
    }

    fn transmits(&self) -> bool {
        self.glossy > 0.0 || self.diffuse > 0.0
    }

    fn albedo(&self, _: Vec3) -> Vec4 {
        self.colour
    }
}
