//! A room of mirrors: floor and ceiling reflect the fractions f(λ) and c, the walls reflect all, and
//! the ceiling also emits the radiance L: [`etalon_conform::truth::mirror_room`]. f is linear in the wavelength.

use super::light::{known, rgb};
use crate::claim::Claim;
use etalon_conform::truth::mirror_room::seen;
use etalon_render::judge::ExactImage;

/// The height at which the camera stands.
const CAMERA: f64 = 0.1;

/// The picture of the room, up or down.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let radiance = claim.number("radiance")?;
    let ceiling = claim.number("ceiling")?;
    let ends = [claim.number("floor_360")?, claim.number("floor_830")?];
    let falls = claim.number("look_y")? < CAMERA;
    let colour = rgb(|lambda| {
        let floor = ends[0] + (ends[1] - ends[0]) * (lambda - 360.0) / 470.0;
        radiance * seen(floor, ceiling, falls)
    });
    Ok(known(size, |_, _| colour))
}
