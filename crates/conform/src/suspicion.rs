//! What a difference looks like: most first alarms are a driver's, and have a factor or a turn that betrays them.

use crate::judge::RESAMPLING;
use crate::replicate::{self, Replicate};
use crate::truth::Picture;
use etalon_statistics::judgement::{self, Symmetry};
use etalon_statistics::tails::Limits;
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

/// A turned picture is like what is found if the squares of its differences are this small a part of those of the straight one.
const LIKE: f64 = 0.05;

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
        // Pixels at the edge, which may come from outside, are left out of all.
        let inner = (0..found.len()).filter(|index| {
            let place = [index % width, index / width];
            place.iter().all(|n| (1..width - 1).contains(n))
        });
        let square = |index: usize| {
            let [x, y] = from(last, (index % width) as i64, (index / width) as i64);
            (found[index] - ratio * truth.means[(y * side + x) as usize]).powi(2)
        };
        inner.map(square).sum::<f64>()
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
        .filter(|(distance, _)| *distance < LIKE * straight)
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

/// Whether the first two poses are shown to differ, as no seed makes them; of each picture its pose, and its mean over the truth's.
pub(crate) fn poses_differ(replicates: &[(u32, f64)], level: f64) -> Option<String> {
    let of = |pose: u32| -> Vec<f64> {
        let own = replicates.iter().filter(|(other, _)| *other == pose);
        own.map(|(_, ratio)| ratio - 1.0).collect()
    };
    let [a, b] = [of(0), of(1)];
    let (unknown, limits) = (Symmetry::Unknown, &Limits::DECLARED);
    let judged = judgement::judge_difference(&a, &b, level, unknown, limits, &RESAMPLING)?;
    let (interval, _) = judged.interval?;
    let mean = |sample: &[f64]| 100.0 * sample.iter().sum::<f64>() / sample.len() as f64;
    (!interval.contains(0.0)).then(|| {
        format!(
            "its poses differ, {:+.2} % and {:+.2} %: rounding, or something that depends on direction or size",
            mean(&a),
            mean(&b)
        )
    })
}
