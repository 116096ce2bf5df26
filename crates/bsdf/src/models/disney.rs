//! What `principled` and `principledthin` share.
//!
//! B. Burley (2012), *Physically Based Shading at Disney*, section 5; (2015), *Extending the Disney BRDF to a BSDF
//! with Integrated Subsurface Scattering*. With F(θ) = (1 − cos θ)⁵ and θd between either direction and the normal
//! half-way:
//!
//! ```text
//! R       = 2 · roughness · cos² θd
//! f_d     = (1 − F(θi)/2) (1 − F(θo)/2) + R (F(θo) + F(θi) + F(θo) F(θi) (R − 1))
//! f_ss    = 1.25 (S (1/(cos θi + cos θo) − ½) + ½),     S = lerp(1, R/2, F(θo)) · lerp(1, R/2, F(θi))
//! f       = colour/π · lerp(f_d, f_ss, flatness)  +  sheen colour · F(θd)
//! ```

use crate::TextureSite;
use crate::interface::refraction::half_vector;
use crate::microfacet::{Kind, Microfacet};
use core::f32::consts::FRAC_1_PI;
use etalon_math::lane::{Lane, Select, Vector, branch};
use etalon_params::{Params, Value};
use etalon_transport::{TextureId, Textures};
use glam::{Vec2, Vec4};

/// (1 − c)⁵, Schlick's weight (C. Schlick 1994, eq. 24).
#[inline(always)]
pub fn schlick<F: Lane>(cos: F) -> F {
    let x = (F::ONE - cos).clamp(0.0, 1.0);
    let x2 = x * x;
    x2 * x2 * x
}

/// Schlick's weight for a cosine outside of an interface of relative index `eta`: where it is entered from the
/// denser side, at the angle of refraction.
#[inline(always)]
pub fn schlick_entering<F: Lane>(cos: F, eta: F) -> F {
    let refracted = || (F::ONE - (F::ONE - cos * cos) / (eta * eta)).safe_sqrt();
    schlick(branch!(eta.gt(F::ONE), cos, refracted()))
}

/// The distribution of normals: α = roughness² over and times √(1 − 0.9 · anisotropic) along x and y, 0.001 at least.
#[inline]
pub fn microfacet(roughness: f32, anisotropic: f32) -> Microfacet {
    let aspect = (1.0 - 0.9 * anisotropic).sqrt();
    let alpha = roughness * roughness;
    let alpha = Vec2::new(alpha / aspect, alpha * aspect).max(Vec2::splat(1e-3));
    Microfacet::new(Kind::Ggx, alpha, true)
}

/// A texture's colour here brought to luminance one; white where it has none, or where no tint is `wanted`.
#[inline]
pub fn tint<T: Textures>(
    site: &TextureSite<'_, T>,
    texture: TextureId,
    colour: Vec4,
    wanted: bool,
) -> Vec4 {
    let luminance = if wanted { site.number(texture) } else { 0.0 };
    if luminance > 0.0 {
        colour / luminance
    } else {
        Vec4::ONE
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

/// ((η − 1)/(η + 1))², the reflectance at normal incidence.
#[inline(always)]
pub fn normal_reflectance<F: Lane>(eta: F) -> F {
    let root = (eta - 1.0) / (eta + 1.0);
    root * root
}

/// The diffuse base and its sheen.
#[derive(Clone, Copy, Debug)]
pub struct DisneyBase<F: Lane = f32> {
    /// The colour with all factors, per wavelength.
    pub colour: F::Spectrum,
    /// The sheen's colour with all factors, per wavelength.
    pub sheen: F::Spectrum,
    /// Roughness, 0 to 1.
    pub roughness: F,
    /// The share of f_ss.
    pub flatness: F,
}

impl<F: Lane> DisneyBase<F> {
    /// The sheen's colour, `amount` times white or a tint of luminance one.
    #[inline(always)]
    pub fn sheen_colour(amount: F, tinted: F, tint: F::Spectrum) -> F::Spectrum {
        (tint * tinted + (F::ONE - tinted)) * amount
    }

    /// f·cos θi of two directions above.
    #[inline(always)]
    pub fn eval(&self, wo: F::Vector, wi: F::Vector) -> F::Spectrum {
        let (has_normal, _, cos) = half_vector::<F>(wo, wi);
        let cos_d = has_normal.select(cos, F::ZERO);
        let (fo, fi) = (schlick(wo.z()), schlick(wi.z()));
        let retro = self.roughness * 2.0 * cos_d * cos_d;
        let diffuse =
            (F::ONE - fi * 0.5) * (F::ONE - fo * 0.5) + retro * (fo + fi + fo * fi * (retro - 1.0));
        let flattened = branch!(
            self.flatness.gt(F::ZERO),
            {
                let half = retro * 0.5 - 1.0;
                let s = (fo * half + 1.0) * (fi * half + 1.0);
                let flat = (s * (F::ONE / (wo.z() + wi.z()) - 0.5) + 0.5) * 1.25;
                diffuse + self.flatness * (flat - diffuse)
            },
            diffuse
        );
        (self.colour * (flattened * FRAC_1_PI) + self.sheen * schlick(cos_d)) * wi.z()
    }
}
