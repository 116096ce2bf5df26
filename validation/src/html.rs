//! The report: one HTML file with everything in it.

use crate::json::{self, Provenance};
use crate::measure::Measure;
use crate::outcome::{ALPHA, Outcome, Row};
use crate::run::Evidence;
use crate::table;
use etalon::report;
use maud::{Markup, html};

/// The whole page.
pub fn page(rows: &[Row<'_>], provenance: &Provenance) -> String {
    let body = html! {
        p { (table::summary(rows, provenance.seconds)) ". Etalon " (provenance.version)
            " (" (provenance.floating_point) "), " (provenance.tier) " run, seed " (provenance.seed)
            ", " (provenance.threads) " threads." }
        p { "A comparison with Mitsuba asks for equivalence: the interval of the bias must lie within "
            "the bound. A closed form, or another estimator of ours, asks for equality as well. A mutant "
            "is a fault planted on purpose: it passes if it is found. Intervals and p-values are "
            "corrected over the whole run, α = " (ALPHA) "." }
        table {
            tr { th { "claim" } th { "estimator" } th { "spp" } th { "looks" } th { "seconds" } th { "bias interval" }
                 th { "could see" } th { "p" } th { "verdict" } th { "outcome" } }
            @for (index, row) in rows.iter().enumerate() { (line(index, row)) }
        }
        @for (index, row) in rows.iter().enumerate() { (details(index, row, provenance)) }
    };
    report::page("Validation", &body)
}

fn line(index: usize, row: &Row<'_>) -> Markup {
    let anchor = format!("#row{index}");
    let widest = row
        .compared
        .as_ref()
        .ok()
        .and_then(|c| c.judgement()?.widest());
    html! {
        tr {
            td { a href=(anchor) { (row.task.claim.name) } }
            td { (row.task.label()) }
            @if let Ok(compared) = &row.compared {
                td { (compared.spp) }
                td { (row.looks) }
                td { (format!("{:.1}", row.seconds)) }
            } @else { td {} td {} td {} }
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

fn details(index: usize, row: &Row<'_>, provenance: &Provenance) -> Markup {
    let claim = row.task.claim;
    html! {
        h2 id=(format!("row{index}")) { (claim.name) ": " (row.task.label()) }
        p { (claim.title) " (" code { "scenes/" (claim.scene.display()) } "). " (outcome(row.outcome)) }
        p { "Again: " code { (json::command(row, provenance)) } }
        @match &row.compared {
            Ok(compared) => {
                p { "Scene hash " code { (compared.scene_hash) } ", " (compared.replicates)
                    " replicates, " (row.looks) " looks, the last at level "
                    (format!("{:.1e}", row.level)) "." }
                @match &compared.evidence {
                    Evidence::Pictures { picture, oracle, judgement, refusals } => {
                        (report::pictures(picture, oracle,
                            &["Etalon".to_owned(), "what it ought to be".to_owned()]))
                        @for refusal in refusals { p { (refusal) } }
                        details { summary { "Statistics" } (report::tables(judgement)) }
                    }
                    Evidence::Measures(measures) => { (measures_table(measures)) }
                }
            }
            Err(reason) => { pre { (reason) } }
        }
    }
}

fn measures_table(measures: &[Measure]) -> Markup {
    html! {
        table {
            tr { th { "measured" } th { "value" } th { "interval" } th { "accepted" } th { "p" }
                 th { "verdict" } }
            @for m in measures {
                tr {
                    td { (m.name) }
                    td { (format!("{:.5}", m.value)) }
                    td { (format!("{:.5} … {:.5}", m.interval[0], m.interval[1])) }
                    td { (format!("{:.5} … {:.5}", m.accepted[0], m.accepted[1])) }
                    td { (format!("{:.1e}", m.p)) }
                    td { (report::verdict(m.verdict)) }
                }
            }
        }
    }
}
