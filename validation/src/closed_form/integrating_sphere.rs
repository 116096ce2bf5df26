//! The integrating sphere: a point light of intensity I at any place inside a closed sphere of
//! radius R that reflects the fraction ρ diffusely: [`etalon_conform::truth::integrating_sphere`].
//!
//! ρ is linear in the wavelength.

use super::light::{known, rgb};
use crate::claim::Claim;
use etalon_conform::truth::integrating_sphere::{indirect, per_square, wall};
use etalon_conform::truth::pixels;
use etalon_render::judge::ExactImage;
use std::f64::consts::PI;

/// Where the camera stands; it looks along +z with an angle of view of 90°.
const CAMERA: [f64; 3] = [0.0, 0.0, -0.6];

/// The picture of the sphere's inside.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let radius = claim.number("radius")?;
    let intensity = claim.number("intensity")?;
    let lamp = [
        claim.number("light_x")?,
        claim.number("light_y")?,
        claim.number("light_z")?,
    ];
    let (low, high) = (
        claim.number("reflectance_360")?,
        claim.number("reflectance_830")?,
    );
    let reflectance = |lambda: f64| low + (high - low) * (lambda - 360.0) / 470.0;
    let direct = rgb(|lambda| reflectance(lambda) / PI);
    let rest = rgb(|lambda| indirect(reflectance(lambda), intensity, radius));
    Ok(known(size, |column, row| {
        let irradiance = pixels::mean(size, [column, row], |x, y| {
            // Looking along +z with +y up, +x is on the left.
            let point = wall(CAMERA, [-x, y, 1.0], radius);
            intensity * per_square(point, lamp, radius)
        });
        std::array::from_fn(|c| direct[c] * irradiance + rest[c])
    }))
}
