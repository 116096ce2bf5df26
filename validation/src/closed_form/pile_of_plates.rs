//! The pile of plates: a wall of radiance L seen through smooth interfaces that absorb nothing:
//! [`etalon_conform::truth::interfaces`].
//!
//! A plate is two interfaces, and thin panes are plates. θ is the same in all gaps.

use super::light::{known, rgb};
use crate::claim::Claim;
use etalon_conform::truth::interfaces::{reflectance, transmittance};
use etalon_conform::truth::pixels;
use etalon_math::float64::tan;
use etalon_render::judge::ExactImage;

/// The camera's angle of view (degrees); it looks at the plates at right angles.
const FIELD_OF_VIEW: f64 = 80.0;
/// Interfaces: three plates.
const INTERFACES: u32 = 6;

/// The picture of the wall.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    if size[0] != size[1] {
        return Err("the angle of view is that of a square film".to_owned());
    }
    let (radiance, index) = (claim.number("radiance")?, claim.number("index")?);
    let unit = rgb(|_| radiance);
    let slope = tan(0.5 * FIELD_OF_VIEW.to_radians());
    Ok(known(size, |column, row| {
        let mean = pixels::mean(size, [column, row], |x, y| {
            let cosine = 1.0 / (1.0 + slope * slope * (x * x + y * y)).sqrt();
            transmittance(reflectance(cosine, index), INTERFACES)
        });
        unit.map(|c| c * mean)
    }))
}
