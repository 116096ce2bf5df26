//! The estimators of one claim side by side: which reaches a given error first?
//!
//! Efficiency is 1 / (v · s), with v the mean over pixels and colour channels of the relative variance
//! of the picture, s² / (m² + 0.01), and s the seconds that rendering it took. Neither depends on how
//! much was rendered: v falls as s grows. Bias does not enter: that is what the claim is about.

use crate::outcome::Row;
use crate::run::Evidence;
use etalon_render::estimators::findings::Uncertain;
use etalon_render::report::plot;
use maud::{Markup, html};

/// Bars for all sound estimators of the row's claim; nothing if fewer than two are known.
pub(super) fn bars(row: &Row<'_>, rows: &[Row<'_>]) -> Markup {
    let same = |other: &&Row<'_>| {
        other.task.claim.name == row.task.claim.name && other.task.fault.is_none()
    };
    let bars: Vec<(String, Uncertain)> = rows
        .iter()
        .filter(same)
        .filter_map(|row| {
            let bar = Uncertain {
                value: Some(efficiency(row)?),
                ..Uncertain::default()
            };
            Some((row.task.label(), bar))
        })
        .collect();
    html! {
        @if bars.len() > 1 {
            div {
                h3 { "Efficiency of this claim's estimators" }
                (plot::bars(&bars, "efficiency"))
                p class="quiet" { "1 / (mean relative variance of a pixel × seconds of rendering): longer is better." }
            }
        }
    }
}

fn efficiency(row: &Row<'_>) -> Option<f64> {
    let Evidence::Pictures { picture, .. } = &row.compared.as_ref().ok()?.evidence else {
        return None;
    };
    let seconds = picture.metadata.as_ref()?.seconds?;
    let error = picture.mean_relative_standard_error()?;
    (error > 0.0 && seconds > 0.0).then(|| 1.0 / (error * error * seconds))
}
