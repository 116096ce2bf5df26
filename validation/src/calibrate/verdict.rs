//! What the calibration came to: the promises, and whether each is kept.

use super::null::{Counts, NullRuns};
use super::single::Single;
use super::{ALARMS, CONFIDENCE, COVERAGES, MOST_UNDECIDED, REPETITIONS};
use crate::run::Task;
use etalon_render::decide::decision::FALSE_POSITIVE_LEVEL;
use etalon_statistics::error_rates::{self, Rate};
use serde_json::{Value, json};

/// The least p-value whose rate is told.
const LEAST: f64 = 1e-5;

/// Bins of a histogram.
const BINS: usize = 20;

/// A promise, and what was seen of it.
pub struct Promise {
    /// What must hold.
    pub what: String,
    /// What was seen.
    pub seen: String,
    /// Whether it holds.
    pub holds: bool,
}

/// The confidence of each interval, so that all `settings` settings' are right together.
pub fn confidence_of_each(settings: usize) -> f64 {
    // Two questions each; for each question an interval for alarms and one for each coverage, and a
    // test of uniformity.
    1.0 - (1.0 - CONFIDENCE) / (2 * settings * (COVERAGES.len() + 2)) as f64
}

/// The promises of the null runs.
pub fn of_null_runs(null: &NullRuns) -> Vec<Promise> {
    let (count, trials) = (null.alarms.count, null.alarms.trials);
    let broken: u32 = null.comparisons.iter().map(|counts| counts.broken).sum();
    // What is never decided raises no alarm either, and shows nothing.
    let idle = |counts: &&Counts| f64::from(counts.undecided) > MOST_UNDECIDED * trials as f64;
    let idle = null.comparisons.iter().filter(idle).count();
    let comparisons = null.comparisons.len();
    vec![
        Promise {
            what: "no false alarm of the whole decision in any null run".to_owned(),
            seen: format!(
                "{count} in {trials}: a rate of at most {:.1e} (promised {FALSE_POSITIVE_LEVEL:.0e})",
                null.alarms.interval.high
            ),
            holds: count == 0,
        },
        Promise {
            what: "no comparison is without a decision in any null run".to_owned(),
            seen: format!("{broken} broken"),
            holds: broken == 0,
        },
        Promise {
            what: format!(
                "no comparison is undecided in more than {:.0} % of the null runs",
                100.0 * MOST_UNDECIDED
            ),
            seen: format!("{idle} of {comparisons}"),
            holds: idle == 0,
        },
    ]
}

/// The promises of a single comparison.
pub fn of_single(single: &Single, confidence: f64) -> Vec<Promise> {
    let rate = &single.alarms;
    // Fewer repetitions say less: then the promise is that the level itself is not refuted.
    let holds = if rate.trials >= u64::from(REPETITIONS) {
        (ALARMS[0]..=ALARMS[1]).contains(&rate.observed())
    } else {
        rate.is_kept()
    };
    let mut promises = vec![
        Promise {
            what: format!(
                "{}: alarms at {} in {:.1} to {:.1} %",
                single.name,
                rate.promised,
                100.0 * ALARMS[0],
                100.0 * ALARMS[1]
            ),
            seen: told(rate),
            holds,
        },
        Promise {
            what: format!("{}: p-values are uniform", single.name),
            seen: format!("Kolmogorov-Smirnov p = {:.3}", single.uniform),
            holds: single.uniform > 1.0 - confidence,
        },
    ];
    promises.extend(single.coverages.iter().map(|rate| Promise {
        what: format!(
            "{}: {:.0} % intervals cover",
            single.name,
            100.0 * rate.promised
        ),
        seen: told(rate),
        holds: rate.is_kept(),
    }));
    promises
}

/// A rate with its interval.
fn told(rate: &Rate) -> String {
    format!(
        "{:.2} % [{:.2}, {:.2}] of {}",
        100.0 * rate.observed(),
        100.0 * rate.interval.low,
        100.0 * rate.interval.high,
        rate.trials
    )
}

/// Rates of p-values at ½, 10⁻¹, 10⁻² … 10⁻⁵, a line each.
pub fn decades(p_values: &[f64]) -> Vec<Rate> {
    error_rates::decades(p_values, LEAST, CONFIDENCE).unwrap_or_default()
}

/// How many p-values lie in each twentieth of [0, 1].
pub fn histogram(p_values: &[f64]) -> Vec<u64> {
    error_rates::histogram(p_values, BINS).unwrap_or_default()
}

/// Everything as JSON.
pub fn json(
    tasks: &[Task<'_>],
    runs: &NullRuns,
    singles: &[Single],
    promises: &[Promise],
) -> Value {
    let rate = |rate: &Rate| {
        json!({
            "promised": rate.promised, "count": rate.count, "of": rate.trials,
            "interval": [rate.interval.low, rate.interval.high],
        })
    };
    let tail = |p_values: &[f64]| {
        json!({
            "decades": decades(p_values).iter().map(rate).collect::<Vec<_>>(),
            "histogram": histogram(p_values),
        })
    };
    let comparisons = tasks.iter().zip(&runs.comparisons).map(|(task, counts)| {
        json!({
            "claim": task.claim.name, "estimator": task.label(),
            "failed": counts.failed, "undecided": counts.undecided, "broken": counts.broken,
        })
    });
    json!({
        "holds": promises.iter().all(|promise| promise.holds),
        "promises": promises.iter().map(|promise| json!({
            "what": promise.what, "seen": promise.seen, "holds": promise.holds,
        })).collect::<Vec<_>>(),
        "null_runs": {
            "alarms": rate(&runs.alarms),
            "undecided": runs.undecided,
            "comparisons": comparisons.collect::<Vec<_>>(),
            "questions": runs.p_values.iter().map(|(question, p_values)| json!({
                "question": question.to_string(), "p_values": tail(p_values),
            })).collect::<Vec<_>>(),
        },
        "single": singles.iter().map(|single| json!({
            "name": single.name, "alarms": rate(&single.alarms),
            "coverages": single.coverages.iter().map(rate).collect::<Vec<_>>(),
            "uniform": single.uniform, "p_values": tail(&single.p_values),
        })).collect::<Vec<_>>(),
    })
}
