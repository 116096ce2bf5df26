//! The grey furnace: a closed surface that emits L_e and reflects the fraction ρ diffusely.
//!
//! L = L_e + ρ L, hence L = L_e / (1 − ρ) everywhere and in every direction (Kirchhoff's law; for
//! renderers: Jensen, *Realistic Image Synthesis Using Photon Mapping*, 2001, section 2.6).

use super::light::{known, rgb};
use crate::claim::Claim;
use etalon_conform::truth::furnace::closed;
use etalon_render::judge::ExactImage;

/// The picture of a furnace of `reflectance` that emits `radiance`.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let reflectance = claim.number("reflectance")?;
    let radiance = claim.number("radiance")?;
    let colour = rgb(|_| closed(radiance, reflectance));
    Ok(known(size, |_, _| colour))
}

/// The picture of things that absorb nothing under a sky of `radiance`: the sky alone.
pub fn white(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let radiance = claim.number("radiance")?;
    let colour = rgb(|_| radiance);
    Ok(known(size, |_, _| colour))
}
