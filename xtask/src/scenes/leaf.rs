//! A leaf: its colour with veins, and its outline as an opacity, both of 64 × 64 pixels.

use etalon_images::png;
use etalon_math::float64::{pow, sin};

const SIDE: usize = 64;

/// The pictures with their names.
pub(crate) fn pictures() -> Result<[(&'static str, Vec<u8>); 2], String> {
    let encode = |pixel: fn(f64, f64) -> [u8; 3]| {
        let bytes: Vec<u8> = (0..SIDE * SIDE)
            .flat_map(|i| {
                let at = |n: usize| (n as f64 + 0.5) / SIDE as f64;
                pixel(2.0 * at(i % SIDE) - 1.0, 1.0 - at(i / SIDE))
            })
            .collect();
        png::encode_rgb(&bytes, SIDE, SIDE).map_err(|e| e.to_string())
    };
    Ok([
        ("leaf.png", encode(colour)?),
        ("leaf-opacity.png", encode(opacity)?),
    ])
}

/// How far the leaf reaches from its midrib at the height `y`.
fn half_width(y: f64) -> f64 {
    if y < 0.08 {
        return 0.04;
    }
    let t = (y - 0.08) / 0.9;
    if t >= 1.0 {
        return 0.0;
    }
    let teeth = 0.03 * sin(70.0 * y);
    (0.78 * sin(std::f64::consts::PI * pow(t, 0.7)) + teeth * (1.0 - t)).max(0.0)
}

/// White where the leaf is, `x` from −1 to 1 and `y` from 0 (stalk) to 1 (tip).
fn opacity(x: f64, y: f64) -> [u8; 3] {
    let inside = (half_width(y) - x.abs()) * SIDE as f64 * 0.5 + 0.5;
    [(255.0 * inside.clamp(0.0, 1.0)) as u8; 3]
}

/// The colour, sRGB.
fn colour(x: f64, y: f64) -> [u8; 3] {
    let side_vein = (14.0 * (y - 0.55 * x.abs())).rem_euclid(1.0);
    let vein = x.abs() < 0.03 || side_vein < 0.12;
    let shade = 1.0 - 0.25 * x.abs() - 0.2 * (1.0 - y);
    let base = if vein {
        [168.0, 190.0, 92.0]
    } else {
        [78.0, 140.0, 48.0]
    };
    base.map(|c| (c * shade) as u8)
}
