//! Showing diagnostics: file, line, column, the line itself with a caret, and what would help.

use etalon_params::{Diagnostic, Severity, Sources};
use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, SourceCode};
use std::fmt;
use std::io::IsTerminal;

/// A diagnostic together with the text it speaks of, as `miette` wants it.
struct Shown<'a> {
    diagnostic: &'a Diagnostic,
    source: Option<NamedSource<String>>,
}

impl fmt::Debug for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.diagnostic.message)
    }
}

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.diagnostic.message)
    }
}

impl std::error::Error for Shown<'_> {}

impl miette::Diagnostic for Shown<'_> {
    fn severity(&self) -> Option<miette::Severity> {
        Some(match self.diagnostic.severity {
            Severity::Error => miette::Severity::Error,
            Severity::Note => miette::Severity::Advice,
        })
    }

    fn help<'b>(&'b self) -> Option<Box<dyn fmt::Display + 'b>> {
        let help = self.diagnostic.help.as_ref()?;
        Some(Box::new(help))
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

/// The diagnostics as text for a person, most useful first line included: what is wrong, where,
/// the offending line with a caret, and help.
pub fn render(diagnostics: &[Diagnostic], sources: &Sources, coloured: bool) -> String {
    let theme = match coloured {
        true => GraphicalTheme::unicode(),
        false => GraphicalTheme::unicode_nocolor(),
    };
    let handler = GraphicalReportHandler::new_themed(theme)
        .with_width(100)
        .with_links(false);
    let mut text = String::new();
    for diagnostic in diagnostics {
        let source = diagnostic.span.map(|span| {
            NamedSource::new(sources.name(span.file), sources.text(span.file).to_string())
        });
        let shown = Shown { diagnostic, source };
        if handler.render_report(&mut text, &shown).is_err() {
            text.push_str(&diagnostic.one_line(sources));
        }
        // A plain line that editors and scripts can follow.
        if let Some(span) = diagnostic.span {
            let kind = match diagnostic.severity {
                Severity::Error => "error",
                Severity::Note => "note",
            };
            text.push_str(&format!("{kind} at {}\n", sources.location(span)));
        }
        text.push('\n');
    }
    text
}

/// Prints diagnostics to standard error.
pub fn print(diagnostics: &[Diagnostic], sources: &Sources) {
    let coloured = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    eprint!("{}", render(diagnostics, sources, coloured));
}
