//! The irradiance of the plane z = 0 under a light of radiance L, at the point (x, y).
//!
//! - Sphere of radius r at height h: E = π L (r/d)² h/d, with d the distance of its centre, as
//!   long as all of it is above the plane.
//! - Parallel disk of radius r at height h, at the distance a from its axis:
//!   E = π L · ½ [1 − (a² + h² − r²) / √((a² + h² + r²)² − 4 a² r²)].
//! - Polygon with the corners rᵢ as seen from the point: E = L/2 · Σ γᵢ n·(rᵢ × rᵢ₊₁)/|rᵢ × rᵢ₊₁|
//!   with γᵢ the angle between rᵢ and rᵢ₊₁ (Lambert, *Photometria*, 1760).
//!
//! The first two are configurations B-38 and B-13 of Howell's *Catalog of Radiation Heat Transfer
//! Configuration Factors*. The plane reflects the fraction ρ: L = ρ E/π.

use super::light::{known, rgb};
use super::pixels;
use crate::claim::Claim;
use etalon::judge::Known;
use etalon_math::float64::{acos, cos, sin};
use std::f64::consts::PI;

/// Half the width of what the camera sees (m).
const HALF_WIDTH: f64 = 2.0;

/// E/L at a point, as a function of the claim's numbers.
type Irradiance = Box<dyn Fn(f64, f64) -> f64>;

/// The picture of the plane under a light of the given kind.
pub fn picture(
    claim: &Claim,
    size: [u32; 2],
    light: impl Fn(&Claim) -> Result<Irradiance, String>,
) -> Result<Known, String> {
    let reflectance = claim.number("reflectance")?;
    let radiance = claim.number("radiance")?;
    let irradiance = light(claim)?;
    let unit = rgb(|_| reflectance * radiance / PI);
    Ok(known(size, |column, row| {
        let mean = pixels::mean(size, [column, row], |x, y| {
            irradiance(HALF_WIDTH * x, HALF_WIDTH * y)
        });
        unit.map(|c| c * mean)
    }))
}

/// Under a sphere.
pub fn sphere(claim: &Claim) -> Result<Irradiance, String> {
    let (h, r) = (claim.number("height")?, claim.number("radius")?);
    Ok(Box::new(move |x, y| {
        let d = (x * x + y * y + h * h).sqrt();
        PI * (r / d) * (r / d) * h / d
    }))
}

/// Under a parallel disk.
pub fn disk(claim: &Claim) -> Result<Irradiance, String> {
    let (h, r) = (claim.number("height")?, claim.number("radius")?);
    Ok(Box::new(move |x, y| {
        let (a2, h2, r2) = (x * x + y * y, h * h, r * r);
        let sum = a2 + h2 + r2;
        0.5 * PI * (1.0 - (sum - 2.0 * r2) / (sum * sum - 4.0 * a2 * r2).sqrt())
    }))
}

/// Under a rectangle that is turned by `tilt` degrees about the y axis.
pub fn rectangle(claim: &Claim) -> Result<Irradiance, String> {
    let h = claim.number("height")?;
    let (a, b) = (claim.number("half_width")?, claim.number("half_depth")?);
    let tilt = claim.number("tilt")?.to_radians();
    let corners =
        [(-a, -b), (a, -b), (a, b), (-a, b)].map(|(x, y)| [x * cos(tilt), y, h - x * sin(tilt)]);
    Ok(Box::new(move |x, y| {
        let seen = corners.map(|c| [c[0] - x, c[1] - y, c[2]]);
        (0.5 * lambert(&seen)).abs()
    }))
}

/// Lambert's sum for the normal (0, 0, 1).
fn lambert(corners: &[[f64; 3]]) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    (0..corners.len())
        .map(|i| {
            let (p, q) = (corners[i], corners[(i + 1) % corners.len()]);
            let cross = [
                p[1] * q[2] - p[2] * q[1],
                p[2] * q[0] - p[0] * q[2],
                p[0] * q[1] - p[1] * q[0],
            ];
            let angle = acos(dot(p, q) / (dot(p, p) * dot(q, q)).sqrt());
            angle * cross[2] / dot(cross, cross).sqrt()
        })
        .sum()
}
