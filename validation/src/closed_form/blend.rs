//! Blends of two diffuse materials on a plane under an even sky of radiance L.
//!
//! A blend scatters (1 − w) f₀ + w f₁ (Mitsuba 3's documentation of `blendbsdf`). For diffuse
//! materials of reflectances ρ₀ and ρ₁ this is diffuse again, with (1 − w) ρ₀ + w ρ₁; a plane that
//! sees nothing but the sky sends back that fraction of L (Lambert's law). A blend may hold another.

use super::light::{known, rgb};
use crate::claim::Claim;
use etalon::judge::Known;

/// The picture: on the left a blend of bright and dark, on the right one of dark and a blend.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<Known, String> {
    if !size[0].is_multiple_of(2) {
        return Err("the halves must be of whole pixels".to_owned());
    }
    let radiance = claim.number("radiance")?;
    let (bright, dark) = (claim.number("bright")?, claim.number("dark")?);
    let (weight, inner) = (claim.number("weight")?, claim.number("inner")?);
    let left = mixed(weight, bright, dark);
    let right = mixed(weight, dark, mixed(inner, bright, dark));
    let halves = [left, right].map(|reflectance| rgb(|_| reflectance * radiance));
    Ok(known(size, |column, _| {
        halves[usize::from(column >= size[0] / 2)]
    }))
}

/// (1 − w) a + w b.
fn mixed(weight: f64, a: f64, b: f64) -> f64 {
    (1.0 - weight) * a + weight * b
}

#[cfg(test)]
mod tests {
    use super::mixed;

    #[test]
    fn a_weight_is_the_share_of_the_second() {
        assert_eq!(mixed(0.0, 0.8, 0.1), 0.8);
        assert_eq!(mixed(1.0, 0.8, 0.1), 0.1);
        assert!((mixed(0.25, 0.8, 0.1) - 0.625).abs() < 1e-15);
    }
}
