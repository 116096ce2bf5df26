//! What went wrong, where, and what would have been right.

use crate::{Sources, Span};
use std::collections::HashSet;
use std::sync::{Mutex, MutexGuard};

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The scene cannot be used.
    Error,
    /// Worth saying; the scene can be used.
    Note,
}

/// One message about the input.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong, with the offending value: one sentence.
    pub message: String,
    /// Where it stands, if it stands anywhere.
    pub span: Option<Span>,
    /// What to write beside the caret (may be empty).
    pub label: String,
    /// What would be accepted, or a likely correction.
    pub help: Option<String>,
    /// Further places that matter, each with its remark.
    pub related: Vec<(Span, String)>,
}

impl Diagnostic {
    /// An error at a place in the input.
    pub fn error(span: Span, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            message: message.into(),
            span: Some(span),
            label: String::new(),
            help: None,
            related: Vec::new(),
        }
    }

    /// An error that belongs to no place in the input.
    pub fn error_nowhere(message: impl Into<String>) -> Self {
        Self {
            span: None,
            ..Self::error(
                Span {
                    file: crate::FileId(0),
                    start: 0,
                    end: 0,
                },
                message,
            )
        }
    }

    /// A remark at a place in the input.
    pub fn note(span: Span, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Note,
            ..Self::error(span, message)
        }
    }

    /// Adds the text beside the caret.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// Adds what would be accepted.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Adds "did you mean …?" if one of the candidates is near to `word`, else lists them if
    /// they are few.
    pub fn suggest<'a>(self, word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Self {
        let candidates: Vec<&str> = candidates.into_iter().collect();
        match crate::suggest::nearest(word, candidates.iter().copied()) {
            Some(near) => self.help(format!("did you mean `{near}`?")),
            None if candidates.is_empty() => self,
            None if candidates.len() <= 24 => {
                self.help(format!("accepted: {}", candidates.join(", ")))
            }
            None => self,
        }
    }

    /// Adds another place that matters.
    pub fn related(mut self, span: Span, remark: impl Into<String>) -> Self {
        self.related.push((span, remark.into()));
        self
    }

    /// The message in one line, `file:line:column: error: …`.
    pub fn one_line(&self, sources: &Sources) -> String {
        let kind = match self.severity {
            Severity::Error => "error",
            Severity::Note => "note",
        };
        let place = self
            .span
            .map(|span| format!("{}: ", sources.location(span)))
            .unwrap_or_default();
        let help = self
            .help
            .as_ref()
            .map(|help| format!(" ({help})"))
            .unwrap_or_default();
        format!("{place}{kind}: {}{help}", self.message)
    }
}

/// A place to put diagnostics, shared by everybody who reads a scene; several mistakes are
/// reported in one run.
#[derive(Debug, Default)]
pub struct Diagnostics {
    said: Mutex<Said>,
    /// Places about which nothing more is said.
    silent: Vec<Span>,
}

/// What has been said so far.
#[derive(Debug, Default)]
struct Said {
    list: Vec<Diagnostic>,
    /// Places and messages of `list`, to recognise what is said again: there may be very many.
    known: HashSet<(Option<Span>, String)>,
}

impl Diagnostics {
    /// An empty collection.
    pub fn new() -> Self {
        Self::default()
    }

    /// A collection that says nothing about some places: there stand harmless values in place of
    /// broken ones, about which everything has been said.
    pub fn silent_about(places: &[Span]) -> Self {
        Self {
            said: Mutex::default(),
            silent: places.to_vec(),
        }
    }

    /// Adds one message (once: the same message at the same place is not repeated).
    pub fn push(&self, diagnostic: Diagnostic) {
        if diagnostic
            .span
            .is_some_and(|span| self.silent.contains(&span))
        {
            return;
        }
        let mut said = self.lock();
        let key = (diagnostic.span, diagnostic.message.clone());
        if said.known.insert(key) {
            said.list.push(diagnostic);
        }
    }

    /// Adds the error of a failed result and gives its value otherwise.
    pub fn keep<T>(&self, result: Result<T, Diagnostic>) -> Option<T> {
        result.map_err(|diagnostic| self.push(diagnostic)).ok()
    }

    /// Whether any error was reported.
    pub fn has_errors(&self) -> bool {
        let said = self.lock();
        said.list.iter().any(|d| d.severity == Severity::Error)
    }

    /// All messages, in order of their place in the input; last those that have none.
    pub fn into_sorted(self) -> Vec<Diagnostic> {
        let said = self.said.into_inner().unwrap_or_else(|e| e.into_inner());
        let mut list = said.list;
        list.sort_by_key(|d| (d.span.is_none(), d.span.map(|s| (s.file, s.start))));
        list
    }

    fn lock(&self) -> MutexGuard<'_, Said> {
        self.said.lock().unwrap_or_else(|e| e.into_inner())
    }
}
