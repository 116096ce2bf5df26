//! All that is known of one comparison.

use super::efficiency;
use super::line;
use crate::claim::{Counting, Ladder, Oracle};
use crate::json::{self, Provenance};
use crate::look::Look;
use crate::outcome::Row;
use crate::run::{Compared, Evidence};
use crate::table;
use etalon_math::float64;
use etalon_render::decide::convergence::Fall;
use etalon_render::decide::measure::Measure;
use etalon_render::report::album::Album;
use etalon_render::report::plot::{self, Curve};
use etalon_render::report::running::{self, Point};
use etalon_render::report::{self, interval, probability, tables, tiles, viewer};
use maud::{Markup, html};
use serde_json::Value;

/// The detail of a row.
pub(super) fn detail(
    index: usize,
    row: &Row<'_>,
    rows: &[Row<'_>],
    provenance: &Provenance,
    album: &mut Album,
) -> Markup {
    let claim = row.task.claim;
    html! {
        p class="lead" { (claim.title) "."
            @if let Some(fault) = row.task.fault {
                " Here with a planted fault, " em { (fault) } ", which this comparison must find."
            }
        }
        @match &row.compared {
            Ok(compared) => { (evidence(compared, row, rows, album)) }
            Err(reason) => { p { span class=(line::name(row.outcome)) { "It could not be compared:" } } pre { (reason) } }
        }
        @if row.history.len() > 1 { (looks(&row.history)) }
        h3 { "Provenance" }
        dl class="facts" {
            dt { "Scene" } dd { code { "scenes/" (claim.scene.display()) }
                @if let Ok(compared) = &row.compared { ", hash " code { (compared.scene_hash) } } }
            dt { "Estimator" } dd { (row.task.estimator.label()) ", seed " (provenance.seed) }
            dt { "Held against" } dd { (held_against(row)) }
            @if let Ok(compared) = &row.compared {
                dt { "Samples" } dd { (compared.spp) " per pixel in " (compared.replicates) " replicates" }
                @if let Some(bound) = compared.bias_bound {
                    dt { "Bias of the mean" } dd { "below " (table::percent(bound)) ", with 99 % confidence for this row by itself" }
                }
                dt { "Level" } dd { (format!("{:.1e}", row.decision.level)) " at the last of " (row.decision.looks)
                    @if row.decision.looks == 1 { " look" } @else { " looks" } }
            }
            dt { "Made by" } dd { "Etalon " (provenance.version) ", floating point " code { (provenance.floating_point) }
                ", " (provenance.machine) }
            dt { "Again" } dd { span class="command" { code { (json::command(row, provenance)) } " "
                button type="button" class="copy" { "Copy" } } }
            dt { "Address" } dd { a href=(format!("#row{index}")) { "this row" } }
        }
    }
}

/// What the estimator must agree with, in words.
fn held_against(row: &Row<'_>) -> Markup {
    let claim = row.task.claim;
    html! {
        @match &claim.oracle {
            Oracle::ClosedForm { formula } | Oracle::Energy { formula } | Oracle::Convergence(Ladder { formula, .. })
                | Oracle::Noise(Counting { formula, .. }) => { "the closed form " code { (formula) } }
            Oracle::Agreement { estimator } | Oracle::Invariance { estimator } => { "our own " (estimator.label()) }
            // References, whoever rendered them.
            _ => {
                "a reference"
                @if let Some(text) = json::reference(claim).and_then(|made| told(&made)) { ": " (text) }
            }
        }
    }
}

/// How a reference was made: its description, field by field.
fn told(made: &Value) -> Option<String> {
    let shown = |(name, value): (&String, &Value)| {
        let text = match (name.as_str(), value) {
            // The parameters are the scene's.
            ("defines", _) => return None,
            ("size", Value::Array(numbers)) => joined(numbers, " × "),
            (_, Value::Array(all)) => joined(all, " "),
            (_, other) => plain(other),
        };
        Some(format!("{} {text}", name.replace('_', " ")))
    };
    Some(
        made.as_object()?
            .iter()
            .filter_map(shown)
            .collect::<Vec<_>>()
            .join(", "),
    )
}

fn joined(values: &[Value], between: &str) -> String {
    values.iter().map(plain).collect::<Vec<_>>().join(between)
}

fn plain(value: &Value) -> String {
    let text = value.as_str().map(str::to_owned);
    text.unwrap_or_else(|| value.to_string())
}

fn evidence(compared: &Compared, row: &Row<'_>, rows: &[Row<'_>], album: &mut Album) -> Markup {
    html! {
        @match &compared.evidence {
            Evidence::Pictures { picture, oracle, judgement, refusals } => {
                (viewer::viewer(album, picture, oracle, &["Etalon".to_owned(), other_name(&row.task.claim.oracle)]))
                @if !refusals.is_empty() {
                    h3 { "Where a normal approximation was refused" }
                    ul class="refusals" { @for refusal in refusals { li { (refusal) } } }
                }
                div class="columns" {
                    @if let Some(curve) = running::of(judgement, picture, oracle) {
                        div {
                            h3 { "Convergence of the mean" }
                            (curve.drawn(&points(&row.history, &curve.channel)))
                        }
                    }
                    (efficiency::bars(row, rows))
                }
                @if judgement.tiles.iter().any(|row| row.side == 16) {
                    h3 { "Tiles" }
                    (tiles::maps(judgement))
                }
                details { summary { "Statistics" } (tables::tables(judgement)) }
            }
            Evidence::Measures(measures) => {
                @if let Some([picture, oracle]) = compared.shown.as_deref() {
                    (viewer::viewer(album, picture, oracle, &["Etalon".to_owned(), other_name(&row.task.claim.oracle)]))
                }
                (measures_table(measures))
                @if let Some(fall) = &compared.fall { (fallen(fall, &row.task.label())) }
            }
        }
    }
}

fn other_name(oracle: &Oracle) -> String {
    match oracle {
        Oracle::ClosedForm { .. } | Oracle::Energy { .. } => "closed form".to_owned(),
        Oracle::Agreement { estimator } | Oracle::Invariance { estimator } => {
            format!("{} (oracle)", estimator.label())
        }
        Oracle::Povray { .. } => "POV-Ray".to_owned(),
        _ => "reference".to_owned(),
    }
}

/// Looks that saw this channel.
fn points(history: &[Look], channel: &str) -> Vec<Point> {
    let same = history.iter().filter(|look| look.of == channel);
    same.map(|look| Point {
        samples: look.spp as f64,
        bias: look.value,
        interval: look.interval,
    })
    .collect()
}

fn measures_table(measures: &[Measure]) -> Markup {
    html! {
        div class="scroll" { table {
            thead { tr { th { "measured" } th { "value" } th { "interval" } th { "accepted" } th { "against it" } th { "p" }
                 th { "verdict" } } }
            tbody { @for m in measures {
                tr {
                    th scope="row" { (m.name) }
                    @if m.accepted[0] < m.accepted[1] {
                        td { (format!("{:.5}", m.value)) }
                        td { (format!("{:.5} … {:.5}", m.interval[0], m.interval[1])) }
                        td { (format!("{:.5} … {:.5}", m.accepted[0], m.accepted[1])) }
                    } @else {
                        td { (m.value) } td { "exact" } td { (m.accepted[0]) }
                    }
                    td { (interval::bar(m.value, m.interval, m.accepted, &m.verdict.to_string())) }
                    td { (probability(m.p)) }
                    td { (report::verdict(m.verdict)) }
                }
            } }
        } }
    }
}

/// Squared error against what grew, with the fitted power law.
fn fallen(fall: &Fall, name: &str) -> Markup {
    let law = |x: f64| [x, fall.factor * float64::pow(x, fall.exponent)];
    let ends = fall.points.first().zip(fall.points.last());
    let curve = Curve {
        name: format!(
            "{name}: squared error of one replicate ∝ n^({:.3})",
            fall.exponent
        ),
        points: fall.points.clone(),
        fit: ends.map(|(a, b)| [law(a[0]), law(b[0])]),
    };
    html! {
        h3 { "Convergence" }
        (plot::curves(&[curve], &fall.over, "squared error"))
        p class="quiet" { "Points: means over batches, with standard errors; dashed: the power law that was fitted." }
    }
}

fn looks(history: &[Look]) -> Markup {
    html! {
        details {
            summary { (history.len()) " looks" }
            div class="scroll" { table {
                thead { tr { th { "look" } th { "samples" } th { "replicates" } th { "level" } th { "of" } th { "value" }
                    th { "interval" } th { "p" } th { "verdict" } th { "seconds so far" } } }
                tbody { @for (index, look) in history.iter().enumerate() {
                    tr {
                        th scope="row" { (index + 1) }
                        td { (look.spp) } td { (look.replicates) } td { (format!("{:.1e}", look.level)) }
                        td { (look.of) } td { (format!("{:+.5}", look.value)) }
                        td { (format!("{:+.5} … {:+.5}", look.interval[0], look.interval[1])) }
                        td { (probability(look.p)) } td { (report::verdict(look.verdict)) }
                        td { (format!("{:.1}", look.seconds)) }
                    }
                } }
            } }
        }
    }
}
