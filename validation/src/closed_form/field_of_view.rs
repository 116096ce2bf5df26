//! A glowing rectangle at the distance of 1 before a camera.
//!
//! The camera sees the point (X, Y) of the plane at that distance through the film's point
//!
//! ```text
//! x = w/2 · (1 + X/s) − oₓ w,    y = h/2 − w/2 · Y/t − o_y h    (pixels)
//! ```
//!
//! for a film of w × h pixels and the offset (oₓ, o_y) of the principal point, which in Mitsuba 3 moves the
//! picture the other way. Of a pinhole, and of a lens that is focused on the plane, s = t is the tangent of
//! half the horizontal field of view φ; where the field is given for another axis, it follows from the sides:
//! by w/h for the vertical one, by w/√(w² + h²) for the diagonal. Of parallel rays s and t are the scales of
//! the camera's pose (Mitsuba 3's documentation of `perspective` and `orthographic`). The picture of the
//! rectangle is a rectangle; a pixel is the part of it that is covered. A crop shows the film's pixels from
//! its offset on.

use super::light::{known, rgb};
use crate::claim::Claim;
use etalon_conform::truth::coverage::part;
use etalon_math::float64::tan;
use etalon_render::judge::ExactImage;

/// Ends of the rectangle along x and y: `scenes/fields-of-view/scene.xml`.
const ENDS: [[f64; 2]; 2] = [[-0.14, 0.30], [-0.21, 0.11]];

/// The picture of the rectangle, of the crop's `size`.
///
/// # Errors
/// If the claim lacks a number, or there is no such camera or axis.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let film = [claim.number("resx")?, claim.number("resy")?];
    let [w, h] = film;
    let numbers = |names: [&str; 2]| -> Result<[f64; 2], String> {
        Ok([claim.number(names[0])?, claim.number(names[1])?])
    };
    let ([s, t], [shift_x, shift_y]) = match claim.text("camera")? {
        "perspective" | "thinlens" => {
            ([tangent(claim, film)?; 2], numbers(["shift_x", "shift_y"])?)
        }
        "orthographic" => (numbers(["scale_x", "scale_y"])?, [0.0; 2]),
        other => return Err(format!("there is no camera called `{other}`")),
    };
    let [crop_x, crop_y] = numbers(["crop_x", "crop_y"])?;
    let columns = ENDS[0].map(|x| 0.5 * w * (1.0 + x / s) - shift_x * w - crop_x);
    let rows = ENDS[1].map(|y| 0.5 * h - 0.5 * w * y / t - shift_y * h - crop_y);
    let radiance = claim.number("radiance")?;
    let unit = rgb(|_| radiance);
    Ok(known(size, |column, row| {
        let covered = part(column, columns) * part(row, [rows[1], rows[0]]);
        unit.map(|c| c * covered)
    }))
}

/// The tangent of half the horizontal field of view.
fn tangent(claim: &Claim, [w, h]: [f64; 2]) -> Result<f64, String> {
    let half = tan(0.5 * claim.number("fov")?.to_radians());
    let vertical = half * w / h;
    match claim.text("fov_axis")? {
        "x" => Ok(half),
        "y" => Ok(vertical),
        "diagonal" => Ok(half * w / (w * w + h * h).sqrt()),
        "smaller" => Ok(half.max(vertical)),
        "larger" => Ok(half.min(vertical)),
        other => Err(format!("there is no axis called `{other}`")),
    }
}
