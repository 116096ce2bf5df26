//! A glowing disk of radius r on the axis of a thin lens of radius R, at the distance D, while the lens is
//! focused on the distance F.
//!
//! The rays through a point of the film meet at P in the plane of focus. Those from the point a of the
//! lens reach the disk's plane at a (1 − D/F) + P D/F: all of the lens covers a circle of radius
//! c = R |1 − D/F| there (the circle of confusion: Potmesil and Chakravarty 1981), evenly, with its
//! centre at the distance d = |P| D/F from the axis. The share of it that lies on the disk is the
//! area common to two circles,
//!
//! ```text
//! r² acos((d² + r² − c²)/(2dr)) + c² acos((d² + c² − r²)/(2dc))
//!     − ½ √((r + c + d)(r + c − d)(d + r − c)(d − r + c)),
//! ```
//!
//! over π c², and the pixel's radiance that share of L.

use super::light::{known, rgb};
use super::pixels;
use crate::claim::Claim;
use etalon_math::float64::{acos, tan};
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

/// The area common to two circles of radii `a` and `b` whose centres are `d` apart.
fn common_area(d: f64, a: f64, b: f64) -> f64 {
    if d >= a + b {
        return 0.0;
    }
    if d <= (a - b).abs() {
        let least = a.min(b);
        return PI * least * least;
    }
    let half_angle = |a: f64, b: f64| acos((d * d + a * a - b * b) / (2.0 * d * a));
    let kite = (a + b + d) * (a + b - d) * (d + a - b) * (d - a + b);
    a * a * half_angle(a, b) + b * b * half_angle(b, a) - 0.5 * kite.max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::common_area;
    use std::f64::consts::PI;

    #[test]
    fn two_circles_through_each_others_centres() {
        // Two thirds of π less half of √3: the vesica piscis.
        let expected = 2.0 * PI / 3.0 - 0.5 * 3.0_f64.sqrt();
        assert!((common_area(1.0, 1.0, 1.0) - expected).abs() < 1e-14);
        assert_eq!(common_area(2.0, 1.0, 0.5), 0.0);
        assert!((common_area(0.2, 1.0, 0.5) - 0.25 * PI).abs() < 1e-15);
        // Continuous where they begin to touch, up to the rounding of acos near its ends.
        assert!(common_area(1.5 - 1e-9, 1.0, 0.5) < 1e-10);
        assert!((common_area(0.5 + 1e-9, 1.0, 0.5) - 0.25 * PI).abs() < 1e-10);
    }
}
