//! A plume of smoke on a grid of 32³, and its colour, for `scenes/smoke`; the outline of `scenes/cloud`.
//!
//! ```text
//! σ(x, y, z) = max(0, 1 − (ρ/w)²) · (½ + ½ sin(…)),   w = 0.15 + 0.3 z
//! ```
//!
//! with ρ the distance from an axis that winds upward.

use etalon_math::float64::{cos, sin};
use glam::DVec3;

/// Values along each side.
const SIDE: usize = 32;

/// A `.vol` file, version 3, of a function's values at the centres of the cells of the unit cube.
fn file(channels: usize, value: impl Fn(DVec3) -> Vec<f64>) -> Vec<u8> {
    let mut bytes = b"VOL\x03".to_vec();
    for integer in [1, SIDE, SIDE, SIDE, channels] {
        bytes.extend((integer as i32).to_le_bytes());
    }
    for corner in [0.0_f32, 0.0, 0.0, 1.0, 1.0, 1.0] {
        bytes.extend(corner.to_le_bytes());
    }
    let at = |i: usize| (i as f64 + 0.5) / SIDE as f64;
    for index in 0..SIDE * SIDE * SIDE {
        let [x, y, z] = [index % SIDE, index / SIDE % SIDE, index / SIDE / SIDE];
        for number in value(DVec3::new(at(x), at(y), at(z))) {
            bytes.extend((number as f32).to_le_bytes());
        }
    }
    bytes
}

fn density(p: DVec3) -> f64 {
    let (sway, width) = (0.15 * p.z, 0.15 + 0.3 * p.z);
    let axis = DVec3::new(
        0.5 + sway * sin(7.0 * p.z),
        0.5 + sway * cos(7.0 * p.z),
        p.z,
    );
    let fall = 1.0 - (p.distance(axis) / width).powi(2);
    let folds = sin(19.0 * p.x + 4.0 * sin(11.0 * p.z)) * sin(17.0 * p.y + 3.0 * cos(13.0 * p.z));
    let ends = (8.0 * p.z).min(5.0 * (1.0 - p.z)).clamp(0.0, 1.0);
    fall.max(0.0) * ends * (0.5 + 0.5 * folds)
}

/// What falls off from the middle of the cube, in [0, 1].
fn bump(p: DVec3) -> f64 {
    (1.0 - p.distance(DVec3::splat(0.5)).powi(2) * 4.0).max(0.0)
}

/// The files with their names.
pub(super) fn files() -> [(&'static str, Vec<u8>); 3] {
    let colour = |p: DVec3| vec![0.3 + 0.3 * p.z, 0.45 + 0.1 * p.x, 0.6 - 0.3 * p.z];
    [
        ("smoke/density.vol", file(1, |p| vec![density(p)])),
        ("smoke/albedo.vol", file(3, colour)),
        ("cloud/bump.vol", file(1, |p| vec![bump(p)])),
    ]
}
