//! The table on standard output.

use crate::claim::{Claim, Oracle, SkippedIntegrator};
use crate::outcome::{FALSE_POSITIVE_LEVEL, Outcome, Row, counts};
use crate::run::{Compared, Evidence, WorstNumber};

/// The headings of the table.
pub fn head() -> String {
    format!(
        "{:<26} {:<30} {:>7} {:>4} {:>6}  {:<24} {:>7} {:>13} {:>9}  {:<10} outcome",
        "claim",
        "estimator",
        "spp",
        "look",
        "s",
        "bias interval (%)",
        "sees",
        "bias < (99 %)",
        "p",
        "verdict"
    )
}

/// One line of the table: the channel whose interval reaches farthest speaks for all.
pub fn line(row: &Row<'_>) -> String {
    let claim = &row.task.claim.name;
    let estimator = row.task.label();
    let compared = match &row.compared {
        Ok(compared) => compared,
        Err(reason) => {
            return format!(
                "{claim:<26} {estimator:<30} {}\n    {}",
                row.outcome,
                reason.replace('\n', "\n    ")
            );
        }
    };
    let (interval, sees) = shown(compared);
    let bound = compared.bias_bound.map_or(String::new(), percent);
    let p = (row.decision.p_corrected).map_or("-".to_owned(), |p| format!("{p:.1e}"));
    let verdict = match row.decision.verdict {
        Some(_) if row.decision.in_doubt => "in doubt".to_owned(),
        verdict => verdict.map_or(String::new(), |v| v.to_string()),
    };
    let text = format!(
        "{claim:<26} {estimator:<30} {:>7} {:>4} {:>6.1}  {interval:<24} {sees:>7} {bound:>13} {p:>9}  {verdict:<10} {}",
        compared.spp, row.decision.looks, row.decision.seconds, row.outcome
    );
    if row.outcome == Outcome::Passed {
        return text;
    }
    text + &worst_tiles(row)
}

/// A bound of the bias, for people: rounded up, as a bound may only be said to be greater than it is.
pub(crate) fn percent(bound: f64) -> String {
    if bound.is_finite() {
        format!("{:.4} %", (1e6 * bound).ceil() / 1e4)
    } else {
        "none".to_owned()
    }
}

/// The interval that reaches farthest, and the smallest bias that could have been found.
fn shown(compared: &Compared) -> (String, String) {
    match compared.worst() {
        Some(WorstNumber::Channel(image)) => {
            let [low, high] = image.interval.map(|end| 100.0 * end);
            (
                format!("{} [{low:+.4}, {high:+.4}]", image.channel),
                format!("{:.4}", 100.0 * image.smallest_detectable),
            )
        }
        Some(WorstNumber::Measure(measure)) => {
            let [low, high] = measure.interval;
            (format!("  [{low:.4}, {high:.4}]"), String::new())
        }
        None => Default::default(),
    }
}

/// Which tiles are off, where anything is.
fn worst_tiles(row: &Row<'_>) -> String {
    let Ok(compared) = &row.compared else {
        return String::new();
    };
    let measures = compared.measures().iter().map(|m| {
        format!(
            "\n    {}: {:.5} in [{:.5}, {:.5}], accepted from {:.5} to {:.5}",
            m.name, m.value, m.interval[0], m.interval[1], m.accepted[0], m.accepted[1]
        )
    });
    let Evidence::Pictures {
        judgement,
        refusals,
        ..
    } = &compared.evidence
    else {
        return measures.collect();
    };
    let refusals = refusals.iter().map(|text| format!("\n    {text}"));
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
        .chain(refusals)
        .collect()
}

/// How many references and agreements bound the bias of the image's mean below a half per cent,
/// and how many there are.
pub fn bounded(rows: &[Row<'_>]) -> [usize; 2] {
    let asked = |row: &&Row<'_>| {
        let oracle = &row.task.claim.oracle;
        let kind = matches!(oracle, Oracle::Reference { .. } | Oracle::Agreement { .. });
        kind && row.task.fault.is_none()
    };
    let below = |row: &&Row<'_>| {
        let bound = row
            .compared
            .as_ref()
            .ok()
            .and_then(|compared| compared.bias_bound);
        bound.is_some_and(|bound| bound < 0.005)
    };
    [
        rows.iter().filter(asked).filter(below).count(),
        rows.iter().filter(asked).count(),
    ]
}

/// Who does not take part in the matrices of a run's claims, with the claim.
pub fn absent<'a>(rows: &[Row<'a>]) -> Vec<(&'a str, &'a SkippedIntegrator)> {
    let mut claims: Vec<&Claim> = rows.iter().map(|row| row.task.claim).collect();
    claims.dedup_by_key(|claim| &claim.name);
    let each = |claim: &'a Claim| {
        claim
            .absent
            .iter()
            .map(|absence| (claim.name.as_str(), absence))
    };
    claims.into_iter().flat_map(each).collect()
}

/// The last lines.
pub fn summary(rows: &[Row<'_>], seconds: f64) -> String {
    let [passed, failed, undecided, broken] = counts(rows);
    let [below, asked] = bounded(rows);
    let mut text = format!(
        "{} comparisons in {seconds:.0} s: {passed} passed, {failed} failed, {undecided} undecided, {broken} broken (α = {FALSE_POSITIVE_LEVEL:.0e} over the run)",
        rows.len()
    );
    if asked > 0 {
        text += &format!(
            "\nthe bias of the image's mean is bounded below 0.5 % (99 % confidence each) in {below} of {asked} comparisons with Mitsuba and among estimators"
        );
    }
    let absent = absent(rows).len();
    if absent > 0 {
        text += &format!(
            "\n{absent} times an integrator objects to the scene of a claim that asks all of them: see the report"
        );
    }
    text
}
