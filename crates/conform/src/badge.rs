//! A small picture for a project's front page: of how many questions a program is right.

use crate::report::{Conclusion, Report};
use maud::{Markup, html};

/// Width of a character of Verdana at 11 px in the mean; `textLength` makes the text fit.
const CHARACTER: usize = 7;

/// Space beside a text.
const MARGIN: usize = 6;

/// The badge of a run, as SVG.
pub fn badge(report: &Report) -> String {
    let (left, right) = ("etalon conform", words(report));
    let [a, b] = [left, &right].map(|text| CHARACTER * text.chars().count() + 2 * MARGIN);
    let colour = match report.conclusion() {
        Conclusion::Agrees => "#2c7a3f",
        Conclusion::Undecided => "#8a6d00",
        Conclusion::Differs | Conclusion::Broken => "#b3261e",
    };
    let plan = &report.plan;
    let title = format!(
        "{} {}: {right}, {} tier of the questions {}",
        plan.title,
        plan.program_version,
        plan.tier.name(),
        plan.fingerprint
    );
    let svg = html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(a + b) height="20" role="img" aria-label=(title) {
            title { (title) }
            rect width=(a) height="20" fill="#444" {}
            rect x=(a) width=(b) height="20" fill=(colour) {}
            g fill="#fff" font-family="Verdana,DejaVu Sans,sans-serif" font-size="11" {
                (line(left, MARGIN, a))
                (line(&right, a + MARGIN, b))
            }
        }
    };
    svg.into_string()
}

/// A text that fills a box of this width but for its margins.
fn line(text: &str, x: usize, width: usize) -> Markup {
    html! { text x=(x) y="14" textLength=(width - 2 * MARGIN) { (text) } }
}

/// How many questions it agrees in, of those that it can express, and what else it is.
fn words(report: &Report) -> String {
    let expressed = report.rows.len() - report.count("not supported");
    let agrees = report.count("agrees");
    let bound = 100.0 * report.plan.bound;
    let differs = match report.count("differs") {
        0 => String::new(),
        count => format!(", {count} differ"),
    };
    format!("{agrees} of {expressed} within {bound} %{differs}")
}
