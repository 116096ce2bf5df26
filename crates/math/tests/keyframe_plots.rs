//! The plots of docs/animation.md: what each interpolation makes of the same keys. With `ETALON_WRITE` set they are
//! written, otherwise compared with what is there.

use etalon_math::{Interpolation, Key, Keyframes};
use std::fmt::Write;
use std::path::Path;

/// Times, heights and tangents of the keys.
const KEYS: [[f64; 3]; 4] = [
    [0.0, 0.2, 4.0],
    [1.0, 0.8, 0.0],
    [2.0, 0.3, -1.0],
    [3.0, 0.6, 1.0],
];

/// A plot of 320 × 140 units for each interpolation, one under the other.
fn plots() -> String {
    let mut svg = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 320 700\" font-family=\"sans-serif\" font-size=\"11\">\n\
         <rect width=\"320\" height=\"700\" fill=\"white\"/>\n",
    );
    for (row, kind) in Interpolation::ALL.into_iter().enumerate() {
        let place = |time: f64, value: f64| {
            let top = 140.0 * row as f64;
            [20.0 + 93.0 * time, top + 125.0 - 90.0 * value]
        };
        let keys = KEYS.map(|[time, value, tangent]| Key {
            time,
            value,
            tangent: (kind == Interpolation::Hermite).then_some(tangent),
        });
        let curve = Keyframes::new(kind, &keys).expect("four keys suit all");
        let way: Vec<String> = (0..=300)
            .map(|i| f64::from(i) / 100.0)
            .map(|time| place(time, curve.at(time)))
            .map(|[x, y]| format!("{x:.1},{y:.1}"))
            .collect();
        let name = kind.name();
        let _ = writeln!(svg, "<text x=\"20\" y=\"{}\">{name}</text>", 140 * row + 14);
        let _ = writeln!(
            svg,
            "<polyline fill=\"none\" stroke=\"#0a5\" stroke-width=\"1.5\" points=\"{}\"/>",
            way.join(" ")
        );
        for key in &keys {
            let [x, y] = place(key.time, key.value);
            if let Some(tangent) = key.tangent {
                let [dx, dy] = [18.0, -18.0 * tangent * 90.0 / 93.0];
                let scale = 18.0 / (dx * dx + dy * dy).sqrt();
                let [dx, dy] = [dx * scale, dy * scale];
                let _ = writeln!(
                    svg,
                    "<path stroke=\"#c60\" d=\"M{:.1} {:.1}L{:.1} {:.1}\"/>",
                    x - dx,
                    y - dy,
                    x + dx,
                    y + dy
                );
            }
            let _ = writeln!(
                svg,
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"#06c\"/>"
            );
        }
    }
    svg + "</svg>\n"
}

#[test]
fn the_plots_in_the_documentation_are_those() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/images/keyframes.svg");
    if std::env::var_os("ETALON_WRITE").is_some() {
        std::fs::write(&path, plots()).expect("written");
    }
    let there = std::fs::read_to_string(&path).expect("it is there");
    assert!(there == plots(), "write it with ETALON_WRITE=1");
}
