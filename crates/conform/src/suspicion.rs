//! What a difference looks like: most first alarms are a driver's, and have a factor or a turn that betrays them.

use crate::replicate::{self, Replicate};
use crate::truth::Picture;
use std::f64::consts::PI;

/// Factors that units bring about, with what they are.
const FACTORS: [(f64, &str); 9] = [
    (PI, "π: an intensity or irradiance for a radiance"),
    (1.0 / PI, "1/π: a radiance for an irradiance"),
    (4.0 * PI, "4π: a power for an intensity"),
    (0.25 / PI, "1/(4π): an intensity for a power"),
    (2.0, "2: light from both sides, or a diameter for a radius"),
    (0.5, "1/2: light from one side, or a radius for a diameter"),
    (683.0, "683: lumens for watts"),
    (1.0 / 683.0, "1/683: watts for lumens"),
    (1.000_999, "1.000999: the luminance of a flat spectrum of 1"),
];

/// How near to a factor a ratio must be, relative to it, and to what the factor changes.
const NEAR: f64 = 0.003;
const NEAR_CHANGE: f64 = 0.3;

/// The pixel of the truth that is seen at a column and a row, with the last of either before them.
type Turn = fn(i64, i64, i64) -> [i64; 2];

/// What the mean picture looks like; `None` if like nothing that is known.
pub(crate) fn of(truth: &Picture, replicates: &[Replicate]) -> Option<String> {
    let found = replicate::mean(replicates, truth.pixels)?;
    let ratio = found.mean() / truth.mean();
    let found = found.means;
    if ratio == 0.0 {
        return Some("nothing at all is seen".to_owned());
    }
    let (width, side) = (truth.pixels as usize, truth.pixels as i64);
    let last = side - 1;
    // How far the truth is, taken from other pixels.
    let distance = |from: Turn| {
        let square = |index: usize| {
            let [x, y] = from(last, (index % width) as i64, (index / width) as i64);
            let inside = (0..side).contains(&x) && (0..side).contains(&y);
            let known = inside.then(|| truth.means[(y * side + x) as usize]);
            known.map_or(0.0, |known| (found[index] - ratio * known).powi(2))
        };
        (0..found.len()).map(square).sum::<f64>()
    };
    let turns: [(&str, Turn); 8] = [
        ("the picture upside down", |last, x, y| [x, last - y]),
        ("the picture mirrored left to right", |last, x, y| {
            [last - x, y]
        }),
        ("the picture turned by 180°", |last, x, y| {
            [last - x, last - y]
        }),
        ("the picture with rows for columns", |_, x, y| [y, x]),
        ("the picture one pixel too low", |_, x, y| [x, y - 1]),
        ("the picture one pixel too high", |_, x, y| [x, y + 1]),
        ("the picture one pixel too far right", |_, x, y| [x - 1, y]),
        ("the picture one pixel too far left", |_, x, y| [x + 1, y]),
    ];
    let straight = distance(|_, x, y| [x, y]);
    let turned = turns
        .iter()
        .map(|(name, from)| (distance(*from), *name))
        .filter(|(distance, _)| *distance < 0.1 * straight)
        .min_by(|(a, _), (b, _)| a.total_cmp(b))
        .map(|(_, name)| name.to_owned());
    let factor = FACTORS
        .iter()
        .find(|(factor, _)| {
            (ratio - factor).abs() <= (NEAR * factor).min(NEAR_CHANGE * (factor - 1.0).abs())
        })
        .map(|(_, what)| format!("a factor of {what}"));
    turned.or(factor)
}
