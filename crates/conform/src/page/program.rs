//! What each program came to, what it was asked, and what its driver says of units.

use super::{Program, VERDICTS, class};
use crate::mode::Mode;
use crate::report::Conclusion;
use maud::{Markup, html};
use serde_json::Value;

/// All programs.
pub(super) fn programs(programs: &[Program<'_>]) -> Markup {
    html! {
        div class="programs" {
            @for program in programs { (one(program, programs.len() > 1)) }
        }
    }
}

fn one(program: &Program<'_>, among_others: bool) -> Markup {
    let report = program.run.report;
    let plan = &report.plan;
    let (class_of_whole, text, meaning) = match report.conclusion() {
        Conclusion::Agrees => ("agrees", "✓ Agrees", "in all that it can express"),
        Conclusion::Differs => ("differs", "✗ Differs", "in at least one question"),
        Conclusion::Broken => ("broken", "! Broken", "something could not be judged"),
        Conclusion::Undecided => ("undecided", "? Undecided", "something needs more pictures"),
    };
    html! {
        section class="program" aria-label=(program.name) {
            @if among_others { h2 { (program.name) } }
            ul class="verdict" {
                li class={ "whole " (class_of_whole) } { b { (text) } span { (meaning) } }
                @for (word, sign) in VERDICTS {
                    @let count = report.count(word);
                    @if count > 0 || word == "agrees" {
                        li class=(class(word)) { b { (count) } span { (sign) " " (word) } }
                    }
                }
            }
            dl class="facts" {
                dt { "Program" } dd { (plan.title) }
                dt { "Version" } dd { @if plan.program_version.is_empty() { "not told" } @else { (plan.program_version) } }
                dt { "Asked" } dd { (report.rows.len()) " questions, tier " code { (plan.tier.name()) }
                    ", mode " code { (plan.mode.name()) } " (" (mode(plan.mode)) ")" }
                dt { "Fingerprint" } dd { code { (plan.fingerprint) } " of the questions: their scenes, truths and samples" }
                dt { "Bound" } dd { "δ = " (100.0 * plan.bound) " %" }
                dt { "Seed of poses" } dd { (plan.suite_seed)
                    @if plan.pose_each { ", every picture in a pose of its own" } }
                @if let Some(repeats) = report.seed_repeats {
                    dt { "The same seed again" } dd { @if repeats { "gave the same bits" } @else { strong { "gave another picture" } } }
                }
                dt { "Page made by" } dd { "Etalon " (etalon_render::VERSION) }
            }
            @if !plan.conventions.is_empty() {
                details class="about" {
                    summary { "What the driver says of units and factors" }
                    dl class="facts" {
                        @for (name, value) in &plan.conventions {
                            dt { (spoken(name)) } dd { (told(value)) }
                        }
                    }
                }
            }
        }
    }
}

fn mode(mode: Mode) -> &'static str {
    match mode {
        Mode::Measure => "without all that biases: this decides whether it is right",
        Mode::Shipped => "as a user gets it: this tells, and decides nothing",
    }
}

/// A value of a driver's table, however deep.
fn told(value: &Value) -> Markup {
    html! {
        @match value {
            Value::String(text) => { (text) }
            Value::Array(values) => { ul { @for value in values { li { (told(value)) } } } }
            Value::Object(fields) => { ul { @for (name, value) in fields {
                li { span class="quiet" { (spoken(name)) ": " } (told(value)) }
            } } }
            other => { (other) }
        }
    }
}

fn spoken(name: &str) -> String {
    name.replace('_', " ")
}
