//! A glowing disk of radius r on the axis of a thin lens, at the distance D, while the lens is focused on the distance F.
//!
//! The pixel's radiance is L times the share of the circle of confusion that lies on the disk
//! ([`etalon_conform::truth::thin_lens`]). The circle's centre is at the distance d = |P| D/F from the axis, where the rays
//! through the film's point meet at P in the plane of focus.

use super::light::{known, rgb};
use crate::claim::Claim;
use etalon_conform::truth::pixels;
use etalon_conform::truth::thin_lens::common_area;
use etalon_math::float64::tan;
use etalon_render::judge::ExactImage;
use std::f64::consts::PI;

/// Parts of a pixel, along each side, over which the mean is taken: the share has kinks where the circles
/// begin to touch.
const CELLS: u32 = 8;

/// The blurred disk.
///
/// # Errors
/// If the claim lacks a number.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let half_width = tan(0.5 * claim.number("fov")?.to_radians());
    let distance = claim.number("distance")?;
    let focus = claim.number("focus_distance")?;
    let confusion = claim.number("aperture_radius")? * (1.0 - distance / focus).abs();
    let radius = claim.number("radius")?;
    let radiance = claim.number("radiance")?;
    let unit = rgb(|_| radiance);
    Ok(known(size, |column, row| {
        let share = pixels::mean_of_cells(size, [column, row], CELLS, |x, y| {
            let from_axis = (x * x + y * y).sqrt() * half_width * distance;
            common_area(from_axis, radius, confusion) / (PI * confusion * confusion)
        });
        unit.map(|c| c * share)
    }))
}
