//! The statistics of a comparison as tables.

use super::{interval, percent, probability, signed, verdict};
use crate::judge::ImageComparison;
use maud::{Markup, html};

/// The means of the image, and the tiles.
pub fn tables(judgement: &ImageComparison) -> Markup {
    let bound = judgement.rules.image_bound;
    html! {
        div class="scroll" { table {
            caption { "Means of the image" }
            thead { tr { th { "channel" } th { "mean" } th { "other" } th { "bias" } th { "interval" }
                 th { "against ±" (percent(bound)) } th { "could see" } th { "p of equality" } th { "verdict" } } }
            tbody { @for row in &judgement.images {
                tr {
                    th scope="row" { (row.channel) }
                    td { (format!("{:.5}", row.mean)) }
                    td { (format!("{:.5}", row.other_mean)) }
                    td { (signed(row.bias)) }
                    td { (signed(row.interval[0])) " … " (signed(row.interval[1])) }
                    td { (interval::bar(row.bias, row.interval, [-bound, bound], &row.verdict.to_string())) }
                    td { (percent(row.smallest_detectable)) }
                    td { (probability(row.p_exact)) }
                    td { (verdict(row.verdict)) }
                }
            } }
        } }
        div class="scroll" { table {
            caption { "Tiles" }
            thead { tr { th { "tiles" } th { "count" } th { "worst" } th { "at" } th { "p of equality, corrected" }
                 th { "p within tolerance" } th { "off" } th { "verdict" } } }
            tbody { @for row in &judgement.tiles {
                tr {
                    th scope="row" { (row.channel) ", " (row.side) "²" }
                    td { (row.tiles) }
                    td { (signed(row.worst_bias)) }
                    td { (row.worst[0]) ", " (row.worst[1]) }
                    td { (probability(row.p_exact)) }
                    td { (probability(row.p_differs)) }
                    td { (row.differing) }
                    td { (verdict(row.verdict)) }
                }
            } }
        } }
    }
}
