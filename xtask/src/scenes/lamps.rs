//! A thousand lamps of different size, colour and power: small spheres on a ceiling of lanterns,
//! and small panels beside the road below.

use super::sequence::halton;
use etalon_math::float64::pow;
use std::fmt::Write as _;

/// Spheres along each side.
const COLUMNS: u32 = 40;
const ROWS: u32 = 24;
/// Panels.
const PANELS: u32 = 120;

/// The lamps, as a scene to be included.
pub(crate) fn fragment() -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n\
         <!-- 1080 lamps; written by `cargo xtask scenes`. -->\n<scene version=\"3.0.0\">\n",
    );
    for index in 0..ROWS * COLUMNS {
        let (row, column) = (index / COLUMNS, index % COLUMNS);
        let x = 0.25 * (f64::from(column) - 0.5 * f64::from(COLUMNS - 1) + 0.7 * halton(0, index));
        let z = 0.25 * (f64::from(row) - 0.5 * f64::from(ROWS - 1) + 0.7 * halton(1, index));
        let y = 1.6 + 0.9 * halton(2, index);
        let radius = 0.012 + 0.02 * halton(3, index);
        let [r, g, b] = radiance(index);
        let _ = writeln!(
            text,
            "    <shape type=\"sphere\"><point name=\"center\" x=\"{x:.4}\" y=\"{y:.4}\" z=\"{z:.4}\"/>\
             <float name=\"radius\" value=\"{radius:.4}\"/><emitter type=\"area\">\
             <rgb name=\"radiance\" value=\"{r:.3}, {g:.3}, {b:.3}\"/></emitter></shape>"
        );
    }
    for index in 0..PANELS {
        let side = if index % 2 == 0 { -1.0 } else { 1.0 };
        let z = 0.1 * (f64::from(index / 2) - 0.25 * f64::from(PANELS));
        let [r, g, b] = radiance(index + 7).map(|c| 0.4 * c);
        let _ = writeln!(
            text,
            "    <shape type=\"rectangle\"><transform name=\"to_world\">\
             <scale x=\"0.03\" y=\"0.02\" z=\"1\"/><rotate y=\"1\" angle=\"{:.0}\"/>\
             <translate x=\"{:.2}\" y=\"0.06\" z=\"{z:.2}\"/></transform><emitter type=\"area\">\
             <rgb name=\"radiance\" value=\"{r:.3}, {g:.3}, {b:.3}\"/></emitter></shape>",
            -90.0 * side,
            1.1 * side,
        );
    }
    text + "</scene>\n"
}

/// A warm, a cool or a saturated colour; powers differ by a factor of ten.
fn radiance(index: u32) -> [f64; 3] {
    let strength = 4.0 * pow(10.0, halton(4, index));
    let hues = [
        [1.0, 0.72, 0.38],
        [1.0, 0.86, 0.64],
        [0.7, 0.84, 1.0],
        [1.0, 0.34, 0.26],
        [0.36, 0.9, 0.5],
        [0.42, 0.5, 1.0],
    ];
    let hue = hues[(halton(5, index) * hues.len() as f64) as usize];
    hue.map(|c| strength * c)
}
