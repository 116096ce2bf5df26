//! The table of what was measured, in Markdown.

use super::pictures::Facts;
use etalon_math::float64;
use serde::Serialize;
use std::fmt::Write;

/// A scene.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Row {
    pub(super) scene: String,
    pub(super) etalon: Facts,
    pub(super) mitsuba: Option<Facts>,
}

/// Ours over theirs.
struct Ratios {
    variance: f64,
    /// Half of a 95 % interval of the ratio of the variances, of the normal approximation.
    within: f64,
    rate: f64,
    efficiency: f64,
    /// How much brighter ours is, relative to theirs, and by how many standard errors.
    brightness: [f64; 2],
}

impl Ratios {
    fn of(ours: &Facts, theirs: &Facts) -> Self {
        let ([v, e], [w, f]) = (ours.relative_variance, theirs.relative_variance);
        let variance = v / w;
        let error = variance * (e / v).hypot(f / w);
        let ([m, r], [n, s]) = (ours.mean, theirs.mean);
        Self {
            variance,
            within: 1.96 * error,
            rate: ours.rate() / theirs.rate(),
            efficiency: ours.efficiency() / theirs.efficiency(),
            brightness: [m / n - 1.0, (m - n) / r.hypot(s)],
        }
    }
}

/// The table: ratios to Mitsuba where it took part, and what Etalon does by itself.
pub(super) fn markdown(rows: &[Row]) -> String {
    let mut text = "| scene | variance | M samples/s | variance / Mitsuba's | samples/s / Mitsuba's | efficiency / Mitsuba's | mean − Mitsuba's |\n|---|---|---|---|---|---|---|\n".to_owned();
    let mut all = Vec::new();
    for Row {
        scene,
        etalon,
        mitsuba,
    } in rows
    {
        let (variance, rate) = (etalon.relative_variance[0], etalon.rate() / 1e6);
        // Writing to a string cannot fail.
        let _ = write!(text, "| {scene} | {variance:.3e} | {rate:.3} |");
        let _ = match mitsuba {
            None => writeln!(text, " | | | |"),
            Some(theirs) => {
                let ratios = Ratios::of(etalon, theirs);
                let [off, sigmas] = ratios.brightness;
                let line = writeln!(
                    text,
                    " {:.3} ± {:.3} | {:.2} | {:.2} | {:+.2} % ({sigmas:+.1} σ) |",
                    ratios.variance,
                    ratios.within,
                    ratios.rate,
                    ratios.efficiency,
                    100.0 * off,
                );
                all.push(ratios);
                line
            }
        };
    }
    if !all.is_empty() {
        let mean = |of: fn(&Ratios) -> f64| {
            let sum: f64 = all.iter().map(|ratios| float64::ln(of(ratios))).sum();
            float64::exp(sum / all.len() as f64)
        };
        let _ = writeln!(
            text,
            "| **geometric mean** | | | **{:.3}** | **{:.2}** | **{:.2}** | |",
            mean(|r| r.variance),
            mean(|r| r.rate),
            mean(|r| r.efficiency)
        );
    }
    text
}
