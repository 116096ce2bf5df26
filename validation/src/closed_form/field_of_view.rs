//! A glowing rectangle at the distance of 1 before a pinhole camera.
//!
//! The camera sees the point (X, Y) of the plane at that distance through the film's point
//!
//! ```text
//! x = w/2 · (1 + X/t) − oₓ w,    y = h/2 · (1 − Y/(t h/w)) − o_y h    (pixels),
//! ```
//!
//! for a film of w × h pixels, the offset (oₓ, o_y) of the principal point, which in Mitsuba 3 moves the
//! picture the other way, and t, the tangent of half the
//! horizontal field of view φ. Where the field is given for another axis, t follows from the sides: by
//! w/h for the vertical one, by w/√(w² + h²) for the diagonal (Mitsuba 3's documentation of
//! `perspective`). The picture of the rectangle is a rectangle; a pixel is the part of it that is covered.

use super::light::{known, rgb};
use crate::claim::Claim;
use etalon::judge::Known;
use etalon_math::float64::tan;

/// Ends of the rectangle along x and y: `scenes/fields-of-view/scene.xml`.
const ENDS: [[f64; 2]; 2] = [[-0.14, 0.30], [-0.21, 0.11]];

/// The picture of the rectangle.
///
/// # Errors
/// If the claim lacks a number or there is no such axis.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<Known, String> {
    let [w, h] = size.map(f64::from);
    let half = tan(0.5 * claim.number("fov")?.to_radians());
    let vertical = half * w / h;
    let t = match claim.text("fov_axis")? {
        "x" => half,
        "y" => vertical,
        "diagonal" => half * w / (w * w + h * h).sqrt(),
        "smaller" => half.max(vertical),
        "larger" => half.min(vertical),
        other => return Err(format!("there is no axis called `{other}`")),
    };
    let [shift_x, shift_y] = [claim.number("shift_x")?, claim.number("shift_y")?];
    let columns = ENDS[0].map(|x| 0.5 * w * (1.0 + x / t) - shift_x * w);
    let rows = ENDS[1].map(|y| 0.5 * h - 0.5 * w * y / t - shift_y * h);
    let radiance = claim.number("radiance")?;
    let unit = rgb(|_| radiance);
    Ok(known(size, |column, row| {
        let covered = part(column, columns) * part(row, [rows[1], rows[0]]);
        unit.map(|c| c * covered)
    }))
}

/// How much of the pixel lies between two ends.
fn part(pixel: u32, [first, last]: [f64; 2]) -> f64 {
    let start = f64::from(pixel);
    (last.min(start + 1.0) - first.max(start)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::part;

    #[test]
    fn pixels_at_the_ends_are_covered_in_part() {
        let covered: Vec<f64> = (0..4).map(|i| part(i, [0.75, 2.5])).collect();
        assert_eq!(covered, [0.25, 1.0, 0.5, 0.0]);
        assert_eq!(part(1, [1.25, 1.5]), 0.25);
    }
}
