//! The page: curves of cost against the number of primitives, and a table for every scene.

use super::Report;
use super::measure::Row;
use etalon_benches::rays::Kind;
use etalon_render::report::{self, plot};
use maud::{Markup, html};
use std::collections::BTreeSet;

/// The whole page.
pub(super) fn page(report: &Report) -> String {
    let scenes: Vec<&str> = report.rows.iter().map(|row| row.scene).collect();
    let mut seen = BTreeSet::new();
    let scenes = scenes.into_iter().filter(|scene| seen.insert(*scene));
    let body = html! {
        p { "Accelerators over the same rays, by turns, the best of several times. Rates are millions of rays per second; "
            "a node of " code { "wide" } " has eight children, one of the others is a single box." }
        @if !report.sizes.is_empty() { (sizes(report)) }
        @for scene in scenes {
            @let rows: Vec<&Row> = report.rows.iter().filter(|row| row.scene == scene).collect();
            h2 { (scene) ": " (rows.first().map_or(0, |row| row.primitives)) " primitives" }
            (figures(&rows, report.threads))
        }
    };
    report::page("Accelerators", &body)
}

/// Cost against the number of primitives.
fn sizes(report: &Report) -> Markup {
    let mut seen = BTreeSet::new();
    let names = report.sizes.iter().map(|row| row.accelerator);
    let names: Vec<&str> = names.filter(|name| seen.insert(*name)).collect();
    let curves = |value: &dyn Fn(&Row) -> f64| -> Vec<plot::Curve> {
        let curve = |name: &&str| plot::Curve {
            name: (*name).to_owned(),
            points: (report.sizes.iter().filter(|row| row.accelerator == *name))
                .map(|row| [row.primitives as f64, value(row), 0.0])
                .collect(),
            fit: None,
        };
        names.iter().map(curve).collect()
    };
    let primitives = "triangles of the sphere";
    let bounce = Kind::Bounce as usize;
    html! {
        h2 { "Cost against the number of primitives" }
        (plot::curves(&curves(&|row| 1e3 / row.rays[bounce].one), primitives, "ns per bounce ray, one thread"))
        (plot::curves(&curves(&|row| 1e9 * row.build / row.primitives as f64), primitives, "ns to build, per primitive"))
        (plot::curves(&curves(&Row::bytes_each), primitives, "bytes per primitive"))
    }
}

fn figures(rows: &[&Row], threads: usize) -> Markup {
    html! {
        div class="scroll" { table {
            thead { tr {
                th { "accelerator" } th { "build (ms)" } th { "bytes per primitive" }
                @for kind in Kind::ALL {
                    th { (kind.name()) " (M/s)" } th { "on " (threads) } th { "nodes" } th { "primitives" }
                }
            } }
            tbody { @for row in rows { tr {
                td { (row.accelerator) }
                td { (format!("{:.1}", 1e3 * row.build)) }
                td { (format!("{:.0}", row.bytes_each())) }
                @for rays in &row.rays {
                    td { (format!("{:.3}", rays.one)) } td { (format!("{:.3}", rays.all)) }
                    @let [nodes, primitives] = rays.looked_at.map_or([String::new(), String::new()], |n| n.map(|n| format!("{n:.1}")));
                    td { (nodes) } td { (primitives) }
                }
            } } }
        } }
    }
}
