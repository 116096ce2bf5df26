//! The table of measurements, in Markdown.

use super::pictures::Facts;
use etalon_math::float64;
use serde::Serialize;

/// A scene.
#[derive(Clone, Debug, Serialize)]
pub(super) struct TableRow {
    pub(super) scene: String,
    pub(super) etalon: Facts,
    pub(super) mitsuba: Option<Facts>,
}

/// Etalon's samples per second over Mitsuba's, if both rendered.
pub(super) fn rate_ratio(row: &TableRow) -> Option<f64> {
    Some(row.etalon.rate() / row.mitsuba.as_ref()?.rate())
}

/// The error of a sum or difference of independent numbers with these.
fn both(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
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
        let error = variance * both(e / v, f / w);
        let ([m, r], [n, s]) = (ours.mean, theirs.mean);
        Self {
            variance,
            within: 1.96 * error,
            rate: ours.rate() / theirs.rate(),
            efficiency: ours.efficiency() / theirs.efficiency(),
            brightness: [m / n - 1.0, (m - n) / both(r, s)],
        }
    }
}

/// The head of the table: ratios to Mitsuba where it takes part, and what Etalon does by itself.
pub(super) const HEAD: &str = "\
| scene | variance | M samples/s | variance / Mitsuba's | samples/s / Mitsuba's | efficiency / Mitsuba's | mean − Mitsuba's |
|---|---|---|---|---|---|---|";

/// The line of a scene.
pub(super) fn line(row: &TableRow) -> String {
    let TableRow {
        scene,
        etalon,
        mitsuba,
    } = row;
    let (variance, rate) = (etalon.relative_variance[0], etalon.rate() / 1e6);
    let ours = format!("| {scene} | {variance:.3e} | {rate:.3} |");
    let Some(theirs) = mitsuba else {
        return format!("{ours} | | | |");
    };
    let ratios = Ratios::of(etalon, theirs);
    let [off, sigmas] = ratios.brightness;
    format!(
        "{ours} {:.3} ± {:.3} | {:.2} | {:.2} | {:+.2} % ({sigmas:+.1} σ) |",
        ratios.variance,
        ratios.within,
        ratios.rate,
        ratios.efficiency,
        100.0 * off,
    )
}

/// The geometric means over all scenes that both programs rendered, if there are any.
pub(super) fn mean_line(rows: &[TableRow]) -> Option<String> {
    let both = rows
        .iter()
        .filter_map(|row| Some((&row.etalon, row.mitsuba.as_ref()?)));
    let all: Vec<Ratios> = both
        .map(|(ours, theirs)| Ratios::of(ours, theirs))
        .collect();
    let mean = |of: fn(&Ratios) -> f64| {
        let sum: f64 = all.iter().map(|ratios| float64::ln(of(ratios))).sum();
        float64::exp(sum / all.len() as f64)
    };
    (!all.is_empty()).then(|| {
        format!(
            "| **geometric mean** | | | **{:.3}** | **{:.2}** | **{:.2}** | |",
            mean(|r| r.variance),
            mean(|r| r.rate),
            mean(|r| r.efficiency)
        )
    })
}
