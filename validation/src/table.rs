//! The table on standard output, and the JSON beside the report.

use crate::outcome::{ALPHA, Outcome, Row, counts};
use serde_json::{Value, json};

/// The headings of the table.
pub fn head() -> String {
    format!(
        "{:<26} {:<22} {:>7} {:>6}  {:<24} {:>7} {:>9}  {:<10} outcome",
        "claim", "estimator", "spp", "s", "bias interval (%)", "sees", "p", "verdict"
    )
}

/// One line of the table: the channel whose interval reaches farthest speaks for all.
pub fn line(row: &Row<'_>) -> String {
    let claim = &row.task.claim.name;
    let estimator = label(row);
    let compared = match &row.compared {
        Ok(compared) => compared,
        Err(reason) => {
            return format!(
                "{claim:<26} {estimator:<22} {}\n    {}",
                row.outcome,
                reason.replace('\n', "\n    ")
            );
        }
    };
    let (interval, sees) = match compared.judgement.widest() {
        Some(channel) => (
            format!(
                "{} [{:+.4}, {:+.4}]",
                channel.channel,
                100.0 * channel.interval[0],
                100.0 * channel.interval[1]
            ),
            format!("{:.4}", 100.0 * channel.smallest_detectable),
        ),
        None => (String::new(), String::new()),
    };
    let p = row
        .p_corrected
        .map_or("-".to_owned(), |p| format!("{p:.1e}"));
    let verdict = row.verdict.map_or(String::new(), |v| v.to_string());
    let text = format!(
        "{claim:<26} {estimator:<22} {:>7} {:>6.1}  {interval:<24} {sees:>7} {p:>9}  {verdict:<10} {}",
        compared.spp, compared.seconds, row.outcome
    );
    if row.outcome == Outcome::Passed {
        return text;
    }
    text + &worst_tiles(row)
}

/// Which tiles are off, where anything is.
fn worst_tiles(row: &Row<'_>) -> String {
    let Ok(compared) = &row.compared else {
        return String::new();
    };
    let judgement = &compared.judgement;
    judgement
        .images
        .iter()
        .map(|image| {
            format!(
                "\n    {} {:.5} instead of {:.5}, bias {:+.4} % in [{:+.4}, {:+.4}] %",
                image.channel,
                image.mean,
                image.other_mean,
                100.0 * image.bias,
                100.0 * image.interval[0],
                100.0 * image.interval[1]
            )
        })
        .chain(judgement.tiles.iter().map(|tiles| {
            format!(
                "\n    {} tiles of {}²: worst {:+.3} % at ({}, {}), p = {:.1e}; {} of {} off",
                tiles.channel,
                tiles.side,
                100.0 * tiles.worst_bias,
                tiles.worst[0],
                tiles.worst[1],
                tiles.p_exact,
                tiles.differing,
                tiles.tiles
            )
        }))
        .collect()
}

/// The estimator and its fault, if it has one.
pub fn label(row: &Row<'_>) -> String {
    match row.task.fault {
        Some(fault) => format!("mutant: {fault}"),
        None => row.task.estimator.label(),
    }
}

/// The last line.
pub fn summary(rows: &[Row<'_>], seconds: f64) -> String {
    let [passed, failed, undecided, broken] = counts(rows);
    format!(
        "{} comparisons in {seconds:.0} s: {passed} passed, {failed} failed, {undecided} undecided, {broken} broken (α = {ALPHA} over the run)",
        rows.len()
    )
}

/// Everything as JSON.
pub fn to_json(rows: &[Row<'_>], seed: u64, quick: bool) -> Value {
    let rows: Vec<Value> = rows
        .iter()
        .map(|row| {
            let compared = row.compared.as_ref();
            json!({
                "claim": row.task.claim.name,
                "title": row.task.claim.title,
                "scene": row.task.claim.scene,
                "estimator": row.task.estimator.label(),
                "mutant": row.task.fault.map(|fault| fault.to_string()),
                "spp": compared.map(|c| c.spp).ok(),
                "replicates": compared.map(|c| c.replicates).ok(),
                "seconds": compared.map(|c| c.seconds).ok(),
                "p_corrected": row.p_corrected,
                "verdict": row.verdict.map(|v| v.to_string()),
                "outcome": row.outcome,
                "judgement": compared.map(|c| &c.judgement).ok(),
                "error": compared.err(),
            })
        })
        .collect();
    json!({ "version": etalon::VERSION, "alpha": ALPHA, "seed": seed, "quick": quick, "rows": rows })
}
