//! Form factors between rectangles: [`etalon_conform::truth::form_factors`].
//!
//! By reciprocity a pixel of a rectangle of reflectance ρ has the radiance ρ L F, with F from the
//! pixel to the light of radiance L; no rule of integration is needed.

use super::light::{known, rgb};
use crate::claim::Claim;
use etalon_conform::truth::form_factors::{Ends, parallel, perpendicular};
use etalon_render::judge::ExactImage;

/// A dark and a glowing rectangle, equal, parallel and face to face.
pub fn parallel_picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let (a, b) = (claim.number("half_width")?, claim.number("half_depth")?);
    let height = claim.number("height")?;
    picture(claim, size, [a, b], |x, y| {
        parallel(x, y, [-a, a], [-b, b], height)
    })
}

/// A dark floor and a glowing wall at its left edge.
pub fn perpendicular_picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let (a, b) = (claim.number("half_width")?, claim.number("half_depth")?);
    let height = 2.0 * claim.number("half_height")?;
    picture(claim, size, [a, b], |x, y| {
        perpendicular(x.map(|x| x + a), y, [0.0, height], [-b, b])
    })
}

/// The picture of the dark rectangle, which fills it, from the form factor of each pixel.
fn picture(
    claim: &Claim,
    size: [u32; 2],
    [half_width, half_depth]: [f64; 2],
    factor: impl Fn(Ends, Ends) -> f64,
) -> Result<ExactImage, String> {
    let [width, height] = size.map(f64::from);
    if (width * half_depth - height * half_width).abs() > 1e-9 {
        return Err("the rectangle must have the film's proportions".to_owned());
    }
    let reflectance = claim.number("reflectance")?;
    let radiance = claim.number("radiance")?;
    let unit = rgb(|_| reflectance * radiance);
    let pixel = 2.0 * half_width / width;
    Ok(known(size, |column, row| {
        let left = pixel * f64::from(column) - half_width;
        let top = half_depth - pixel * f64::from(row);
        let factor = factor([left, left + pixel], [top - pixel, top]);
        unit.map(|c| c * factor)
    }))
}
