//! One HTML file that shows what was found of one or several programs; it fetches nothing.
//!
//! At the top what each program came to, then questions × programs, then all that is known of each question. The frame and the
//! look are those of [`etalon_render::report`]. Without a script all is there, but cannot be filtered or sorted.

mod detail;
mod dots;
mod matrix;
mod pictures;
mod program;
mod reading;

use crate::judge::{Finding, Verdict};
use crate::question::Question;
use crate::report::{Conclusion, Report};
use crate::truth::Picture;
use etalon_render::report::styled_page;
use maud::{Markup, PreEscaped, html};
use std::collections::BTreeMap;

const STYLE: &str = include_str!("page/page.css");
const SCRIPT: &str = include_str!("page/page.js");

/// What a page shows of one program.
#[derive(Clone, Debug)]
pub struct Run<'a> {
    /// What was found.
    pub report: &'a Report,
    /// The mean of a question's pictures, by its name; questions that have none here are shown without pictures.
    pub means: BTreeMap<String, Picture>,
}

impl<'a> Run<'a> {
    /// A report alone, as from its JSON.
    pub fn without_pictures(report: &'a Report) -> Self {
        Self {
            report,
            means: BTreeMap::new(),
        }
    }
}

/// The page of these programs, in this order.
pub fn page(runs: &[Run<'_>]) -> String {
    let programs = programs(runs);
    let asked = asked(runs);
    let differs = runs
        .iter()
        .any(|run| run.report.conclusion() == Conclusion::Differs);
    let title = match &programs[..] {
        [program] => format!("Questions to {}", program.name),
        programs => format!("Questions to {} programs", programs.len()),
    };
    let is_one = programs.len() == 1;
    let body = html! {
        // Several programs are compared first, and told apart below.
        @if is_one { (program::programs(&programs)) }
        (reading::legend(&programs))
        h2 { "Question by question" }
        (matrix::filters(&programs, &asked))
        (matrix::matrix(&programs, &asked))
        @if !is_one { h2 { "The programs" } (program::programs(&programs)) }
        (reading::checklist(differs))
        h2 { "All that is known" }
        @for asked in &asked { (detail::detail(asked, &programs)) }
        script { (PreEscaped(SCRIPT)) }
    };
    styled_page(&title, STYLE, &body)
}

/// A program under a name that no other has.
struct Program<'a> {
    name: String,
    run: &'a Run<'a>,
}

impl Program<'_> {
    /// What was found of a question, if it was asked.
    fn finding(&self, question: &str) -> Option<&Finding> {
        let mut rows = self.run.report.rows.iter();
        let row = rows.find(|row| row.question == question)?;
        Some(&row.finding)
    }
}

fn programs<'a>(runs: &'a [Run<'a>]) -> Vec<Program<'a>> {
    let full = |run: &Run<'_>| {
        let plan = &run.report.plan;
        format!("{} {}", plan.title, plan.program_version)
    };
    let count = |same: &dyn Fn(&Run<'_>) -> bool| runs.iter().filter(|run| same(run)).count();
    let name = |(index, run): (usize, &Run<'_>)| {
        if count(&|other| other.report.plan.title == run.report.plan.title) == 1 {
            run.report.plan.title.clone()
        } else if count(&|other| full(other) == full(run)) == 1 {
            full(run)
        } else {
            format!("{} ({})", full(run), index + 1)
        }
    };
    let named = runs.iter().enumerate().map(|(index, run)| Program {
        name: name((index, run)),
        run,
    });
    named.collect()
}

/// A question that any program was asked.
struct Asked {
    name: String,
    /// What it is, if this version of the suite has it.
    question: Option<&'static Question>,
}

impl Asked {
    /// What a script finds its row and its details by.
    fn search(&self) -> String {
        let title = self.question.map_or("", |question| question.title);
        format!("{} {title}", self.name).to_lowercase()
    }

    /// The verdicts of all programs, as words for a script.
    fn verdicts(&self, programs: &[Program<'_>]) -> String {
        let findings = programs.iter().filter_map(|p| p.finding(&self.name));
        let words = findings.map(|finding| class(finding.verdict.word()));
        words.collect::<Vec<_>>().join(" ")
    }
}

/// The questions in the order of the suite; those that it does not have come last.
fn asked(runs: &[Run<'_>]) -> Vec<Asked> {
    let mut names: Vec<&str> = Vec::new();
    for row in runs.iter().flat_map(|run| &run.report.rows) {
        if !names.contains(&row.question.as_str()) {
            names.push(&row.question);
        }
    }
    let place = |name: &&str| {
        let mut all = crate::questions::ALL.iter();
        all.position(|question| question.name == *name)
            .unwrap_or(usize::MAX)
    };
    names.sort_by_key(place);
    let asked = names.into_iter().map(|name| Asked {
        name: name.to_owned(),
        question: crate::questions::by_name(name),
    });
    asked.collect()
}

/// The words of verdicts, what needs attention first, each with a sign for those who do not see its colour.
const VERDICTS: [(&str, &str); 5] = [
    ("differs", "✗"),
    ("broken", "!"),
    ("undecided", "?"),
    ("agrees", "✓"),
    ("not supported", "–"),
];

/// The place of a verdict among [`VERDICTS`].
fn rank(verdict: &Verdict) -> usize {
    let mut words = VERDICTS.iter();
    words
        .position(|(word, _)| *word == verdict.word())
        .unwrap_or(VERDICTS.len())
}

/// A verdict's word without spaces, for style and script.
fn class(word: &str) -> String {
    word.replace(' ', "-")
}

/// A verdict in its colour, with its sign.
fn mark(word: &str) -> Markup {
    let sign = VERDICTS.iter().find(|(other, _)| *other == word);
    html! {
        span class={ "mark " (class(word)) } {
            @if let Some((_, sign)) = sign { span aria-hidden="true" { (sign) } " " }
            (word)
        }
    }
}

/// A number in few characters.
fn number(x: f64) -> String {
    match x == 0.0 || (1e-3..1e6).contains(&x.abs()) {
        true => format!("{x:.6}"),
        false => format!("{x:.4e}"),
    }
}

/// The place of a question's details in the page.
fn anchor(question: &str) -> String {
    format!("question-{}", question.replace(char::is_whitespace, "-"))
}
