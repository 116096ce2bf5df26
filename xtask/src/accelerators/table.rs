//! The table of measurements, in Markdown: a line for each accelerator of a scene, and one of ratios to Embree.

use super::measure::{EMBREE, Rays, Row};
use etalon_benches::rays::Kind;

/// The head of the table.
pub(super) fn head(threads: usize) -> String {
    let kinds = Kind::ALL.map(Kind::name).join(" | ");
    format!(
        "Build on {threads} threads; M rays/s on one thread (on {threads}), and nodes + primitives that a ray looks at.\n\n\
         | scene | accelerator | build (ms) | bytes per primitive | {kinds} |\n|---|---|---|---|---|---|---|---|"
    )
}

/// The lines of a scene.
pub(super) fn lines(rows: &[Row]) -> Vec<String> {
    let embree = rows.iter().find(|row| row.accelerator == EMBREE);
    let mut lines: Vec<String> = rows.iter().map(line).collect();
    let mut ours = rows.iter().filter(|row| row.accelerator != EMBREE);
    if let (Some(embree), Some(ours)) = (embree, ours.next_back()) {
        lines.push(ratios(ours, embree));
    }
    lines
}

fn line(row: &Row) -> String {
    let rays = row.rays.map(|rays| {
        let Rays {
            one,
            all,
            looked_at,
            ..
        } = rays;
        let looked_at =
            looked_at.map(|[nodes, primitives]| format!(", {nodes:.1} + {primitives:.1}"));
        format!(
            "{} ({}){}",
            rate(one),
            rate(all),
            looked_at.unwrap_or_default()
        )
    });
    format!(
        "| {} | {} | {:.1} | {:.0} | {} |",
        row.scene,
        row.accelerator,
        1e3 * row.build,
        row.bytes_each(),
        rays.join(" | ")
    )
}

/// Three digits, however small.
fn rate(x: f64) -> String {
    match x {
        x if x >= 0.1 => format!("{x:.2}"),
        x => format!("{x:.1e}"),
    }
}

/// The last of ours relative to Embree.
fn ratios(ours: &Row, embree: &Row) -> String {
    let rays = [0, 1, 2, 3].map(|kind| {
        let (ours, theirs) = (ours.rays[kind], embree.rays[kind]);
        format!(
            "**{:.2}** ({:.2})",
            ours.one / theirs.one,
            ours.all / theirs.all
        )
    });
    format!(
        "| {} | **{} / Embree** | **{:.2}** | **{:.2}** | {} |",
        ours.scene,
        ours.accelerator,
        ours.build / embree.build,
        ours.bytes_each() / embree.bytes_each(),
        rays.join(" | ")
    )
}
