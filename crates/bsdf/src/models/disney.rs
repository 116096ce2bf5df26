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

use crate::ShadingContext;
use crate::microfacet::{Kind, Microfacet};
use core::f32::consts::FRAC_1_PI;
use etalon_transport::{TextureId, Textures};
use glam::{Vec2, Vec3, Vec4};

/// (1 − c)⁵, Schlick's weight (C. Schlick 1994, eq. 24).
#[inline]
pub fn schlick(cos: f32) -> f32 {
    let x = (1.0 - cos).clamp(0.0, 1.0);
    let x2 = x * x;
    x2 * x2 * x
}

/// Schlick's weight for a cosine outside of an interface of relative index `eta`: where it is entered from the
/// denser side, at the angle of refraction.
#[inline]
pub fn schlick_entering(cos: f32, eta: f32) -> f32 {
    if eta > 1.0 {
        return schlick(cos);
    }
    let cos_t2 = 1.0 - (1.0 - cos * cos) / (eta * eta);
    schlick(cos_t2.max(0.0).sqrt())
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
    site: &ShadingContext<'_, T>,
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

/// ((η − 1)/(η + 1))², the reflectance at normal incidence.
#[inline]
pub fn normal_reflectance(eta: f32) -> f32 {
    let root = (eta - 1.0) / (eta + 1.0);
    root * root
}

/// The diffuse base and its sheen.
#[derive(Clone, Copy, Debug)]
pub struct DisneyBase {
    /// The colour with all factors, per lane.
    pub colour: Vec4,
    /// The sheen's colour with all factors, per lane.
    pub sheen: Vec4,
    /// Roughness, 0 to 1.
    pub roughness: f32,
    /// The share of f_ss.
    pub flatness: f32,
}

impl DisneyBase {
    /// The sheen's colour, `amount` times white or a tint of luminance one.
    #[inline]
    pub fn sheen_colour(amount: f32, tinted: f32, tint: Vec4) -> Vec4 {
        amount * Vec4::ONE.lerp(tint, tinted)
    }

    /// f·cos θi of two directions above.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Vec4 {
        let cos_d = (wo + wi).normalize_or_zero().dot(wi);
        let (fo, fi) = (schlick(wo.z), schlick(wi.z));
        let retro = 2.0 * self.roughness * cos_d * cos_d;
        let diffuse =
            (1.0 - 0.5 * fi) * (1.0 - 0.5 * fo) + retro * (fo + fi + fo * fi * (retro - 1.0));
        let flattened = if self.flatness > 0.0 {
            let toward = |f: f32| 1.0 + f * (0.5 * retro - 1.0);
            let s = toward(fo) * toward(fi);
            let flat = 1.25 * (s * (1.0 / (wo.z + wi.z) - 0.5) + 0.5);
            diffuse + self.flatness * (flat - diffuse)
        } else {
            diffuse
        };
        (self.colour * (flattened * FRAC_1_PI) + self.sheen * schlick(cos_d.abs())) * wi.z
    }
}
