//! The irradiance of the plane z = 0 under a light of radiance L, at the point (x, y).
//!
//! Of spheres, disks and rectangles at rest: [`etalon_conform::truth::irradiance`] and
//! [`etalon_conform::truth::polygon_lights`]. The plane reflects the fraction ρ: L = ρ E/π.

use super::light::{known, rgb};
use crate::claim::Claim;
use etalon_conform::truth::{irradiance, pixels, polygon_lights};
use etalon_render::judge::ExactImage;
use std::f64::consts::PI;

/// Half the width of the camera's view (m).
const HALF_WIDTH: f64 = 2.0;

/// E/L at a point, as a function of the claim's numbers.
pub type Irradiance = Box<dyn Fn(f64, f64) -> f64>;

/// The picture of the plane under a light of the given kind.
pub fn picture(
    claim: &Claim,
    size: [u32; 2],
    light: impl Fn(&Claim) -> Result<Irradiance, String>,
) -> Result<ExactImage, String> {
    plane(claim, size, [0.0, HALF_WIDTH], &light(claim)?)
}

/// The picture of a part of the plane beside the light, `view_half_width` to either side of
/// x = `view_x`.
pub fn beside(
    claim: &Claim,
    size: [u32; 2],
    light: impl Fn(&Claim) -> Result<Irradiance, String>,
) -> Result<ExactImage, String> {
    let view = [claim.number("view_x")?, claim.number("view_half_width")?];
    plane(claim, size, view, &light(claim)?)
}

/// The picture of the plane from `half_width` left of `centre` to as much right of it.
fn plane(
    claim: &Claim,
    size: [u32; 2],
    [centre, half_width]: [f64; 2],
    irradiance: &Irradiance,
) -> Result<ExactImage, String> {
    let reflectance = claim.number("reflectance")?;
    let radiance = claim.number("radiance")?;
    let unit = rgb(|_| reflectance * radiance / PI);
    Ok(known(size, |column, row| {
        let mean = pixels::mean(size, [column, row], |x, y| {
            irradiance(centre + half_width * x, half_width * y)
        });
        unit.map(|c| c * mean)
    }))
}

/// Under a sphere.
pub fn sphere(claim: &Claim) -> Result<Irradiance, String> {
    let (h, r) = (claim.number("height")?, claim.number("radius")?);
    Ok(Box::new(move |x, y| irradiance::sphere(h, r, [x, y])))
}

/// The mean under a sphere above the plane that goes from `x_begin` to `x_end` and from `radius` to `radius_end` at
/// constant speeds: by Simpson's rule, whose error is below 1e-9 of it.
pub fn moving_sphere(claim: &Claim) -> Result<Irradiance, String> {
    const STEPS: u32 = 200;
    let [h, r, r_end, x_begin, x_end] =
        ["height", "radius", "radius_end", "x_begin", "x_end"].map(|name| claim.number(name));
    let (h, r, r_end, x_begin, x_end) = (h?, r?, r_end?, x_begin?, x_end?);
    Ok(Box::new(move |x, y| {
        let at = |s: f64| {
            let radius = r + (r_end - r) * s;
            let across = x - x_begin - (x_end - x_begin) * s;
            let square = across * across + y * y + h * h;
            PI * radius * radius * h / (square * square.sqrt())
        };
        let weight = |i: u32| match i {
            0 | STEPS => 1.0,
            i if i % 2 == 1 => 4.0,
            _ => 2.0,
        };
        let sum: f64 = (0..=STEPS)
            .map(|i| weight(i) * at(f64::from(i) / f64::from(STEPS)))
            .sum();
        sum / (3.0 * f64::from(STEPS))
    }))
}

/// Under a parallel disk.
pub fn disk(claim: &Claim) -> Result<Irradiance, String> {
    let (h, r) = (claim.number("height")?, claim.number("radius")?);
    Ok(Box::new(move |x, y| irradiance::disk(h, r, [x, y])))
}

/// Under a rectangle that is turned by `tilt` degrees about the y axis.
pub fn rectangle(claim: &Claim) -> Result<Irradiance, String> {
    let h = claim.number("height")?;
    let half = [claim.number("half_width")?, claim.number("half_depth")?];
    let tilt = claim.number("tilt")?.to_radians();
    Ok(Box::new(move |x, y| {
        polygon_lights::rectangle(h, half, tilt, [x, y])
    }))
}
