//! The report: one HTML file with everything in it.
//!
//! At the top what the run came to; then the table of decisions, one [`line`] for each claim and
//! estimator, which unfolds to all that is known of it: its `detail`. The frame, the pictures and
//! the plots are those of `etalon_render::report`.

mod detail;
mod efficiency;
mod line;

use crate::json::Provenance;
use crate::outcome::{ALPHA, Conclusion, FALSE_POSITIVE_LEVEL, Outcome, Row, counts};
use crate::table;
use etalon_render::report::{self, album::Album};
use maud::{Markup, html};
use std::collections::BTreeMap;

/// The whole page.
pub fn page(rows: &[Row<'_>], provenance: &Provenance) -> String {
    let mut album = Album::new();
    let body = html! {
        (whole(rows, provenance))
        (about(provenance))
        h2 { "Claim by claim" }
        (filters(rows))
        (decisions(rows, provenance, &mut album))
        (absent(rows))
        (album.markup())
    };
    report::page("Validation", &body)
}

/// What the run came to.
fn whole(rows: &[Row<'_>], provenance: &Provenance) -> Markup {
    let [passed, failed, undecided, broken] = counts(rows);
    let [below, asked] = table::bounded(rows);
    let (class, text, meaning) = match Conclusion::of(rows) {
        Conclusion::Passed => ("passed", "✓ Passed", "every claim holds"),
        Conclusion::Failed => ("failed", "✗ Failed", "a claim does not hold"),
        Conclusion::Broken => ("broken", "! Broken", "something could not be compared"),
        Conclusion::Undecided => ("undecided", "? Undecided", "something needs more samples"),
    };
    let mutants = rows.iter().filter(|row| row.task.fault.is_some());
    let found = mutants.clone().filter(|row| row.outcome == Outcome::Passed);
    html! {
        ul class="verdict" {
            li class={ "whole " (class) } { b { (text) } span { (meaning) } }
            @if let Some(part) = &provenance.part {
                li { b { (part) } span { "is the part that this is: the run passes if all do" } }
            }
            li { b { (passed) } span { "passed" } }
            li class=[(failed > 0).then_some("failed")] { b { (failed) } span { "failed" } }
            li class=[(undecided > 0).then_some("undecided")] { b { (undecided) } span { "undecided" } }
            li class=[(broken > 0).then_some("broken")] { b { (broken) } span { "broken" } }
            @if asked > 0 {
                li { b { (below) " of " (asked) } span title="of the references and agreements" { "bias bounded below 0.5 %, each with 99 % confidence" } }
            }
            @if mutants.clone().count() > 0 {
                li { b { (found.count()) " of " (mutants.count()) } span { "planted faults found" } }
            }
            li { b { (duration(provenance.seconds)) } span { (rows.len()) " comparisons" } }
        }
    }
}

fn duration(seconds: f64) -> String {
    if seconds < 100.0 {
        format!("{seconds:.0} s")
    } else if seconds < 6000.0 {
        format!("{:.0} min", seconds / 60.0)
    } else {
        format!("{:.1} h", seconds / 3600.0)
    }
}

/// How to read the page, and where its numbers come from.
fn about(provenance: &Provenance) -> Markup {
    html! {
        details class="about" {
            summary { "How to read this, and where it comes from" }
            p { "A comparison with a reference asks for equivalence: the interval of the bias must lie within "
                "the bound. A closed form, or another estimator of ours, asks for equality as well. A mutant "
                "is a fault planted on purpose: it passes if it is found, and is undecided if that takes "
                "more samples. An interval that is too wide is "
                em { "undecided" } ", never a pass. Intervals and p-values are corrected over the whole run: "
                "the probability that a sound renderer shows any failure is " (FALSE_POSITIVE_LEVEL) ", and that any interval "
                "misses its truth " (ALPHA) ". What differs at the latter level only is " em { "in doubt" } ", and undecided. Only the bounds "
                "that a full run asks for besides, and that the head of this page counts, are said of each "
                "comparison by itself, with 99 % confidence." }
            p { "In the column " em { "bias" } ", the shaded band is what is accepted, whatever its width, so that "
                "all rows share one scale. " em { "Could see" } " is the smallest bias that the comparison "
                "would have found with a probability of 95 %. " em { "Bias < … (99 %)" } " is the bound of the bias, over "
                "all channels, that holds for this comparison by itself; the intervals are wider, as they hold "
                "for all comparisons together." }
            (facts(provenance))
        }
    }
}

fn facts(provenance: &Provenance) -> Markup {
    let part = provenance.part.as_ref();
    let part = part.map_or_else(String::new, |part| format!(", part {part}"));
    html! {
        dl class="facts" {
            dt { "Etalon" } dd { (provenance.version)
                @if let Some(program) = &provenance.program { ", program " code { (program) } }
                ", floating point " code { (provenance.floating_point) } }
            dt { "Machine" } dd { (provenance.machine) ", " (provenance.threads) " threads" }
            dt { "Run" } dd { (provenance.tier) (part) ", seed " (provenance.seed) ", "
                (format!("{:.0} s", provenance.seconds)) }
            dt { "Plan" } dd { code { (provenance.plan) } ", " (provenance.hypotheses) " comparisons"
                @if !part.is_empty() { ", all parts together: parts of one run have the same plan, and those of one build the same program" } }
            dt { "The same as data" } dd { code { "report.json" } " beside this file" }
        }
    }
}

/// Who objects to which scene, where a claim asks all unbiased integrators.
fn absent(rows: &[Row<'_>]) -> Markup {
    let absent = table::absent(rows);
    html! {
        @if !absent.is_empty() {
            details {
                summary { "Integrators that object to a scene (" (absent.len()) ")" }
                p { "Some claims ask all unbiased integrators. These say that they cannot render the scene, or not all of it." }
                div class="scroll" { table {
                    thead { tr { th class="text" { "claim" } th class="text" { "integrator" } th class="text" { "why" } } }
                    tbody { @for (claim, absence) in absent {
                        tr { th scope="row" { (claim) } td class="text" { (absence.integrator) }
                            td class="text" { (absence.reason) } }
                    } }
                } }
            }
        }
    }
}

fn filters(rows: &[Row<'_>]) -> Markup {
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    for row in rows {
        *kinds.entry(row.task.claim.oracle.kind()).or_default() += 1;
    }
    let names = ["passed", "failed", "undecided", "broken"];
    html! {
        form class="filters" role="search" aria-label="Rows to show" {
            label class="search" { "Find " input type="search" name="text" placeholder="claim, estimator, scene …"; }
            fieldset {
                legend { "Outcome" }
                @for (name, count) in names.iter().zip(counts(rows)) {
                    label { input type="checkbox" name="outcome" value=(name) checked; " " (name) " (" (count) ")" }
                }
            }
            label { "Kind "
                select name="kind" {
                    option value="" { "all" }
                    @for (kind, count) in &kinds {
                        option value=(kind) { (kind.replace('_', " ")) " (" (count) ")" }
                    }
                }
            }
            label { input type="checkbox" name="mutants" checked; " mutants" }
            button type="reset" { "Reset" }
            button type="button" data-open="yes" { "Unfold all" }
            button type="button" data-open="no" { "Fold all" }
            span class="count" role="status" { (rows.len()) " of " (rows.len()) " rows shown" }
        }
    }
}

/// The columns: key, name, and whether they are sorted as numbers.
const COLUMNS: [(&str, &str, bool); 11] = [
    ("outcome", "outcome", true),
    ("claim", "claim", false),
    ("estimator", "estimator", false),
    ("kind", "kind", false),
    ("bias", "bias", true),
    ("sees", "could see", true),
    ("p", "p", true),
    ("spp", "samples", true),
    ("looks", "looks", true),
    ("seconds", "seconds", true),
    ("verdict", "verdict", false),
];

fn decisions(rows: &[Row<'_>], provenance: &Provenance, album: &mut Album) -> Markup {
    html! {
        table class="decisions" role="table" aria-label="Decisions, claim by claim" {
            thead role="rowgroup" {
                tr role="row" {
                    @for (key, name, numeric) in COLUMNS {
                        @let text = matches!(key, "outcome" | "claim" | "estimator" | "kind" | "bias" | "verdict");
                        th role="columnheader" scope="col" data-key=(key) data-numeric=[numeric.then_some("")]
                            class=[text.then_some("text")] { button type="button" { (name) } }
                    }
                }
            }
            @for (index, row) in rows.iter().enumerate() {
                @let search = format!("{} {} {} {}", row.task.claim.name, row.task.label(),
                    row.task.claim.title, row.task.claim.scene.display());
                tbody role="rowgroup" id=(format!("row{index}")) data-kind=(row.task.claim.oracle.kind())
                    data-outcome=(line::name(row.outcome))
                    data-mutant=(if row.task.fault.is_some() { "yes" } else { "no" })
                    data-search=(search.to_lowercase()) {
                    (line::line(index, row))
                    tr role="row" class="detail" id=(format!("detail{index}")) {
                        td role="cell" colspan=(COLUMNS.len()) { (detail::detail(index, row, rows, provenance, album)) }
                    }
                }
            }
        }
    }
}
