//! The calibration as an HTML page.

use super::null::NullRuns;
use super::single::Single;
use super::verdict::{Promise, decades, histogram};
use crate::run::Task;
use etalon_render::report;
use etalon_statistics::Verdict;
use maud::{Markup, html};

/// The whole page.
pub fn page(
    tasks: &[Task<'_>],
    null: &NullRuns,
    singles: &[Single],
    promises: &[Promise],
) -> String {
    let body = html! {
        p { "Nothing is wrong in any of these runs: every failure is a false alarm." }
        table {
            tr { th { "promise" } th { "seen" } th { "kept" } }
            @for promise in promises {
                tr { td { (promise.what) } td { (promise.seen) } td { (kept(promise.holds)) } }
            }
        }
        h2 { "p-values of single questions in null runs" }
        p { "Replicates of one estimator, dealt into two hands, or drawn about their own mean." }
        @for (question, p_values) in &null.p_values { (tail(&question.to_string(), p_values)) }
        h2 { "p-values of single questions between fresh renders" }
        @for single in singles { (tail(&single.name, &single.p_values)) }
        h2 { "Comparisons in " (null.alarms.trials) " null runs" }
        p { (null.undecided) " runs left something undecided." }
        table {
            tr { th { "claim" } th { "estimator" } th { "false alarms" } th { "undecided" } th { "broken" } }
            @for (task, counts) in tasks.iter().zip(&null.comparisons) {
                tr {
                    td { (task.claim.name) } td { (task.label()) }
                    td { (counts.failed) } td { (counts.undecided) } td { (counts.broken) }
                }
            }
        }
    };
    report::page("Calibration", &body)
}

fn kept(holds: bool) -> Markup {
    report::verdict(if holds {
        Verdict::Agrees
    } else {
        Verdict::Differs
    })
}

/// Rates by decades, and a histogram.
fn tail(name: &str, p_values: &[f64]) -> Markup {
    let bins = histogram(p_values);
    let most = bins.iter().copied().max().unwrap_or(1).max(1) as f64;
    let expected = p_values.len() as f64 / bins.len().max(1) as f64;
    let level = 100.0 - 90.0 * expected / most;
    html! {
        h3 { (name) ": " (p_values.len()) " p-values" }
        svg viewBox="0 0 400 110" width="400" role="img" aria-label="histogram of p-values from 0 to 1" {
            @for (bin, count) in bins.iter().enumerate() {
                @let height = 90.0 * *count as f64 / most;
                rect x=(20 * bin + 1) y=(100.0 - height) width="18" height=(height) fill="currentColor" opacity="0.5" {
                    title { (count) }
                }
            }
            line x1="0" x2="400" y1=(level) y2=(level) stroke="currentColor" stroke-dasharray="4" {}
        }
        table {
            tr { th { "p at most" } th { "observed" } th { "expected" } th { "interval of the rate" } }
            @for rate in decades(p_values) {
                tr {
                    td { (rate.promised) } td { (rate.count) }
                    td { (format!("{:.1}", rate.promised * rate.trials as f64)) }
                    td { (format!("{:.2e} … {:.2e}", rate.interval.low, rate.interval.high)) }
                }
            }
        }
    }
}
