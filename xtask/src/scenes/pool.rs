//! The water of `scenes/pool`: a square of waves, as OBJ with normals.
//!
//! The height is a sum of sines that run in different directions; normals are its gradient's.

use etalon_math::float64::{cos, sin};
use std::fmt::Write as _;

/// Vertices along a side.
const SIDE: u32 = 49;
/// Half the length of a side (m).
const HALF: f64 = 2.0;
/// Wave vectors (m⁻¹), amplitudes (m) and phases.
const WAVES: [[f64; 4]; 5] = [
    [2.1, 0.9, 0.050, 0.3],
    [-1.3, 2.7, 0.038, 1.9],
    [3.9, -2.2, 0.020, 4.1],
    [-4.6, -3.7, 0.015, 2.6],
    [1.1, 6.3, 0.012, 5.5],
];

/// Height and its gradient at a place.
fn height(x: f64, z: f64) -> [f64; 3] {
    WAVES
        .iter()
        .fold([0.0; 3], |[h, dx, dz], [kx, kz, a, phase]| {
            let angle = kx * x + kz * z + phase;
            let slope = a * cos(angle);
            [h + a * sin(angle), dx + kx * slope, dz + kz * slope]
        })
}

/// The file's text.
pub(super) fn water() -> String {
    let mut text = String::from("# Water: written by `cargo xtask scenes`\n");
    let at = |i: u32| HALF * (2.0 * f64::from(i) / f64::from(SIDE - 1) - 1.0);
    let mut normals = String::new();
    for (x, z) in (0..SIDE).flat_map(|j| (0..SIDE).map(move |i| (at(i), at(j)))) {
        let [y, dx, dz] = height(x, z);
        let length = (1.0 + dx * dx + dz * dz).sqrt();
        let [nx, ny, nz] = [-dx, 1.0, -dz].map(|n| n / length);
        // Writing to a string cannot fail.
        let _ = writeln!(text, "v {x:.5} {y:.5} {z:.5}");
        let _ = writeln!(normals, "vn {nx:.5} {ny:.5} {nz:.5}");
    }
    text += &normals;
    for (i, j) in (1..SIDE).flat_map(|j| (1..SIDE).map(move |i| (i, j))) {
        let corner = |i: u32, j: u32| j * SIDE + i + 1;
        let [a, b] = [corner(i - 1, j - 1), corner(i, j - 1)];
        let [c, d] = [corner(i, j), corner(i - 1, j)];
        let _ = writeln!(text, "f {a}//{a} {c}//{c} {b}//{b}");
        let _ = writeln!(text, "f {a}//{a} {d}//{d} {c}//{c}");
    }
    text
}
