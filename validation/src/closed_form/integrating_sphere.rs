//! The integrating sphere: a point light of intensity I at any place inside a closed sphere of
//! radius R that reflects the fraction ρ diffusely.
//!
//! Light leaving a point of a sphere diffusely spreads evenly over all of it, so only the direct
//! light knows where the lamp is:
//!
//! L(x) = ρ/π · [ I cos θ/d² + ρ/(1 − ρ) · I/R² ]
//!
//! (Jacquez and Kuppenheim, "Theory of the integrating sphere", *JOSA* 45, 1955.) ρ is linear in
//! the wavelength.

use super::light::{known, rgb};
use super::pixels;
use crate::claim::Claim;
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
    let rest = rgb(|lambda| {
        let rho = reflectance(lambda);
        rho * rho / (PI * (1.0 - rho)) * intensity / (radius * radius)
    });
    Ok(known(size, |column, row| {
        let irradiance = pixels::mean(size, [column, row], |x, y| {
            // Looking along +z with +y up, +x is on the left.
            let point = wall([-x, y, 1.0], radius);
            intensity * per_square(point, lamp, radius)
        });
        std::array::from_fn(|c| direct[c] * irradiance + rest[c])
    }))
}

/// The wall in a direction from the camera.
fn wall(direction: [f64; 3], radius: f64) -> [f64; 3] {
    let a = dot(direction, direction);
    let b = dot(CAMERA, direction);
    let c = dot(CAMERA, CAMERA) - radius * radius;
    let t = (-b + (b * b - a * c).sqrt()) / a;
    std::array::from_fn(|i| CAMERA[i] + t * direction[i])
}

/// cos θ/d² at a point of the wall.
fn per_square(point: [f64; 3], lamp: [f64; 3], radius: f64) -> f64 {
    let to: [f64; 3] = std::array::from_fn(|i| lamp[i] - point[i]);
    let square = dot(to, to);
    // The inward normal is −point/R.
    -dot(to, point) / (radius * square * square.sqrt())
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_math::float64::{cos, sin};

    #[test]
    fn the_wall_receives_what_the_lamp_gives() {
        // The mean of cos θ/d² over the wall is 4π/(4π R²), wherever the lamp is.
        let (n, radius) = (300, 1.3);
        let mut sum = 0.0;
        for i in 0..n * n {
            let z = 2.0 * (f64::from(i % n) + 0.5) / f64::from(n) - 1.0;
            let phi = 2.0 * PI * (f64::from(i / n) + 0.5) / f64::from(n);
            let r = (1.0 - z * z).sqrt();
            let point = [r * cos(phi), r * sin(phi), z].map(|c| radius * c);
            sum += per_square(point, [0.3, 0.35, 0.1], radius);
        }
        let mean = sum / f64::from(n * n);
        assert!((mean * radius * radius - 1.0).abs() < 1e-4, "{mean}");
    }

    #[test]
    fn the_camera_sees_the_wall() {
        let point = wall([0.4, -0.2, 1.0], 1.0);
        assert!((dot(point, point) - 1.0).abs() < 1e-12);
        assert!(point[2] > CAMERA[2]);
    }
}
