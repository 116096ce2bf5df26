//! The irradiance of the plane z = 0 under lights without extent: [`etalon_conform::truth::delta_lights`]. Spot lights fall
//! off linearly in the angle.
//!
//! The plane reflects the fraction ρ: L = ρ E/π.

use super::light::{known, rgb};
use crate::claim::Claim;
use etalon_conform::scene::Falloff;
use etalon_conform::truth::delta_lights::{fall_off, inverse_square, parallel};
use etalon_conform::truth::pixels;
use etalon_render::judge::ExactImage;
use std::f64::consts::PI;

/// Half the width of the camera's view (m).
const HALF_WIDTH: f64 = 2.0;
/// Parts of a pixel to either side, for the edges of the spot light's cone.
const CELLS: u32 = 8;

/// Under a point light.
pub fn point(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let at = position(claim)?;
    let irradiance = |x: f64, y: f64| inverse_square(at, [x, y]);
    picture(claim, size, claim.number("intensity")?, irradiance)
}

/// Under a spot light.
pub fn spot(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let at = position(claim)?;
    let target = [claim.number("target_x")?, claim.number("target_y")?];
    let angles = [claim.number("beam")?, claim.number("cutoff")?];
    let irradiance = |x: f64, y: f64| {
        fall_off(Falloff::LinearInAngle, at, target, angles, [x, y]) * inverse_square(at, [x, y])
    };
    picture(claim, size, claim.number("intensity")?, irradiance)
}

/// Under parallel light.
pub fn directional(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let to = [
        claim.number("to_x")?,
        claim.number("to_y")?,
        claim.number("to_z")?,
    ];
    let cosine = parallel(to);
    picture(claim, size, claim.number("irradiance")?, |_, _| cosine)
}

/// The picture of the plane with the irradiance `strength` · `irradiance`(x, y).
fn picture(
    claim: &Claim,
    size: [u32; 2],
    strength: f64,
    irradiance: impl Fn(f64, f64) -> f64,
) -> Result<ExactImage, String> {
    let reflectance = claim.number("reflectance")?;
    let unit = rgb(|_| reflectance * strength / PI);
    Ok(known(size, |column, row| {
        let mean = pixels::mean_of_cells(size, [column, row], CELLS, |x, y| {
            irradiance(HALF_WIDTH * x, HALF_WIDTH * y)
        });
        unit.map(|c| c * mean)
    }))
}

fn position(claim: &Claim) -> Result<[f64; 3], String> {
    Ok([
        claim.number("light_x")?,
        claim.number("light_y")?,
        claim.number("light_z")?,
    ])
}
