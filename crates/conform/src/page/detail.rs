//! All that is known of one question.

use super::{Asked, Program, anchor, dots, mark, matrix, number, pictures};
use crate::drivers;
use crate::judge::{Finding, Verdict};
use crate::mode::Mode;
use crate::plan::{BOUND, Plan};
use crate::tier::Tier;
use crate::tile::{self, TILES};
use etalon_render::report::signed;
use maud::{Markup, html};

/// The details of a question, folded up.
pub(super) fn detail(asked: &Asked, programs: &[Program<'_>]) -> Markup {
    let truth = asked.question.map(|question| (question.ask)().1);
    html! {
        details class="question" id=(anchor(&asked.name)) data-verdicts=(asked.verdicts(programs)) data-search=(asked.search()) {
            summary {
                b { (asked.name) }
                @for program in programs {
                    @if let Some(finding) = program.finding(&asked.name) {
                        span class="of" { @if programs.len() > 1 { (program.name) ": " } (mark(finding.verdict.word())) }
                    }
                }
            }
            @if let Some(question) = asked.question {
                p class="lead" { (question.title) "." }
                dl class="facts" {
                    dt { "Formula" } dd { code { (question.formula) } }
                    dt { "Source" } dd { (question.source) }
                    @if let Some(truth) = &truth { dt { "Mean of the truth" } dd { (number(truth.mean())) } }
                    dt { "Samples" } dd { (question.samples) " per pixel of one picture" }
                    dt { "Scene" } dd { code { "scenes/" (asked.name) "-pose0.json" } " in the folder of the run" }
                }
            } @else {
                p { "This version of Etalon does not have this question." }
                dl class="facts" { dt { "Scene" } dd { code { "scenes/" (asked.name) "-pose0.json" } } }
            }
            @for program in programs {
                @if let Some(finding) = program.finding(&asked.name) {
                    section class="answer" aria-label=(program.name) {
                        h3 { (program.name) ": " (mark(finding.verdict.word())) }
                        @if let Some(reason) = finding.verdict.reason() { p { (reason.trim()) } }
                        (numbers(finding))
                        @if let (Some(truth), Some(mean)) = (&truth, program.run.means.get(&asked.name)) {
                            (pictures::pictures(truth, mean, finding.replicates.len(), &program.name))
                        }
                        (dots::dots(finding, program.run.report.plan.bound, &program.name))
                        (again(&program.run.report.plan, &asked.name))
                    }
                }
            }
        }
    }
}

fn numbers(finding: &Finding) -> Markup {
    let tile_bound = format!(
        "a tile may be off by {} % of its mean and δ of the picture's",
        100.0 * tile::BOUND
    );
    html! {
        dl class="facts" {
            @if let Some(value) = matrix::value(finding) {
                dt { "Mean, less the truth's" } dd { (value) ", interval of 95 % by itself" }
            }
            @if let Some([low, high]) = finding.run_interval {
                dt { "At the level of the run" } dd { "[" (signed(low)) ", " (signed(high)) "]" }
            } @else if finding.bias.is_some() {
                dt { "At the level of the run" } dd { "no interval can be given" }
            }
            @if let Some((column, row, times)) = finding.tile {
                dt { "Worst tile" } dd { "column " (column) ", row " (row) " of " (TILES) " × " (TILES) ", from 0 at the top left: "
                    (format!("{times:+.2}")) " times its bound (" (tile_bound) ")" }
            }
            @if let Some(finer) = &finding.refinement {
                dt { "With 4 × the samples" } dd { (signed(finer.bias))
                    " in [" (signed(finer.interval[0])) ", " (signed(finer.interval[1])) "]"
                    @if let Some(trend) = finer.trend { ": " (trend.words()) } }
            }
            @if let Some(suspicion) = &finding.suspicion {
                dt { "Looks like" } dd { strong { (suspicion) } }
            } @else if finding.verdict == Verdict::Differs {
                dt { "Looks like" } dd { "no factor and no turn that is known" }
            }
            @if !finding.replicates.is_empty() { dt { "Pictures" } dd { (finding.replicates.len()) } }
        }
    }
}

/// How to ask it again.
fn again(plan: &Plan, question: &str) -> Markup {
    let built_in = drivers::ALL
        .iter()
        .any(|driver| driver.name == plan.program);
    let elsewhere = plan.program == Plan::ELSEWHERE;
    html! {
        p class="command" { "Again: " code { (command(plan, question, built_in)) } " "
            button type="button" class="copy" title="Copy the command" { "Copy" } }
        @if elsewhere { p class="quiet" { "Then render its " code { "jobs.jsonl" } ", and " code { "etalon conform judge" } " that folder." } }
        @else if !built_in { p class="quiet" { "The driver is a file of its own: say where it lies." } }
    }
}

fn command(plan: &Plan, question: &str, built_in: bool) -> String {
    let only = quoted(question);
    let mut command = match (&plan.program[..], built_in) {
        (Plan::ELSEWHERE, _) => format!("etalon conform export --only {only}"),
        (name, true) => format!("etalon conform run --driver {name} --only {only}"),
        (name, false) => format!(
            "etalon conform run --driver {} --only {only}",
            quoted(&format!("{name}.toml"))
        ),
    };
    let seed = plan.suite_seed.to_string();
    for (option, value, usual) in [
        ("--tier", plan.tier.name(), Tier::default().name()),
        ("--mode", plan.mode.name(), Mode::default().name()),
        ("--pose-seed", &seed, "1"),
    ] {
        if value != usual {
            command += &format!(" {option} {}", quoted(value));
        }
    }
    if plan.bound != BOUND {
        command += " --strict";
    }
    // The folder of the whole run holds another plan, and would be refused.
    let option = match &plan.program[..] {
        Plan::ELSEWHERE => "--to",
        _ => "-o",
    };
    command + &format!(" {option} {}", quoted(&format!("again-{question}")))
}

/// A word as a shell reads it: names come from files that others wrote.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./".contains(c);
    match !word.is_empty() && word.chars().all(plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_repeat_what_was_asked() {
        let usual = Plan::new(1, Tier::Standard, Mode::Measure, |_| true);
        let of = |program: &str, plan: &Plan, built_in| {
            let plan = Plan {
                program: program.to_owned(),
                ..plan.clone()
            };
            command(&plan, "wall", built_in)
        };
        assert_eq!(
            of("mitsuba", &usual, true),
            "etalon conform run --driver mitsuba --only wall -o again-wall"
        );
        let other = Plan::new(7, Tier::Quick, Mode::Shipped, |_| true);
        assert_eq!(
            of("my own; rm", &other, false),
            "etalon conform run --driver 'my own; rm.toml' --only wall --tier quick --mode shipped --pose-seed 7 -o again-wall"
        );
        assert_eq!(
            of("elsewhere", &usual, false),
            "etalon conform export --only wall --to again-wall"
        );
    }
}
