//! A sky of 128 × 64 pixels: a gradient from the horizon to the zenith, a bright soft sun, two
//! windows of a studio, a dark ground.

use etalon_images::{Frame, Image, exr};
use etalon_math::float64::{cos, exp, sin};
use std::path::Path;

const WIDTH: usize = 128;
const HEIGHT: usize = 64;

/// Writes the sky as an EXR file.
pub(crate) fn write(path: &Path) -> Result<(), String> {
    let mut planes = [const { Vec::new() }; 3];
    for row in 0..HEIGHT {
        for column in 0..WIDTH {
            let colour = radiance(row, column);
            for (plane, value) in planes.iter_mut().zip(colour) {
                plane.push(value as f32);
            }
        }
    }
    let [r, g, b] = planes;
    let image = Image::new(WIDTH, HEIGHT)
        .with("R", r)
        .with("G", g)
        .with("B", b);
    let frame = Frame::whole(&image);
    exr::write(path, &image, frame, "").map_err(|e| e.to_string())
}

/// Linear Rec. 709 at a pixel.
fn radiance(row: usize, column: usize) -> [f64; 3] {
    use std::f64::consts::PI;
    let theta = PI * (row as f64 + 0.5) / HEIGHT as f64;
    let phi = 2.0 * PI * (column as f64 + 0.5) / WIDTH as f64;
    let direction = [sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi)];
    let height = direction[1];
    if height < 0.0 {
        let fade = exp(3.0 * height);
        return [0.09 + 0.08 * fade, 0.08 + 0.075 * fade, 0.07 + 0.07 * fade];
    }
    let zenith = 1.0 - exp(-3.0 * height);
    let mix = |low: f64, high: f64| low + (high - low) * zenith;
    let mut colour = [mix(0.75, 0.16), mix(0.7, 0.3), mix(0.62, 0.62)];
    let glow = |centre: [f64; 3], sharpness: f64| {
        let cosine: f64 = centre.iter().zip(direction).map(|(a, b)| a * b).sum();
        exp(sharpness * (cosine - 1.0))
    };
    let sun = 28.0 * glow([0.48, 0.64, 0.6], 180.0) + 0.8 * glow([0.48, 0.64, 0.6], 8.0);
    let window = 6.0 * glow([-0.8, 0.36, 0.48], 60.0);
    for (channel, (warm, cool)) in colour
        .iter_mut()
        .zip([(1.0, 0.7), (0.86, 0.85), (0.62, 1.0)])
    {
        *channel += sun * warm + window * cool;
    }
    colour
}
