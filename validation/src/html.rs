//! The report: one HTML file with everything in it.

use crate::outcome::{ALPHA, Outcome, Row};
use crate::table;
use etalon::report;
use maud::{Markup, html};

/// The whole page.
pub fn page(rows: &[Row<'_>], seed: u64, seconds: f64) -> String {
    let body = html! {
        p { (table::summary(rows, seconds)) ". Seed " (seed) "." }
        p { "A comparison with Mitsuba asks for equivalence: the interval of the bias must lie within "
            "the bound. A closed form, or another estimator of ours, asks for equality as well. A mutant "
            "is a fault planted on purpose: it passes if it is found. Intervals and p-values are "
            "corrected over the whole run, α = " (ALPHA) "." }
        table {
            tr { th { "claim" } th { "estimator" } th { "spp" } th { "seconds" } th { "bias interval" }
                 th { "could see" } th { "p" } th { "verdict" } th { "outcome" } }
            @for (index, row) in rows.iter().enumerate() { (line(index, row)) }
        }
        @for (index, row) in rows.iter().enumerate() { (details(index, row)) }
    };
    report::page("Validation", &body)
}

fn line(index: usize, row: &Row<'_>) -> Markup {
    let anchor = format!("#row{index}");
    let widest = row
        .compared
        .as_ref()
        .ok()
        .and_then(|c| c.judgement.widest());
    html! {
        tr {
            td { a href=(anchor) { (row.task.claim.name) } }
            td { (table::label(row)) }
            @if let Ok(compared) = &row.compared {
                td { (compared.spp) }
                td { (format!("{:.1}", compared.seconds)) }
            } @else { td {} td {} }
            @if let Some(channel) = widest {
                td { (channel.channel) ": " (format!("{:+.4} % … {:+.4} %", 100.0 * channel.interval[0], 100.0 * channel.interval[1])) }
                td { (format!("{:.4} %", 100.0 * channel.smallest_detectable)) }
            } @else { td {} td {} }
            td { @if let Some(p) = row.p_corrected { (format!("{p:.1e}")) } }
            td { @if let Some(verdict) = row.verdict { (report::verdict(verdict)) } }
            td { (outcome(row.outcome)) }
        }
    }
}

fn outcome(outcome: Outcome) -> Markup {
    let class = match outcome {
        Outcome::Passed => "agrees",
        Outcome::Undecided => "undecided",
        Outcome::Failed | Outcome::Broken => "differs",
    };
    html! { span class=(class) { (outcome.to_string()) } }
}

fn details(index: usize, row: &Row<'_>) -> Markup {
    let claim = row.task.claim;
    html! {
        h2 id=(format!("row{index}")) { (claim.name) ": " (table::label(row)) }
        p { (claim.title) " (" code { "scenes/" (claim.scene.display()) } "). " (outcome(row.outcome)) }
        p { "Again: " code { "cargo xtask validate --only " (claim.name) } }
        @match &row.compared {
            Ok(compared) => {
                (report::pictures(&compared.picture, &compared.oracle,
                    &["Etalon".to_owned(), "what it ought to be".to_owned()]))
                details { summary { "Statistics" } (report::tables(&compared.judgement)) }
            }
            Err(reason) => { pre { (reason) } }
        }
    }
}
