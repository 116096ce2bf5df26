//! Blends of two diffuse materials on a plane under an even sky of radiance L.
//!
//! A blend scatters (1 − w) f₀ + w f₁ (Mitsuba 3's documentation of `blendbsdf`). For diffuse
//! materials of reflectances ρ₀ and ρ₁ this is diffuse again, with (1 − w) ρ₀ + w ρ₁; a plane that
//! sees nothing but the sky sends back that fraction of L (Lambert's law). A blend may hold another.
//!
//! Where a picture with colours is the weight, its luminance is meant (`docs/known-differences.md`): of
//! the bytes (r, g, b) decoded as IEC 61966-2-1 says, 0.2126 R + 0.7152 G + 0.0722 B.

use super::light::{decoded, known, rgb};
use crate::claim::Claim;
use etalon_render::judge::ExactImage;

/// The bytes of `scenes/blend/tint.png`.
const TINT: [u8; 3] = [210, 70, 240];

/// The picture: on the left a blend of bright and dark, in the middle one of dark and a blend, on the
/// right one of bright and dark whose weight is a luminance.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    if !size[0].is_multiple_of(3) {
        return Err("the thirds must be of whole pixels".to_owned());
    }
    let radiance = claim.number("radiance")?;
    let (bright, dark) = (claim.number("bright")?, claim.number("dark")?);
    let (weight, inner) = (claim.number("weight")?, claim.number("inner")?);
    let left = mixed(weight, bright, dark);
    let middle = mixed(weight, dark, mixed(inner, bright, dark));
    let right = mixed(luminance(TINT), bright, dark);
    let thirds = [left, middle, right].map(|reflectance| rgb(|_| reflectance * radiance));
    Ok(known(size, |column, _| {
        thirds[(column * 3 / size[0]) as usize]
    }))
}

/// (1 − w) a + w b.
fn mixed(weight: f64, a: f64, b: f64) -> f64 {
    (1.0 - weight) * a + weight * b
}

/// The luminance of a colour in sRGB.
fn luminance(bytes: [u8; 3]) -> f64 {
    let [r, g, b] = bytes.map(decoded);
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

#[cfg(test)]
mod tests {
    use super::{TINT, luminance, mixed};
    use crate::folders;

    #[test]
    fn the_tint_is_the_file() {
        let path = folders::scenes().join("blend/tint.png");
        let bytes = std::fs::read(&path).expect("the bitmap of a claim");
        let raster = etalon_images::raster_file::decode(&bytes, &path).expect("a picture");
        assert_eq!(raster.to_floats(), TINT.map(|byte| f32::from(byte) / 255.0));
        assert!((luminance([255; 3]) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_weight_is_the_share_of_the_second() {
        assert_eq!(mixed(0.0, 0.8, 0.1), 0.8);
        assert_eq!(mixed(1.0, 0.8, 0.1), 0.1);
        assert!((mixed(0.25, 0.8, 0.1) - 0.625).abs() < 1e-15);
    }
}
