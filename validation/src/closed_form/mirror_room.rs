//! A room of mirrors: floor and ceiling reflect the fractions f(λ) and c, the walls reflect all, and
//! the ceiling also emits the radiance L.
//!
//! Upright walls turn a ray but not its angle of elevation, so floor and ceiling take turns. A ray
//! that rises meets L, and f c of the same again after one round trip; a falling ray sees f times the rising radiance:
//!
//! L↑ = L (1 + f c + (f c)² + …) = L/(1 − f c),   L↓ = f L↑
//!
//! (The sum of a geometric series; for parallel mirrors it is Stokes's of 1862.) f is linear in the
//! wavelength.

use super::light::{known, rgb};
use crate::claim::Claim;
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

/// What is seen of a ceiling of radiance 1.
fn seen(floor: f64, ceiling: f64, falls: bool) -> f64 {
    let rising = 1.0 / (1.0 - floor * ceiling);
    if falls { floor * rising } else { rising }
}

#[cfg(test)]
mod tests {
    use super::seen;

    #[test]
    fn the_series_is_summed() {
        let (floor, ceiling) = (0.7, 0.8);
        for falls in [false, true] {
            // Term by term, mirror by mirror.
            let (mut sum, mut throughput, mut at_floor) = (0.0, 1.0, falls);
            for _ in 0..200 {
                if at_floor {
                    throughput *= floor;
                } else {
                    sum += throughput;
                    throughput *= ceiling;
                }
                at_floor = !at_floor;
            }
            assert!((seen(floor, ceiling, falls) - sum).abs() < 1e-13);
        }
    }
}
