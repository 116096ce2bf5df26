//! Showing diagnostics: file, line, column, the line itself with a caret, and what would help.
//!
//! Every message begins with a line of its own, `file:line:column: error: …` (or `note`), which
//! editors and scripts can follow; what comes after it is for people.

use crate::say;
use etalon_params::{Diagnostic, Severity, Sources, Span};
use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, SourceCode};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fmt;
use std::io::IsTerminal;
use std::sync::Arc;

/// The most messages that are shown; the others are counted.
const MOST_SHOWN: usize = 50;

/// Columns at which messages are wrapped, independent of the terminal.
const WIDTH: usize = 100;

/// Lines of more bytes than this are not shown whole.
const LONG_LINE: usize = 300;

/// How much of a long line is shown before and after the place in question (characters).
const EXCERPT: usize = 36;

/// A diagnostic together with the text it speaks of, as `miette` wants it.
struct Shown<'a> {
    diagnostic: &'a Diagnostic,
    source: Option<NamedSource<Arc<str>>>,
}

impl fmt::Debug for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.diagnostic.message)
    }
}

impl fmt::Display for Shown<'_> {
    /// Nothing: the message is in the first line.
    fn fmt(&self, _: &mut fmt::Formatter<'_>) -> fmt::Result {
        Ok(())
    }
}

impl std::error::Error for Shown<'_> {}

impl miette::Diagnostic for Shown<'_> {
    fn help<'b>(&'b self) -> Option<Box<dyn fmt::Display + 'b>> {
        let help = self.diagnostic.help.as_ref()?;
        Some(Box::new(printable(help)))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.source.as_ref().map(|s| s as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let span = self.diagnostic.span?;
        let main = label(span.start, span.end, &self.diagnostic.label);
        let related = self
            .diagnostic
            .related
            .iter()
            .filter(move |(other, _)| other.file == span.file)
            .map(|(other, remark)| label(other.start, other.end, remark));
        Some(Box::new(std::iter::once(main).chain(related)))
    }
}

fn label(start: u32, end: u32, text: &str) -> LabeledSpan {
    let length = end.saturating_sub(start).max(1) as usize;
    let text = (!text.is_empty()).then(|| text.to_owned());
    LabeledSpan::new(text, start as usize, length)
}

/// The diagnostics as text: for each a plain first line, the offending line with a caret, and
/// help.
pub fn render(diagnostics: &[Diagnostic], sources: &Sources, coloured: bool) -> String {
    let theme = match coloured {
        true => GraphicalTheme::unicode(),
        false => GraphicalTheme::unicode_nocolor(),
    };
    let handler = GraphicalReportHandler::new_themed(theme)
        .with_width(WIDTH)
        .with_links(false);
    let mut text = String::new();
    let kinds = kinds(diagnostics);
    for (diagnostic, more) in chosen(&kinds) {
        text.push_str(&heading(diagnostic, *more, sources, coloured));
        let short = diagnostic
            .span
            .is_none_or(|span| fits(sources, span) && related_fit(diagnostic, sources));
        if short {
            text.push_str(&snippet(diagnostic, sources, &handler));
        } else if let Some(span) = diagnostic.span {
            text.push_str(&excerpt(diagnostic, sources, span));
        }
        text.push('\n');
    }
    if let Some(more) = kinds.len().checked_sub(MOST_SHOWN + 1) {
        text.push_str(&format!("… and {} more messages\n", more + 1));
    }
    text
}

/// The diagnostics, each note only where it is first made, with the number of further places.
fn kinds(diagnostics: &[Diagnostic]) -> Vec<(&Diagnostic, usize)> {
    let mut kinds: Vec<(&Diagnostic, usize)> = Vec::new();
    let mut first: HashMap<&str, usize> = HashMap::new();
    for diagnostic in diagnostics {
        if diagnostic.severity == Severity::Note {
            match first.entry(&diagnostic.message) {
                Entry::Occupied(first) => {
                    kinds[*first.get()].1 += 1;
                    continue;
                }
                Entry::Vacant(place) => {
                    place.insert(kinds.len());
                }
            }
        }
        kinds.push((diagnostic, 0));
    }
    kinds
}

/// Those that are shown, in their order: errors before notes if there are too many.
fn chosen<'a, 'd>(
    kinds: &'a [(&'d Diagnostic, usize)],
) -> impl Iterator<Item = &'a (&'d Diagnostic, usize)> {
    let is_error = |(diagnostic, _): &&(&Diagnostic, usize)| diagnostic.severity == Severity::Error;
    let errors = kinds.iter().filter(is_error).count();
    let mut notes_left = MOST_SHOWN.saturating_sub(errors);
    let shown = kinds.iter().filter(move |kind| {
        let take = is_error(kind) || notes_left > 0;
        if !is_error(kind) {
            notes_left = notes_left.saturating_sub(1);
        }
        take
    });
    shown.take(MOST_SHOWN)
}

/// `file:line:column: error: message`, in one line; `more` places say the same.
fn heading(diagnostic: &Diagnostic, more: usize, sources: &Sources, coloured: bool) -> String {
    let (kind, colour) = match diagnostic.severity {
        Severity::Error => ("error", "31"),
        Severity::Note => ("note", "36"),
    };
    let place = diagnostic.span.map_or_else(String::new, |span| {
        format!("{}: ", printable(&sources.location(span)))
    });
    let mut message = printable(&diagnostic.message);
    match more {
        0 => {}
        1 => message.push_str(" (and at one more place)"),
        _ => message.push_str(&format!(" (and at {more} more places)")),
    }
    match coloured {
        true => format!("\x1b[1m{place}\x1b[{colour}m{kind}:\x1b[39m {message}\x1b[0m\n"),
        false => format!("{place}{kind}: {message}\n"),
    }
}

/// The lines around the place, with a caret, and help.
fn snippet(diagnostic: &Diagnostic, sources: &Sources, handler: &GraphicalReportHandler) -> String {
    let source = diagnostic.span.map(|span| {
        let text = harmless(sources.text(span.file));
        NamedSource::new(printable(sources.name(span.file)), text)
    });
    let mut text = String::new();
    let shown = Shown { diagnostic, source };
    if handler.render_report(&mut text, &shown).is_err() {
        return String::new();
    }
    // The line for the message is empty.
    let rest = text.split_once('\n').map_or("", |(_, rest)| rest);
    let lines = rest.lines().map(|line| format!("{}\n", line.trim_end()));
    lines.collect()
}

/// The part of a long line that matters, with a caret, and help.
fn excerpt(diagnostic: &Diagnostic, sources: &Sources, span: Span) -> String {
    let text = sources.text(span.file);
    let (from, to) = line_of(text, span);
    let start = (span.start as usize).clamp(from, to);
    let end = (span.end as usize).clamp(start, to);
    let (Some(before), Some(inside), Some(after)) = (
        text.get(from..start),
        text.get(start..end),
        text.get(end..to),
    ) else {
        return String::new();
    };
    let skipped = before.chars().count().saturating_sub(EXCERPT);
    let before: String = before.chars().skip(skipped).collect();
    let inside: String = inside.chars().take(EXCERPT).collect();
    let after: String = after.chars().take(EXCERPT).collect();
    let line = printable(&format!("{before}{inside}{after}").replace('\t', " "));
    let caret = "─".repeat(inside.chars().count().max(1));
    let indent = " ".repeat(before.chars().count());
    let mut shown = format!(
        "   │ …{line}…\n   ·  {indent}{caret} {}\n",
        diagnostic.label
    );
    if let Some(help) = &diagnostic.help {
        shown.push_str(&format!("  help: {}\n", printable(help)));
    }
    shown
}

/// Where the line of a span's first byte begins and ends.
fn line_of(text: &str, span: Span) -> (usize, usize) {
    let bytes = text.as_bytes();
    let start = (span.start as usize).min(bytes.len());
    let from = bytes[..start].iter().rposition(|&b| b == b'\n');
    let to = bytes[start..].iter().position(|&b| b == b'\n');
    (
        from.map_or(0, |at| at + 1),
        to.map_or(bytes.len(), |at| start + at),
    )
}

/// Whether a span's line, and those before and after it, can be shown whole.
fn fits(sources: &Sources, span: Span) -> bool {
    let text = sources.text(span.file).as_bytes();
    let start = (span.start as usize).min(text.len());
    let end = (span.end as usize).clamp(start, text.len());
    let near = |bytes: &[u8]| bytes.len() <= LONG_LINE || bytes.contains(&b'\n');
    // Two lines on either side, which is what is shown around a place.
    let mut before = text[..start].rsplit(|&b| b == b'\n').take(2);
    let mut after = text[end..].split(|&b| b == b'\n').take(2);
    near(&text[start..end])
        && before.all(|line| line.len() <= LONG_LINE)
        && after.all(|line| line.len() <= LONG_LINE)
}

fn related_fit(diagnostic: &Diagnostic, sources: &Sources) -> bool {
    let mut related = diagnostic.related.iter();
    related.all(|(span, _)| fits(sources, *span))
}

/// Text without control characters, which could command a terminal.
fn printable(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() { '\u{fffd}' } else { c })
        .collect()
}

/// A source without control characters, every byte where it was.
fn harmless(text: &Arc<str>) -> Arc<str> {
    let harmful = |c: char| c.is_control() && !matches!(c, '\n' | '\r' | '\t');
    if !text.chars().any(harmful) {
        return text.clone();
    }
    let replace = |c: char| match (harmful(c), c.len_utf8()) {
        (true, 1) => '?',
        (true, _) => '¿',
        (false, _) => c,
    };
    text.chars().map(replace).collect::<String>().into()
}

/// Prints diagnostics to standard error, in colour if that is a terminal that can, and `NO_COLOR`
/// (no-color.org) is not set.
pub fn print(diagnostics: &[Diagnostic], sources: &Sources) {
    let refused = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty())
        || std::env::var_os("TERM").is_some_and(|value| value == "dumb");
    let coloured = std::io::stderr().is_terminal() && !refused;
    say::remark(&render(diagnostics, sources, coloured));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str, start: usize, end: usize) -> String {
        let mut sources = Sources::default();
        let file = sources.add("a.xml", text);
        let (start, end) = (start as u32, end as u32);
        let span = Span { file, start, end };
        let diagnostic = Diagnostic::error(span, "`x` is not a number")
            .label("expected a number")
            .help("write digits");
        render(&[diagnostic], &sources, false)
    }

    #[test]
    fn a_plain_line_comes_first_and_the_caret_stands_below_the_value() {
        let text = shown("<scene>\n  <float value=\"x\"/>\n</scene>\n", 24, 25);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "a.xml:2:17: error: `x` is not a number");
        let column = |line: &str, c| line.chars().position(|found| found == c);
        let source = lines.iter().find(|l| l.contains("<float")).expect("shown");
        let caret = lines.iter().find(|l| l.contains('┬')).expect("shown");
        assert_eq!(column(source, 'x'), column(caret, '┬'), "{text}");
        assert!(text.contains("╰── expected a number"), "{text}");
        assert!(text.contains("  help: write digits\n"), "{text}");
    }

    #[test]
    fn long_lines_are_cut() {
        let text = format!("<scene>{}<x/>{}", "a".repeat(100_000), "b".repeat(100_000));
        let text = shown(&text, 100_007, 100_011);
        assert!(text.len() < 600, "{text}");
        assert!(text.contains("aaa<x/>bbb"), "{text}");
        assert!(text.contains("──── expected a number"), "{text}");
    }

    #[test]
    fn nothing_in_a_file_can_command_the_terminal() {
        let text = shown("<a\u{1b}[2Jx\u{9b}>", 6, 7);
        assert!(!text.contains(['\u{1b}', '\u{9b}']), "{text:?}");
    }

    #[test]
    fn many_messages_are_counted() {
        let sources = Sources::default();
        let many = vec![Diagnostic::error_nowhere("no"); MOST_SHOWN + 3];
        let text = render(&many, &sources, false);
        assert!(text.ends_with("… and 3 more messages\n"), "{text}");
        assert_eq!(text.matches("error: no\n").count(), MOST_SHOWN);
        assert!(!render(&many[3..], &sources, false).contains("more"));
    }

    #[test]
    fn each_note_is_made_once_and_none_hides_an_error() {
        let mut sources = Sources::default();
        let file = sources.add("a.xml", "0123456789".repeat(20));
        let at = |start| Span {
            file,
            start,
            end: start + 1,
        };
        let note = |start, message: &str| Diagnostic::note(at(start), message);
        let mut all = vec![note(2, "held"), note(3, "other"), note(4, "held")];
        all.push(note(5, "held"));
        let text = render(&all, &sources, false);
        assert!(
            text.contains("a.xml:1:3: note: held (and at 2 more places)\n"),
            "{text}"
        );
        assert_eq!(text.matches("note: ").count(), 2, "{text}");
        // Sixty notes of their own kinds before an error, which is shown all the same.
        let mut many: Vec<Diagnostic> = (0..60).map(|i| note(i, &format!("note {i}"))).collect();
        many.push(Diagnostic::error(at(100), "wrong"));
        let text = render(&many, &sources, false);
        assert!(text.contains(":101: error: wrong\n"), "{text}");
        assert!(text.ends_with("… and 11 more messages\n"), "{text}");
        // Errors are counted one by one: each wants mending.
        let twice = vec![
            Diagnostic::error(at(1), "same"),
            Diagnostic::error(at(2), "same"),
        ];
        assert_eq!(
            render(&twice, &sources, false)
                .matches("error: same\n")
                .count(),
            2
        );
    }

    #[test]
    fn spans_beyond_the_text_are_survived() {
        for (start, end) in [(0, 0), (9, 9), (400, 500), (2, 1)] {
            shown("<scene/>\n", start, end);
            shown(&"é".repeat(300), start, end);
        }
        shown("", 0, 0);
    }
}
