//! Materials under parallel light of irradiance E⊥ at θᵢ = 45°, seen along the normal: L = E⊥ f cos θᵢ.
//!
//! - Rough mirrors: L = E⊥ D(h) G₁(θᵢ)/4, with h halfway between the two directions, 22.5° from the
//!   normal, and G₁ = 1 along it (Walter, Marschner, Li & Torrance, "Microfacet models for refraction
//!   through rough surfaces", 2007). Beckmann: D = exp(−tan² h/α²)/(π α² cos⁴ h), G₁ by their
//!   rational approximation. GGX: D = α²/(π cos⁴ h (α² + tan² h)²), G₁ = 2/(1 + √(1 + α² tan² θ)).
//!   Brushed mirrors: in the plane of the light tan h is over the roughness along it, αᵤ, and α² in D
//!   the product of the two.
//! - Phong's model: L = E⊥ cos θᵢ (ρ/π + ρₛ (n + 2)/(2π) cosⁿ θᵢ) (Lafortune & Willems 1994).
//! - Plastics beside their highlight: L = E⊥ cos θᵢ T(θᵢ) T(0)/η² · ρ/(1 − ρ' R)/π, with T = 1 − F,
//!   and ρ' = 1 or, nonlinear, ρ (Wolff 1994; Mitsuba 3's `plastic`). R is the share of diffuse light
//!   that is reflected back inside: for `plastic` by Egan and Hilgeman's fit (1973), as Mitsuba has it,
//!   −1.4399/η² + 0.7099/η + 0.6681 + 0.0636 η. For `roughplastic` it is 2 ∫ F μ dμ; a roughness of 0.01
//!   leaves T what it is, but Mitsuba's rule for the integral, which we follow, is 1.4 % off. On a base
//!   that reflects a tenth this is less than 0.1 %.

use super::light::{known, rgb};
use crate::claim::Claim;
use etalon_conform::truth::interfaces::reflectance;
use etalon_math::float64::{exp, pow, tan};
use etalon_render::judge::ExactImage;
use std::f64::consts::{FRAC_1_PI, FRAC_1_SQRT_2, FRAC_PI_8, PI};

/// Patches in a row.
const COLUMNS: u32 = 3;
/// Rows of patches.
const ROWS: u32 = 3;

/// The picture of the patches. They must be of whole pixels.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    if !size[0].is_multiple_of(COLUMNS) || !size[1].is_multiple_of(ROWS) {
        return Err("the patches must be of whole pixels".to_owned());
    }
    let irradiance = claim.number("irradiance")?;
    let [first, second] = [claim.number("alpha_1")?, claim.number("alpha_2")?];
    let (albedo, index) = (claim.number("reflectance")?, claim.number("index")?);
    let fit = -1.4399 / (index * index) + 0.7099 / index + 0.6681 + 0.0636 * index;
    let values = [
        beckmann([first, first]),
        beckmann([second, second]),
        ggx([second, second]),
        base(albedo, index, fit),
        base(albedo, index, albedo * fit),
        beckmann([first, first]),
        phong(albedo, claim.number("gloss")?, claim.number("exponent")?),
        beckmann([first, second]),
        ggx([second, first]),
    ];
    let colours = values.map(|value| rgb(|_| irradiance * value));
    Ok(known(size, |column, row| {
        let patch = row * ROWS / size[1] * COLUMNS + column * COLUMNS / size[0];
        colours[patch as usize]
    }))
}

/// The picture of a plane under a hardly rough coat.
pub fn coat(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let irradiance = claim.number("irradiance")?;
    let (albedo, index) = (claim.number("reflectance")?, claim.number("index")?);
    let value = base(albedo, index, albedo * internal(index));
    let colour = rgb(|_| irradiance * value);
    Ok(known(size, |_, _| colour))
}

/// tan² and cos⁴ of the half angle.
fn half() -> (f64, f64) {
    let t2 = tan(FRAC_PI_8) * tan(FRAC_PI_8);
    (t2, 1.0 / ((1.0 + t2) * (1.0 + t2)))
}

/// L/E⊥ of a rough mirror by Beckmann, with its roughness along the light and across.
fn beckmann([along, across]: [f64; 2]) -> f64 {
    let (t2, c4) = half();
    let d = exp(-t2 / (along * along)) / (PI * along * across * c4);
    // 1/(α tan 45°).
    let a = 1.0 / along;
    let g = if a < 1.6 {
        (3.535 * a + 2.181 * a * a) / (1.0 + 2.276 * a + 2.577 * a * a)
    } else {
        1.0
    };
    0.25 * d * g
}

/// L/E⊥ of a rough mirror by GGX, with its roughness along the light and across.
fn ggx([along, across]: [f64; 2]) -> f64 {
    let (t2, c4) = half();
    let a2 = along * along;
    let squared = (1.0 + t2 / a2) * (1.0 + t2 / a2);
    let d = 1.0 / (PI * along * across * c4 * squared);
    0.25 * d * 2.0 / (1.0 + (1.0 + a2).sqrt())
}

/// L/E⊥ by Phong's model.
fn phong(diffuse: f64, gloss: f64, exponent: f64) -> f64 {
    let lobe = (exponent + 2.0) / 2.0 * pow(FRAC_1_SQRT_2, exponent);
    FRAC_1_SQRT_2 * FRAC_1_PI * (diffuse + gloss * lobe)
}

/// L/E⊥ of a diffuse base of `albedo` below a coat; `lost` is ρ' R.
fn base(albedo: f64, index: f64, lost: f64) -> f64 {
    let through = (1.0 - reflectance(FRAC_1_SQRT_2, index)) * (1.0 - reflectance(1.0, index));
    FRAC_1_SQRT_2 * through / (index * index) * albedo / (1.0 - lost) * FRAC_1_PI
}

/// 2 ∫ F μ dμ from inside: total reflection below the critical cosine, beyond it by the midpoint rule
/// in the cosine outside, ν = √(1 − η² (1 − μ²)), whose μ dμ is ν dν/η².
fn internal(index: f64) -> f64 {
    const STEPS: u32 = 4096;
    let outside: f64 = (0..STEPS)
        .map(|i| (f64::from(i) + 0.5) / f64::from(STEPS))
        .map(|cosine| 2.0 * cosine * reflectance(cosine, index) / f64::from(STEPS))
        .sum();
    1.0 - (1.0 - outside) / (index * index)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_inside_glass_is_mostly_kept() {
        // The fit is within half a per cent of the integral; 0.5963 for η = 1.5 (Egan and Hilgeman).
        let (fit, found) = (
            -1.4399 / 2.25 + 0.7099 / 1.5 + 0.6681 + 0.0954,
            internal(1.5),
        );
        assert!((found - 0.5963).abs() < 5e-4, "{found}");
        assert!((fit / found - 1.0).abs() < 5e-3, "{fit} {found}");
    }

    #[test]
    fn distributions_are_normalised() {
        // ∫ D cos dω = 1 for Beckmann, as a function of t = tan² h: cos⁴ h ∫ … = ∫ exp(−t/α²)/α² dt.
        let (t2, c4) = half();
        let d = 4.0 * beckmann([0.3; 2]);
        assert!((d * PI * c4 * 0.09 / exp(-t2 / 0.09) - 1.0).abs() < 1e-12);
        // At α = 1 GGX is 1/π everywhere.
        let g = 2.0 / (1.0 + 2f64.sqrt());
        assert!((4.0 * ggx([1.0; 2]) / g - FRAC_1_PI).abs() < 1e-12);
    }
}
