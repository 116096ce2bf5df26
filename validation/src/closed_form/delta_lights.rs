//! The irradiance of the plane z = 0 under lights without extent, at the point (x, y).
//!
//! - Point light of intensity I at the height h, at the distance d: E = I h/d³, the law of inverse
//!   squares with Lambert's cosine h/d (*Photometria*, 1760).
//! - Spot light: the same with I f(θ), θ the angle from its axis: f = 1 up to the beam width b,
//!   (c − θ)/(c − b) from there to the cutoff c, and 0 beyond (Mitsuba 3's documentation of `spot`).
//! - Directional light of irradiance E⊥ that goes along ω: E = E⊥ |ω_z|/|ω|.
//!
//! The plane reflects the fraction ρ: L = ρ E/π.

use super::light::{known, rgb};
use super::pixels;
use crate::claim::Claim;
use etalon_math::float64::acos;
use etalon_render::judge::ExactImage;
use std::f64::consts::PI;

/// Half the width of the camera's view (m).
const HALF_WIDTH: f64 = 2.0;
/// Parts of a pixel to either side, for the edges of the spot light's cone.
const CELLS: u32 = 8;

/// Under a point light.
pub fn point(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let at = position(claim)?;
    let irradiance = |x: f64, y: f64| inverse_square(at, [x, y]);
    picture(claim, size, claim.number("intensity")?, irradiance)
}

/// Under a spot light.
pub fn spot(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let at = position(claim)?;
    let target = [claim.number("target_x")?, claim.number("target_y")?];
    let angles = [claim.number("beam")?, claim.number("cutoff")?];
    let irradiance =
        |x: f64, y: f64| fall_off(at, target, angles, [x, y]) * inverse_square(at, [x, y]);
    picture(claim, size, claim.number("intensity")?, irradiance)
}

/// Under parallel light.
pub fn directional(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let to = [
        claim.number("to_x")?,
        claim.number("to_y")?,
        claim.number("to_z")?,
    ];
    let cosine = -to[2] / dot(to, to).sqrt();
    picture(claim, size, claim.number("irradiance")?, |_, _| cosine)
}

/// The picture of the plane with the irradiance `strength` · `irradiance`(x, y).
fn picture(
    claim: &Claim,
    size: [u32; 2],
    strength: f64,
    irradiance: impl Fn(f64, f64) -> f64,
) -> Result<ExactImage, String> {
    let reflectance = claim.number("reflectance")?;
    let unit = rgb(|_| reflectance * strength / PI);
    Ok(known(size, |column, row| {
        let mean = pixels::mean_of_cells(size, [column, row], CELLS, |x, y| {
            irradiance(HALF_WIDTH * x, HALF_WIDTH * y)
        });
        unit.map(|c| c * mean)
    }))
}

fn position(claim: &Claim) -> Result<[f64; 3], String> {
    Ok([
        claim.number("light_x")?,
        claim.number("light_y")?,
        claim.number("light_z")?,
    ])
}

/// E/I of a light `at` a place.
fn inverse_square(at: [f64; 3], [x, y]: [f64; 2]) -> f64 {
    let to = [at[0] - x, at[1] - y, at[2]];
    let square = dot(to, to);
    to[2] / (square * square.sqrt())
}

/// f(θ) of a spot light `at` a place that aims at `target` in the plane. Angles in degrees.
fn fall_off(at: [f64; 3], target: [f64; 2], [beam, cutoff]: [f64; 2], [x, y]: [f64; 2]) -> f64 {
    let axis = [target[0] - at[0], target[1] - at[1], -at[2]];
    let ray = [x - at[0], y - at[1], -at[2]];
    let cosine = dot(axis, ray) / (dot(axis, axis) * dot(ray, ray)).sqrt();
    let angle = acos(cosine.min(1.0)).to_degrees();
    ((cutoff - angle) / (cutoff - beam)).clamp(0.0, 1.0)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_math::float64::{sin, tan};

    #[test]
    fn irradiance_is_the_textbooks() {
        // 100 cd at 2 m: 25 lx below the lamp, and 25 cos³ 60° = 3.125 lx at 60° from it.
        let at = [1.0, -1.0, 2.0];
        assert!((100.0 * inverse_square(at, [1.0, -1.0]) - 25.0).abs() < 1e-12);
        let aside = 1.0 + 2.0 * tan(PI / 3.0);
        assert!((100.0 * inverse_square(at, [aside, -1.0]) - 3.125).abs() < 1e-12);
    }

    #[test]
    fn the_plane_receives_what_the_spot_light_gives() {
        // Φ = I ∫ f dω = 2π I [1 − (sin c − sin b)/(c − b)].
        let (beam, cutoff) = (15f64, 40f64);
        let (b, c) = (beam.to_radians(), cutoff.to_radians());
        let expected = 2.0 * PI * (1.0 - (sin(c) - sin(b)) / (c - b));
        let at = [0.3, 0.1, 1.2];
        let (n, half) = (1200, 1.1);
        let step = 2.0 * half / f64::from(n);
        let mut sum = 0.0;
        for i in 0..n * n {
            let x = 0.3 - half + step * (f64::from(i % n) + 0.5);
            let y = 0.1 - half + step * (f64::from(i / n) + 0.5);
            let f = fall_off(at, [0.3, 0.1], [beam, cutoff], [x, y]);
            sum += f * inverse_square(at, [x, y]) * step * step;
        }
        assert!((sum / expected - 1.0).abs() < 1e-4, "{sum} {expected}");
    }

    #[test]
    fn a_spot_light_is_dark_beyond_its_cutoff() {
        let at = [-1.0, 0.0, 1.0];
        // The axis leans by 45°; the point below the lamp is 45° off, the point (−1 + tan 65°, 0) 20°.
        let f = |x: f64| fall_off(at, [0.0, 0.0], [10.0, 40.0], [x, 0.0]);
        assert_eq!(f(-1.0), 0.0);
        assert_eq!(f(0.0), 1.0);
        let aside = tan(65f64.to_radians()) - 1.0;
        assert!((f(aside) - 2.0 / 3.0).abs() < 1e-12);
    }
}
