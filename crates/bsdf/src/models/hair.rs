//! A hair: a rough dielectric cylinder with tilted scales and absorbing pigment.
//!
//! ```text
//! f(wo, wi) cos = Σ₀³ Mp(θo, θi) Ap(wo) Np(φi − φo)
//!
//! Mp = exp(−sin θi sin θo / v) I₀(cos θi cos θo / v) / (2v sinh(1/v))           along the hair, variance v
//! A₀ = F   A₁ = (1 − F)² T   A₂ = A₁ T F   A₃ = A₂ T F / (1 − T F)               reflected; through, p − 1 times inside
//! Np = logistic(φ − Φp; s) on [−π, π],  Φp = 2p γt − 2γo + pπ;  N₃ = 1/2π        around it
//! ```
//!
//! Chiang, Bitterli, Tappan and Burley (2016), *A Practical and Controllable Hair and Fur Model for Production Path
//! Tracing*, after Marschner et al. (2003) and d'Eon et al. (2011); numbers of v and s from their eqs. 7 and 8. Angles θ
//! are from the plane across the hair, which runs along y (of a curve, along it); φ and γo count from the normal, so that sin γo is where across
//! the hair's width it was hit. T = exp(−2 σa cos γt / cos θt) for a hair of radius 1. Unless
//! `sigma_a` is given, pigments absorb the colours (0.419, 0.697, 1.37) and (0.187, 0.4, 1.05) per concentration (d'Eon et
//! al. 2011, section 6.1); as spectra with their blue held to 1, which is what Mitsuba makes of them.
//!
//! Where light leaves is taken to be where it came in. So a hair is seen from the side of the viewer, and integrators
//! that follow light from the lamps cannot have it.

use crate::interface::fresnel;
use crate::interface::relative_index::RelativeIndex;
use crate::{Bxdf, MaterialFlags, ShadingContext};
use core::f32::consts::{FRAC_1_PI, PI, TAU};
use etalon_math::float;
use etalon_params::Params;
use etalon_spectrum::RgbCoefficients;
use etalon_transport::{BsdfSample, Build, SpectrumKind, TextureId, Textures, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "hair",
    "hair eumelanin=f:0.3 pheomelanin=f:0.6 longitudinal_roughness=f:0.5 azimuthal_roughness=f:0.6 scale_tilt=f:0",
    "hair sigma_a=t:400:0.1,700:2 longitudinal_roughness=f:0.2 azimuthal_roughness=f:0.9 scale_tilt=f:4",
    "hair sigma_a=u:0 longitudinal_roughness=f:0.7",
];

/// Absorption of the pigments per concentration, as colours.
const EUMELANIN: [f32; 3] = [0.419, 0.697, 1.0];
const PHEOMELANIN: [f32; 3] = [0.187, 0.4, 1.0];

/// Lobes: reflected, through once, after one and after all further reflections inside.
const LOBES: usize = 4;

/// `hair` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    /// σa times the radius.
    absorption: Absorption,
    scale: f32,
    shape: Shape,
}

#[derive(Clone, Debug)]
enum Absorption {
    Spectrum(TextureId),
    Pigment { eumelanin: f32, pheomelanin: f32 },
}

/// Quantities that do not depend on the point of the hair.
#[derive(Clone, Copy, Debug)]
struct Shape {
    eta: f32,
    /// v of each lobe.
    variance: [f32; LOBES],
    /// s.
    spread: f32,
    /// Sine and cosine of each lobe's tilt by the cuticle scales.
    tilt: [(f32, f32); LOBES],
}

impl Description {
    /// Reads `eumelanin` (1.3) and `pheomelanin` (0.2), or `sigma_a`; `scale` (1), `longitudinal_roughness` and
    /// `azimuthal_roughness` (0.3), `scale_tilt` (2°), `int_ior` (amber) and `ext_ior` (air).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let amount = |name: &str, default: f64| {
            let what = "a finite number not below 0";
            params.float_where(name, default, what, |x| x >= 0.0 && x.is_finite()) as f32
        };
        let roughness = |name: &str| {
            let what = "a number above 0, up to 1";
            params.float_where(name, 0.3, what, |x| x > 0.0 && x <= 1.0) as f32
        };
        let absorption = if params.has("sigma_a") {
            if let Some(pigment) = ["eumelanin", "pheomelanin"]
                .into_iter()
                .find(|name| params.has(name))
            {
                params.error(format!("give either `sigma_a` or `{pigment}`"));
                return None;
            }
            Absorption::Spectrum(build.texture(params, "sigma_a", None, SpectrumKind::Unbounded))
        } else {
            Absorption::Pigment {
                eumelanin: amount("eumelanin", 1.3),
                pheomelanin: amount("pheomelanin", 0.2),
            }
        };
        let eta = RelativeIndex::constant_from_params(params, "amber")? as f32;
        let tilt = params.float_where(
            "scale_tilt",
            2.0,
            "an angle in degrees between -45 and 45",
            |x| x.abs() <= 45.0,
        ) as f32;
        Some(Self {
            absorption,
            scale: amount("scale", 1.0),
            shape: Shape::new(
                eta,
                roughness("longitudinal_roughness"),
                roughness("azimuthal_roughness"),
                tilt.to_radians(),
            ),
        })
    }

    /// The material's flags.
    pub fn flags(&self) -> MaterialFlags {
        MaterialFlags {
            transmission: true,
            one_way: true,
            ..MaterialFlags::reflecting(self)
        }
    }

    /// The model at a point.
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> Hair {
        let absorption = match self.absorption {
            Absorption::Spectrum(texture) => site.spectrum(texture).max(Vec4::ZERO),
            Absorption::Pigment {
                eumelanin,
                pheomelanin,
            } => {
                let absorbs =
                    |pigment: [f32; 3]| RgbCoefficients::from_rgb(pigment).eval(site.lambda);
                absorbs(EUMELANIN) * eumelanin + absorbs(PHEOMELANIN) * pheomelanin
            }
        };
        Hair {
            absorption: absorption * self.scale,
            shape: self.shape,
        }
    }
}

impl Shape {
    fn new(eta: f32, longitudinal: f32, azimuthal: f32, tilt: f32) -> Self {
        let (m, n) = (longitudinal, azimuthal);
        let root = 0.726 * m + 0.812 * m * m + 3.7 * float::pow(m, 20.0);
        let v = root * root;
        let s = (PI / 8.0).sqrt() * (0.265 * n + 1.194 * n * n + 5.372 * float::pow(n, 22.0));
        // Reflected by a scale, light turns by twice its tilt; through two of them, by half of that and back.
        let tilt = [-2.0, 1.0, 4.0, 0.0].map(|factor| float::sin_cos(factor * tilt));
        Self {
            eta,
            variance: [v, 0.25 * v, 4.0 * v, 4.0 * v],
            spread: s,
            tilt,
        }
    }
}

/// A hair with plain parameters.
#[derive(Clone, Copy, Debug)]
pub struct Hair {
    /// σa times the radius, per lane.
    absorption: Vec4,
    shape: Shape,
}

/// Quantities that depend on the known direction only.
struct Known {
    /// Sine and cosine of θo, tilted for each lobe.
    theta: [(f32, f32); LOBES],
    phi: f32,
    gamma_o: f32,
    gamma_t: f32,
    /// Ap, per lane.
    attenuation: [Vec4; LOBES],
    /// Ap over their sum, per lane.
    share: [Vec4; LOBES],
}

/// The direction seen from the side on which `wo` is.
#[inline]
fn turned(wo: Vec3, v: Vec3) -> Vec3 {
    Vec3::new(v.x, v.y, if wo.z < 0.0 { -v.z } else { v.z })
}

impl Hair {
    fn known(&self, wo: Vec3) -> Known {
        let eta = self.shape.eta;
        let sin_theta = wo.y.clamp(-1.0, 1.0);
        let cos_theta = Vec2::new(wo.x, wo.z).length();
        let h = if cos_theta > 0.0 {
            (wo.x / cos_theta).clamp(-1.0, 1.0)
        } else {
            0.0
        };
        let gamma_o = float::asin(h);
        // Refraction of the projected direction, by the index that the projection changes (Marschner et al. 2003).
        let projected = (eta * eta - sin_theta * sin_theta).max(0.0).sqrt() / cos_theta.max(1e-6);
        let sin_gamma_t = (h / projected).clamp(-1.0, 1.0);
        let cos_gamma_t = float::safe_sqrt(1.0 - sin_gamma_t * sin_gamma_t);
        let sin_theta_t = sin_theta / eta;
        let cos_theta_t = float::safe_sqrt(1.0 - sin_theta_t * sin_theta_t).max(1e-6);
        let way = 2.0 * cos_gamma_t / cos_theta_t;
        let through = (self.absorption * -way).to_array().map(float::exp);
        let through = Vec4::from_array(through);
        let cos = (cos_theta * float::safe_sqrt(1.0 - h * h)).min(1.0);
        let f = fresnel::dielectric(cos, eta).0;
        let once = through * ((1.0 - f) * (1.0 - f));
        let twice = once * through * f;
        let left = (1.0 - through * f).max(Vec4::splat(1e-6));
        let attenuation = [Vec4::splat(f), once, twice, twice * through * f / left];
        let total = attenuation
            .iter()
            .copied()
            .sum::<Vec4>()
            .max(Vec4::splat(1e-12));
        let tilted = |(sin, cos): (f32, f32)| {
            (
                sin_theta * cos + cos_theta * sin,
                (cos_theta * cos - sin_theta * sin).abs(),
            )
        };
        Known {
            theta: self.shape.tilt.map(tilted),
            phi: float::atan2(wo.x, wo.z),
            gamma_o,
            gamma_t: float::asin(sin_gamma_t),
            attenuation,
            share: attenuation.map(|a| a / total),
        }
    }

    /// Value and density toward `wi`, with the quantities that depend on `wo` only.
    fn sum(&self, known: &Known, wi: Vec3) -> (Vec4, Vec4) {
        let (sin, cos) = (wi.y.clamp(-1.0, 1.0), Vec2::new(wi.x, wi.z).length());
        let phi = float::atan2(wi.x, wi.z) - known.phi;
        let (mut value, mut density) = (Vec4::ZERO, Vec4::ZERO);
        for lobe in 0..LOBES {
            let along = longitudinal((sin, cos), known.theta[lobe], self.shape.variance[lobe]);
            let around = if lobe == LOBES - 1 {
                0.5 * FRAC_1_PI
            } else {
                trimmed_logistic(wrapped(phi - known.turn(lobe)), self.shape.spread)
            };
            value += known.attenuation[lobe] * (along * around);
            density += known.share[lobe] * (along * around);
        }
        (value, density)
    }
}

impl Known {
    /// Φp: by how much the lobe turns light around the hair.
    #[inline]
    fn turn(&self, lobe: usize) -> f32 {
        let p = lobe as f32;
        2.0 * p * self.gamma_t - 2.0 * self.gamma_o + p * PI
    }
}

/// An angle brought into [−π, π].
#[inline]
fn wrapped(angle: f32) -> f32 {
    angle - TAU * (angle / TAU).round()
}

/// Mp, for sine and cosine of both angles.
fn longitudinal((sin_i, cos_i): (f32, f32), (sin_o, cos_o): (f32, f32), v: f32) -> f32 {
    let a = cos_i * cos_o / v;
    let b = sin_i * sin_o / v;
    if v <= 0.1 {
        // exp(−b) I₀(a) / (2v sinh(1/v)) in logarithms: sinh overflows.
        float::exp(log_bessel(a) - b - 1.0 / v + core::f32::consts::LN_2 + float::ln(0.5 / v))
    } else {
        let sinh = 0.5 * (float::exp(1.0 / v) - float::exp(-1.0 / v));
        float::exp(-b) * bessel(a) / (2.0 * v * sinh)
    }
}

/// I₀, the modified Bessel function of the first kind (Abramowitz and Stegun 9.6.12).
fn bessel(x: f32) -> f32 {
    let quarter = 0.25 * x * x;
    let (mut term, mut sum) = (1.0, 1.0);
    for i in 1..24 {
        term *= quarter / (i * i) as f32;
        sum += term;
    }
    sum
}

/// ln I₀ (Abramowitz and Stegun 9.7.1 where the series is long).
fn log_bessel(x: f32) -> f32 {
    if x > 12.0 {
        x + 0.5 * (-float::ln(TAU) - float::ln(x))
            + float::ln(1.0 + 0.125 / x + 0.070_312_5 / (x * x))
    } else {
        float::ln(bessel(x))
    }
}

/// The logistic distribution's cumulative function at `x`.
#[inline]
fn logistic_below(x: f32, s: f32) -> f32 {
    1.0 / (1.0 + float::exp(-x / s))
}

/// Np: the logistic density on [−π, π].
#[inline]
fn trimmed_logistic(x: f32, s: f32) -> f32 {
    let e = float::exp(-x.abs() / s);
    let density = e / (s * (1.0 + e) * (1.0 + e));
    density / (logistic_below(PI, s) - logistic_below(-PI, s))
}

impl Bxdf for Hair {
    /// The same in either mode, since no light path meets a hair.
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        if wo.z == 0.0 || wi.z == 0.0 {
            return (Vec4::ZERO, Vec4::ZERO);
        }
        self.sum(&self.known(turned(wo, wo)), turned(wo, wi))
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        let known = self.known(turned(wo, wo));
        // The lane that chooses is the first; what its choice leaves of the number turns the lobe.
        let (mut lobe, mut rest) = (0, u_lobe);
        while lobe + 1 < LOBES && rest >= known.share[lobe].x {
            rest -= known.share[lobe].x;
            lobe += 1;
        }
        let rest = (rest / known.share[lobe].x).clamp(0.0, 1.0 - 1e-6);
        let v = self.shape.variance[lobe];
        let (sin_o, cos_o) = known.theta[lobe];
        let from = (u.x + (1.0 - u.x) * float::exp(-2.0 / v)).max(1e-9);
        let cos = (1.0 + v * float::ln(from)).clamp(-1.0, 1.0);
        let sin = float::safe_sqrt(1.0 - cos * cos);
        let sin_i = (-cos * sin_o + sin * float::cos(TAU * u.y) * cos_o).clamp(-1.0, 1.0);
        let cos_i = float::safe_sqrt(1.0 - sin_i * sin_i);
        let turn = if lobe == LOBES - 1 {
            TAU * rest
        } else {
            let s = self.shape.spread;
            let (low, high) = (logistic_below(-PI, s), logistic_below(PI, s));
            let below = low + rest * (high - low);
            known.turn(lobe) - s * float::ln((1.0 / below - 1.0).max(1e-30))
        };
        let (x, z) = float::sin_cos(known.phi + turn);
        let wi = turned(wo, Vec3::new(cos_i * x, sin_i, cos_i * z));
        self.continuous(wo, wi, 1.0, mode)
    }

    fn has_continuous(&self) -> bool {
        true
    }

    fn has_discrete(&self) -> bool {
        false
    }
}
