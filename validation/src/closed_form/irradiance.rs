//! The irradiance of the plane z = 0 under a light of radiance L, at the point (x, y).
//!
//! - Sphere of radius r at height h: E = π L (r/d)² h/d, with d the distance of its centre, as
//!   long as all of it is above the plane. Of a sphere that the plane cuts only a part is seen
//!   (Snyder, "Area light sources for real-time graphics", 1996): with cos ω = h/d, sin σ = r/d,
//!   x = cot σ, y = −x cot ω, z = sin ω √(1 − y²),
//!   E = L [(cos ω acos y − x z) sin² σ + atan(z/x)].
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
use etalon_math::float64::{acos, atan, cos, sin};
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
    Ok(Box::new(move |x, y| {
        let d = (x * x + y * y + h * h).sqrt();
        let (sine, cosine) = (r / d, h / d);
        if h >= r {
            return PI * sine * sine * cosine;
        }
        let across = (1.0 - cosine * cosine).sqrt();
        let cot = (1.0 / (sine * sine) - 1.0).sqrt();
        let y = -cot * cosine / across;
        let z = across * (1.0 - y * y).sqrt();
        (cosine * acos(y) - cot * z) * sine * sine + atan(z / cot)
    }))
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

/// Lambert's sum for the normal (0, 0, 1) and the corners as seen from the point: twice E/L, with
/// the sign of the turn.
pub fn lambert(corners: &[[f64; 3]]) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ cos θ cos θ'/d² dA over a light given by points, normals and areas: the definition.
    fn by_definition(
        lights: impl Iterator<Item = ([f64; 3], [f64; 3], f64)>,
        x: f64,
        y: f64,
    ) -> f64 {
        lights
            .map(|(p, n, area)| {
                let d = [p[0] - x, p[1] - y, p[2]];
                let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
                let facing = -(d[0] * n[0] + d[1] * n[1] + d[2] * n[2]);
                facing.max(0.0) * d[2].max(0.0) / (square * square) * area
            })
            .sum()
    }

    fn claim(numbers: &[(&str, f64)]) -> Claim {
        let defines: String = numbers
            .iter()
            .map(|(key, value)| format!("{key} = {value:?}\n"))
            .collect();
        toml::from_str(&format!(
            "title = \"\"\nscene = \"\"\nestimators = []\n[defines]\n{defines}\n\
             [oracle]\nkind = \"closed_form\"\nformula = \"\"\n"
        ))
        .expect("a claim")
    }

    const POINTS: [[f64; 2]; 3] = [[0.1, 0.0], [0.7, -0.4], [-1.6, 1.9]];
    const N: usize = 400;

    fn grid() -> impl Iterator<Item = (f64, f64)> {
        let at = |i: usize| (i as f64 + 0.5) / N as f64;
        (0..N * N).map(move |i| (at(i % N), at(i / N)))
    }

    #[test]
    fn sphere_is_the_integral_over_its_surface() {
        let irradiance = sphere(&claim(&[("height", 1.5), ("radius", 0.5)])).expect("numbers");
        for [x, y] in POINTS {
            let lights = grid().map(|(u, v)| {
                let z = 2.0 * u - 1.0;
                let (r, phi) = ((1.0 - z * z).sqrt(), 2.0 * PI * v);
                let n = [r * cos(phi), r * sin(phi), z];
                let p = [0.5 * n[0], 0.5 * n[1], 1.5 + 0.5 * n[2]];
                (p, n, PI / (N * N) as f64)
            });
            let expected = by_definition(lights, x, y);
            assert!((irradiance(x, y) / expected - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn a_sphere_is_cut_by_the_plane() {
        // (height, radius, distance along the plane, E/L): ∫ cos θ dω over the visible part of the
        // cone, by mpmath's quadrature to 15 digits.
        let numbers = [
            (0.1, 0.3, 1.5, 0.010_382_056_894_715),
            (0.0, 0.3, 0.5, 0.163_501_108_793_284),
            (0.1, 0.3, 4.0, 0.000_548_419_568_318_992),
        ];
        for (height, radius, distance, expected) in numbers {
            let numbers = [("height", height), ("radius", radius)];
            let irradiance = sphere(&claim(&numbers)).expect("numbers");
            let found = irradiance(0.6 * distance, -0.8 * distance);
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
        }
    }

    #[test]
    fn disk_is_the_integral_over_its_surface() {
        let irradiance = disk(&claim(&[("height", 1.0), ("radius", 0.75)])).expect("numbers");
        for [x, y] in POINTS {
            let lights = grid().map(|(u, v)| {
                let (r, phi) = (0.75 * u.sqrt(), 2.0 * PI * v);
                let area = PI * 0.75 * 0.75 / (N * N) as f64;
                ([r * cos(phi), r * sin(phi), 1.0], [0.0, 0.0, -1.0], area)
            });
            let expected = by_definition(lights, x, y);
            assert!((irradiance(x, y) / expected - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn rectangle_is_the_integral_over_its_surface() {
        let numbers = [
            ("height", 1.2),
            ("half_width", 0.8),
            ("half_depth", 0.4),
            ("tilt", 30.0),
        ];
        let irradiance = rectangle(&claim(&numbers)).expect("numbers");
        let tilt = 30f64.to_radians();
        for [x, y] in POINTS {
            let lights = grid().map(|(u, v)| {
                let (a, b) = (0.8 * (2.0 * u - 1.0), 0.4 * (2.0 * v - 1.0));
                let p = [a * cos(tilt), b, 1.2 - a * sin(tilt)];
                let n = [-sin(tilt), 0.0, -cos(tilt)];
                (p, n, 1.6 * 0.8 / (N * N) as f64)
            });
            let expected = by_definition(lights, x, y);
            assert!((irradiance(x, y) / expected - 1.0).abs() < 1e-4);
        }
    }
}
