//! Rough diffuse surfaces, whose facets are Lambertian: the model of Oren & Nayar, and one that keeps energy.
//!
//! ```text
//! oren-nayar:  f = ρ/π (C₁ + cos Δφ C₂ tan β + (1 − |cos Δφ|) C₃ tan((α + β)/2)) + 0.17 ρ²/π σ²/(σ² + 0.13) (1 − cos Δφ (2β/π)²)
//! eon:         f = ρ/π A (1 + r s/t) + ρ'/π (1 − E(θo)) (1 − E(θi)) / (1 − Ē)
//! ```
//!
//! Oren & Nayar (1994), *Generalization of Lambert's Reflectance Model*, eqs. 30 and 31: α and β are the larger and the
//! smaller of both angles to the normal, C₁ to C₃ functions of the facets' standard deviation σ; `use_fast_approx` takes
//! eq. 35, in which light meets one facet only. Portsmouth, Kutz & Hill (2025), *EON: A practical energy-preserving rough
//! diffuse BRDF*, JCGT 14(1), eqs. 8, 17 and 23: with s = cos of the angle between both directions less cos θi cos θo, t = max(cos θi, cos θo) for s > 0 and else
//! 1, E the albedo of the first term at ρ = 1, Ē its mean, and ρ' the colour of what meets several facets.
//! Both are sampled with density cos θi / π.

use crate::{Bxdf, ShadingContext};
use core::f32::consts::{FRAC_1_PI, FRAC_2_PI, PI};
use etalon_math::float;
use etalon_params::Params;
use etalon_sampling::warps::square_to_cosine_hemisphere;
use etalon_transport::{BsdfSample, Build, SpectrumKind, TextureId, Textures, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "roughdiffuse",
    "roughdiffuse alpha=f:0.7 reflectance=t:400:0.1,700:0.8",
    "roughdiffuse alpha=f:0.4 use_fast_approx=b:true",
    "roughdiffuse model=s:eon alpha=f:1 reflectance=u:1",
    "roughdiffuse model=s:eon alpha=f:0.3 reflectance=t:400:0.3,700:0.9",
];

/// Which equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Equation {
    Full,
    Fast,
    Preserving,
}

/// `roughdiffuse` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    reflectance: TextureId,
    alpha: TextureId,
    equation: Equation,
}

impl Description {
    /// Reads `reflectance` (0.5), `alpha` (0.2; of a Beckmann surface with as rough facets, σ = α/√2; for `eon` its
    /// roughness r, up to 1), `model` (`oren-nayar`, or `eon`) and `use_fast_approx` (false).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let mut texture =
            |name, default| build.texture(params, name, Some(default), SpectrumKind::Reflectance);
        let reflectance = texture("reflectance", 0.5);
        let alpha = texture("alpha", 0.2);
        let fast = params.boolean_or("use_fast_approx", false);
        let equation = match (
            params.choice("model", "oren-nayar", &["oren-nayar", "eon"]),
            fast,
        ) {
            ("eon", true) => {
                params.error_at("use_fast_approx", "`eon` has no fast approximation");
                return None;
            }
            ("eon", false) => Equation::Preserving,
            (_, true) => Equation::Fast,
            (_, false) => Equation::Full,
        };
        Some(Self {
            reflectance,
            alpha,
            equation,
        })
    }

    /// The model at a point.
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> RoughDiffuse {
        RoughDiffuse {
            reflectance: site.spectrum(self.reflectance),
            alpha: site.share(self.alpha),
            equation: self.equation,
        }
    }
}

/// Lambertian facets.
#[derive(Clone, Copy, Debug)]
pub struct RoughDiffuse {
    /// ρ of a facet, per lane.
    reflectance: Vec4,
    alpha: f32,
    equation: Equation,
}

impl RoughDiffuse {
    /// f, for directions on the front.
    fn value(&self, wo: Vec3, wi: Vec3) -> Vec4 {
        match self.equation {
            Equation::Preserving => preserving(self.reflectance, self.alpha, wo, wi),
            equation => {
                let variance = 0.5 * self.alpha * self.alpha;
                oren_nayar(self.reflectance, variance, equation, wo, wi)
            }
        }
    }
}

/// Oren & Nayar's f, for facets whose slope angle has the variance σ².
fn oren_nayar(rho: Vec4, variance: f32, equation: Equation, wo: Vec3, wi: Vec3) -> Vec4 {
    let sin = |w: Vec3| Vec2::new(w.x, w.y).length();
    let (sin_o, sin_i) = (sin(wo), sin(wi));
    let both = sin_o * sin_i;
    let cos_phi = match both > 1e-12 {
        true => ((wo.x * wi.x + wo.y * wi.y) / both).clamp(-1.0, 1.0),
        false => 0.0,
    };
    // Of the larger and of the smaller angle.
    let [(sin_alpha, cos_alpha), (sin_beta, cos_beta)] = match wo.z < wi.z {
        true => [(sin_o, wo.z), (sin_i, wi.z)],
        false => [(sin_i, wi.z), (sin_o, wo.z)],
    };
    let tan_beta = sin_beta / cos_beta;
    let c1 = 1.0 - 0.5 * variance / (variance + 0.33);
    let c2 = 0.45 * variance / (variance + 0.09);
    if equation == Equation::Fast {
        return rho * (FRAC_1_PI * (c1 + c2 * cos_phi.max(0.0) * sin_alpha * tan_beta));
    }
    let alpha = float::atan2(sin_alpha, cos_alpha);
    let beta = float::atan2(sin_beta, cos_beta);
    let away = match cos_phi < 0.0 {
        true => (FRAC_2_PI * beta).powi(3),
        false => 0.0,
    };
    let product = 4.0 * alpha * beta / (PI * PI);
    let c3 = 0.125 * variance / (variance + 0.09) * product * product;
    let (sin_half, cos_half) = float::sin_cos(0.5 * (alpha + beta));
    let direct = c1
        + cos_phi * c2 * (sin_alpha - away) * tan_beta
        + (1.0 - cos_phi.abs()) * c3 * sin_half / cos_half;
    let twice = 0.17 * variance / (variance + 0.13)
        * (1.0 - cos_phi * (FRAC_2_PI * beta) * (FRAC_2_PI * beta));
    (rho * direct + rho * rho * twice) * FRAC_1_PI
}

/// ½ − 2/(3π), of A, and ⅔ − 28/(15π), of Ē.
const SINGLE: f32 = 0.5 - 2.0 / (3.0 * PI);
const MEAN: f32 = 2.0 / 3.0 - 28.0 / (15.0 * PI);

/// The energy-preserving f.
fn preserving(rho: Vec4, roughness: f32, wo: Vec3, wi: Vec3) -> Vec4 {
    let a = 1.0 / (1.0 + SINGLE * roughness);
    let s = wi.dot(wo) - wi.z * wo.z;
    let ratio = if s > 0.0 { s / wi.z.max(wo.z) } else { s };
    let once = rho * (FRAC_1_PI * a * (1.0 + roughness * ratio));
    let mean = a * (1.0 + MEAN * roughness);
    let missing = 1.0 - mean;
    if !(missing > 1e-6) {
        return once;
    }
    let colour = rho * rho * mean / (1.0 - rho * missing);
    let lost = |cos: f32| (1.0 - albedo(cos, roughness, a)).max(0.0);
    once + colour * (FRAC_1_PI * lost(wo.z) * lost(wi.z) / missing)
}

/// E, the albedo of the first term at ρ = 1.
fn albedo(cos: f32, roughness: f32, a: f32) -> f32 {
    let cos = cos.clamp(1e-4, 1.0);
    let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
    let angle = float::atan2(sin, cos);
    let g = sin * (angle - sin * cos) + 2.0 / 3.0 * (sin / cos * (1.0 - sin * sin * sin) - sin);
    a + roughness * a * FRAC_1_PI * g
}

impl Bxdf for RoughDiffuse {
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        if !(wo.z > 0.0 && wi.z > 0.0) {
            return (Vec4::ZERO, Vec4::ZERO);
        }
        let value = self.value(wo, wi).max(Vec4::ZERO) * wi.z;
        (value, Vec4::splat(wi.z * FRAC_1_PI))
    }

    fn sample(&self, wo: Vec3, _: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        (wo.z > 0.0)
            .then(|| self.continuous(wo, square_to_cosine_hemisphere(u), 1.0, mode))
            .flatten()
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

    /// ρ of a facet.
    fn albedo(&self, _: Vec3) -> Vec4 {
        self.reflectance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::TAU;

    /// The albedo of a white surface for `wo`, by the midpoint rule.
    fn albedo_of(equation: Equation, alpha: f32, wo: Vec3) -> f32 {
        let white = RoughDiffuse {
            reflectance: Vec4::ONE,
            alpha,
            equation,
        };
        const N: usize = 300;
        let mut sum = 0.0;
        for (i, j) in (0..N).flat_map(|i| (0..N).map(move |j| (i, j))) {
            let [height, turn] = [i, j].map(|k| (k as f32 + 0.5) / N as f32);
            // Equal shares of the projected hemisphere.
            let radius = height.sqrt();
            let (y, x) = float::sin_cos(TAU * turn);
            let wi = Vec3::new(x * radius, y * radius, (1.0 - height).sqrt());
            sum += white.value(wo, wi).x * PI;
        }
        sum / (N * N) as f32
    }

    #[test]
    fn white_loses_nothing_by_eon_and_little_by_oren_and_nayar() {
        for cos in [0.1_f32, 0.4, 0.9] {
            let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
            for alpha in [0.1, 0.5, 1.0] {
                let kept = albedo_of(Equation::Preserving, alpha, wo);
                assert!((kept - 1.0).abs() < 2e-3, "{kept} at {cos}, {alpha}");
                let lambert = albedo_of(Equation::Fast, 0.0, wo);
                assert!((lambert - 1.0).abs() < 1e-3, "{lambert}");
            }
            let lost = 1.0 - albedo_of(Equation::Full, 0.7, wo);
            assert!((0.0..0.2).contains(&lost), "{lost}");
        }
    }
}
