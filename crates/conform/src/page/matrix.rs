//! Questions × programs: the verdicts with their values.

use super::{Asked, Program, VERDICTS, anchor, class, mark, rank};
use crate::judge::Finding;
use etalon_render::report::{interval, signed};
use maud::{Markup, html};

/// What chooses the rows to show.
pub(super) fn filters(programs: &[Program<'_>], asked: &[Asked]) -> Markup {
    html! {
        form class="filters" role="search" aria-label="Questions to show" {
            label class="search" { "Find " input type="search" name="text" placeholder="sphere, glass, sun …"; }
            fieldset {
                legend { "Verdict" }
                @for (word, sign) in VERDICTS {
                    @let count: usize = programs.iter().map(|program| program.run.report.count(word)).sum();
                    @if count > 0 {
                        label { input type="checkbox" name="verdict" value=(class(word)) checked="checked";
                            " " (sign) " " (word) " (" (count) ")" }
                    }
                }
            }
            button type="reset" { "Reset" }
            button type="button" data-unfold="yes" { "Unfold all" }
            button type="button" data-unfold="no" { "Fold all" }
            span class="count" role="status" { (asked.len()) " of " (asked.len()) " questions shown" }
        }
    }
}

/// The table.
pub(super) fn matrix(programs: &[Program<'_>], asked: &[Asked]) -> Markup {
    let caption =
        "Verdict, and how far the mean is off, with its interval of 95 %. The shaded band is ± δ.";
    html! {
        div class="scroll" role="region" tabindex="0" aria-label="Questions and programs" {
            table class="matrix" {
                caption { (caption) }
                thead { tr {
                    (head("question"))
                    @for program in programs { (head(&program.name)) }
                } }
                tbody {
                    @for (index, asked) in asked.iter().enumerate() {
                        tr data-verdicts=(asked.verdicts(programs)) data-search=(asked.search()) {
                            th scope="row" data-value=(index) {
                                a href={ "#" (anchor(&asked.name)) } { (asked.name) }
                                @if let Some(question) = asked.question { span class="under" { (question.title) } }
                            }
                            @for program in programs { (cell(program.finding(&asked.name), program.run.report.plan.bound)) }
                        }
                    }
                }
            }
        }
    }
}

fn head(name: &str) -> Markup {
    html! { th scope="col" { button type="button" title={ "Sort by " (name) } { (name) } } }
}

fn cell(finding: Option<&Finding>, bound: f64) -> Markup {
    let Some(finding) = finding else {
        return html! { td data-value="9e9" { span class="quiet" { "not asked" } } };
    };
    let word = finding.verdict.word();
    html! {
        td data-value=(order(finding)) {
            (mark(word))
            @if let (Some(bias), Some(ends)) = (finding.bias, finding.interval) {
                " " (interval::bar(bias, ends, [-bound, bound], &class(word)))
            }
            @if let Some(value) = value(finding) { span class="under" { (value) } }
            @if let Some(reason) = finding.verdict.reason() { span class="under" { (reason.trim()) } }
            @if let Some(suspicion) = &finding.suspicion { span class="under" { "looks like " (suspicion) } }
        }
    }
}

/// The mean's relative difference with its interval.
pub(super) fn value(finding: &Finding) -> Option<String> {
    let bias = signed(finding.bias?);
    let ends = |[low, high]: [f64; 2]| format!("{bias} [{}, {}]", signed(low), signed(high));
    Some(finding.interval.map_or_else(|| bias.clone(), ends))
}

/// A number that a script sorts by: what needs attention first, of these what is farthest off.
fn order(finding: &Finding) -> String {
    let off = finding.bias.map_or(0.0, f64::abs).min(9.0);
    format!("{:.6}", 10.0 * rank(&finding.verdict) as f64 - off)
}
