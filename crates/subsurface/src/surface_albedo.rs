//! From the albedo of a surface to that of single scattering below it.
//!
//! A half-space that scatters isotropically with the single-scattering albedo α reflects, of diffuse light that enters
//! through a boundary without reflection, very nearly (H. C. van de Hulst 1980, "Multiple Light Scattering", table 12 and
//! the fit quoted by E. d'Eon 2012)
//!
//! ```text
//! A = (1 − s) (1 − 0.139 s) / (1 + 1.17 s),   s = √((1 − α) / (1 − α g))
//! ```
//!
//! with g the mean cosine, by the similarity relation. The inverse (C. Kulla & A. Conty 2017, "Revisiting Physically Based
//! Shading at Imageworks"):
//!
//! ```text
//! s = 4.09712 + 4.20863 A − √(9.59217 + 41.6808 A + 17.7126 A²),   α = (1 − s²) / (1 − g s²)
//! ```
//!
//! This is for a boundary that lets all light pass, in a diffuse way. A dielectric one reflects a part Fₑ of diffuse light that
//! comes from outside, and Fᵢ = 1 − (1 − Fₑ)/η² of what comes from inside (J. L. Saunderson 1942):
//!
//! ```text
//! A_seen = (1 − Fₑ)(1 − Fᵢ) A / (1 − Fᵢ A)      (without what Fₑ mirrors)
//! ```

use etalon_math::float;
use glam::Vec4;

/// α of a surface albedo, per lane, for the mean cosine `g`.
#[inline]
pub fn single_scattering(surface: Vec4, g: f32) -> Vec4 {
    let a = surface.clamp(Vec4::ZERO, Vec4::ONE);
    let root = (9.59217 + 41.6808 * a + 17.7126 * a * a).map(float::safe_sqrt);
    let s = (4.09712 + 4.20863 * a - root).clamp(Vec4::ZERO, Vec4::ONE);
    (1.0 - s * s) / (1.0 - g * s * s)
}

/// A of a half-space with this single-scattering albedo and mean cosine: the inverse.
#[inline]
pub fn of_half_space(albedo: f32, g: f32) -> f32 {
    let s = float::safe_sqrt((1.0 - albedo) / (1.0 - albedo * g));
    (1.0 - s) * (1.0 - 0.139 * s) / (1.0 + 1.17 * s)
}

/// Of light that has entered matter of this surface albedo, what leaves through a boundary that reflects the part `inside` of
/// diffuse light from inside.
#[inline]
pub fn inside_boundary(albedo: f32, inside: f32) -> f32 {
    (1.0 - inside) * albedo / (1.0 - inside * albedo)
}

/// A, from the albedo seen through a dielectric boundary of the relative index `eta` that reflects the share `inside`
/// of diffuse light from inside.
#[inline]
pub fn below(seen: Vec4, eta: f32, inside: f32) -> Vec4 {
    let passing = (1.0 - inside) * eta * eta;
    seen / (passing * (1.0 - inside) + inside * seen)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fits_are_inverses() {
        for alpha in [0.1_f32, 0.5, 0.8, 0.95, 0.99, 0.999] {
            for g in [-0.5, 0.0, 0.8] {
                let surface = of_half_space(alpha, g);
                let found = single_scattering(Vec4::splat(surface), g).x;
                assert!((found - alpha).abs() < 2e-3, "{alpha} {g}: {found}");
            }
        }
        for end in [0.0, 1.0] {
            let found = single_scattering(Vec4::splat(end), 0.0).x;
            assert!((found - end).abs() < 2e-3, "{found}");
        }
    }

    #[test]
    fn a_boundary_darkens() {
        let (eta, outside) = (1.5_f32, 0.0918);
        let inside = 1.0 - (1.0 - outside) / (eta * eta);
        for a in [0.1, 0.5, 0.9, 1.0] {
            let seen = (1.0 - outside) * (1.0 - inside) * a / (1.0 - inside * a);
            let found = below(Vec4::splat(seen), eta, inside).x;
            assert!(seen < a && (found - a).abs() < 1e-5, "{a} {found}");
        }
    }
}
