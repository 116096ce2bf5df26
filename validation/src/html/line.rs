//! One line of the table of decisions.

use crate::outcome::{Outcome, Row};
use crate::run::{Compared, WorstNumber};
use crate::table;
use etalon_render::report::{self, interval, probability};
use maud::{Markup, html};

/// An outcome's name, as in the JSON.
pub(super) fn name(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Passed => "passed",
        Outcome::Failed => "failed",
        Outcome::Undecided => "undecided",
        Outcome::Broken => "broken",
    }
}

/// Its place when rows are sorted, what needs attention first, and a sign for it.
fn rank(outcome: Outcome) -> (u8, &'static str) {
    match outcome {
        Outcome::Failed => (0, "✗"),
        Outcome::Broken => (1, "!"),
        Outcome::Undecided => (2, "?"),
        Outcome::Passed => (3, "✓"),
    }
}

/// The line.
pub(super) fn line(index: usize, row: &Row<'_>) -> Markup {
    let claim = row.task.claim;
    let compared = row.compared.as_ref().ok();
    let spp = compared.map(|compared| compared.spp);
    let (rank, sign) = rank(row.outcome);
    let worst = compared.and_then(Compared::worst);
    let kind = claim.oracle.kind();
    html! {
        tr role="row" class="line" {
            td role="cell" class="text" data-key="outcome" data-value=(rank) {
                button type="button" class={ "toggle " (name(row.outcome)) } aria-expanded="true"
                    aria-controls=(format!("detail{index}"))
                    aria-label=(format!("{}: {}, {}", name(row.outcome), claim.name, row.task.label())) {
                    (sign) " " (name(row.outcome))
                }
            }
            th role="rowheader" scope="row" class="text claim" data-key="claim" data-value=(claim.name) { (claim.name) }
            td role="cell" class="text estimator wide" data-key="estimator" data-value=(row.task.label()) {
                @if let Some(fault) = row.task.fault {
                    span class="tag" { "mutant" } " " (fault)
                } @else { (row.task.estimator.label()) }
            }
            td role="cell" class="text kind" data-key="kind" data-value=(kind) { (kind.replace('_', " ")) }
            (bias(compared))
            @let sees = match worst { Some(WorstNumber::Channel(image)) => Some(image.smallest_detectable), _ => None };
            td role="cell" data-key="sees" data-label="could see" data-value=[sees] {
                @if let Some(sees) = sees { (format!("{:.3} %", 100.0 * sees)) }
            }
            td role="cell" data-key="p" data-label="p" data-value=[row.decision.p_corrected] {
                @if let Some(p) = row.decision.p_corrected { (probability(p)) }
            }
            td role="cell" data-key="spp" data-label="samples" data-value=[spp] {
                @if let Some(spp) = spp { (spp) }
            }
            td role="cell" data-key="looks" data-label="looks" data-value=(row.decision.looks) { (row.decision.looks) }
            td role="cell" data-key="seconds" data-label="seconds" data-value=(row.decision.seconds) { (format!("{:.1}", row.decision.seconds)) }
            @let verdict = row.decision.verdict.map(|verdict| verdict.to_string());
            td role="cell" class="text" data-key="verdict" data-label="verdict" data-value=[verdict] {
                @if let Some(verdict) = row.decision.verdict { (report::verdict(verdict)) }
                @if row.decision.in_doubt { span class="numbers" { "in doubt" } }
            }
        }
    }
}

/// The number that speaks for a row, and the bound of the bias that is stated of it by itself.
fn bias(compared: Option<&Compared>) -> Markup {
    let class = "text wide";
    match compared.and_then(|compared| Some((compared, compared.worst()?))) {
        Some((compared, WorstNumber::Channel(image))) => {
            let judgement = compared.judgement();
            let bound = judgement.map_or(f64::NAN, |judgement| judgement.rules.image_bound);
            let tiles = judgement.into_iter().flat_map(|judgement| &judgement.tiles);
            let off: usize = tiles.map(|tiles| tiles.differing).sum();
            let [low, high] = image.interval;
            let reach = low.abs().max(high.abs()) / bound;
            let label = format!("bias of {}", image.channel);
            html! {
                td role="cell" class=(class) data-key="bias" data-label=(label) data-value=(sortable(reach)) {
                    (interval::bar(image.bias, image.interval, [-bound, bound], &image.verdict.to_string()))
                    span class="numbers" { (image.channel) " " (format!("{:+.3} … {:+.3} %", 100.0 * low, 100.0 * high)) }
                    @if let Some(stated) = compared.bias_bound {
                        span class="numbers" { "bias < " (table::percent(stated)) " (99 %)" }
                    }
                    @if off > 0 {
                        span class="numbers" { (off) @if off == 1 { " tile" } @else { " tiles" } " off" }
                    }
                }
            }
        }
        Some((_, WorstNumber::Measure(measure))) => {
            let [low, high] = measure.interval;
            let [least, most] = measure.accepted;
            let (middle, half) = (0.5 * (least + most), 0.5 * (most - least));
            let reach = match half > 0.0 {
                true => (low - middle).abs().max((high - middle).abs()) / half,
                false => low.abs().max(high.abs()),
            };
            html! {
                td role="cell" class=(class) data-key="bias" data-label=(measure.name) data-value=(sortable(reach)) {
                    (interval::bar(measure.value, measure.interval, measure.accepted, &measure.verdict.to_string()))
                    span class="numbers" {
                        @if half > 0.0 { (format!("{low:.4} … {high:.4}")) } @else { (measure.value) " " (measure.name) }
                    }
                }
            }
        }
        None => html! { td role="cell" class=(class) data-key="bias" {} },
    }
}

/// A number that a script can sort by.
fn sortable(x: f64) -> String {
    if x.is_finite() {
        format!("{x:.6}")
    } else {
        "1e99".to_owned()
    }
}
