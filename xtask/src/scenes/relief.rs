//! Bumps, h = ½ + ½ sin 6πu sin 6πv: as heights and, displaced by a tenth, as normals; both of 64 × 64 pixels.

use etalon_images::png;
use etalon_math::float64::sin_cos;
use std::f64::consts::PI;

const SIDE: usize = 64;
/// How high the bumps of the normals are, in units of the square.
const HEIGHT: f64 = 0.1;

/// The pictures with their names.
pub(crate) fn pictures() -> Result<[(&'static str, Vec<u8>); 2], String> {
    let encode = |pixel: fn(f64, f64) -> [f64; 3]| {
        let bytes: Vec<u8> = (0..SIDE * SIDE)
            .flat_map(|i| {
                let at = |n: usize| (n as f64 + 0.5) / SIDE as f64;
                pixel(at(i % SIDE), at(i / SIDE)).map(|c| (255.0 * c).round() as u8)
            })
            .collect();
        png::encode_rgb(&bytes, SIDE, SIDE).map_err(|e| e.to_string())
    };
    Ok([
        ("bumps.png", encode(height)?),
        ("normals.png", encode(normal)?),
    ])
}

fn height(u: f64, v: f64) -> [f64; 3] {
    let (sin_u, sin_v) = (sin_cos(6.0 * PI * u).0, sin_cos(6.0 * PI * v).0);
    [0.5 + 0.5 * sin_u * sin_v; 3]
}

/// (n + 1)/2 of the normal n ∝ (−∂h/∂u, −∂h/∂v, 1).
fn normal(u: f64, v: f64) -> [f64; 3] {
    let ((sin_u, cos_u), (sin_v, cos_v)) = (sin_cos(6.0 * PI * u), sin_cos(6.0 * PI * v));
    let slope = 3.0 * PI * HEIGHT;
    let n = [-slope * cos_u * sin_v, -slope * sin_u * cos_v, 1.0];
    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    n.map(|x| 0.5 + 0.5 * x / length)
}
