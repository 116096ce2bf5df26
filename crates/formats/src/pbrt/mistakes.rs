//! The mistakes found so far, of which there is a most.

use etalon_params::{Diagnostic, Severity, Span};
use std::collections::HashSet;

/// After so many errors nothing more is read: the rest is seldom news.
const MOST_ERRORS: usize = 50;

/// A bounded list of messages.
#[derive(Debug, Default)]
pub(crate) struct Mistakes {
    list: Vec<Diagnostic>,
    errors: usize,
    /// Set if the rest cannot be read, however few the errors.
    given_up: bool,
    known: HashSet<(Option<Span>, String)>,
}

impl Mistakes {
    /// Records a message; the same one at the same place (of a file that is included twice) only once.
    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        let is_error = diagnostic.severity == Severity::Error;
        let notes = self.list.len() - self.errors;
        if self.is_full() || (!is_error && notes >= MOST_ERRORS) {
            return;
        }
        if !self
            .known
            .insert((diagnostic.span, diagnostic.message.clone()))
        {
            return;
        }
        self.list.push(diagnostic);
        self.errors += usize::from(is_error);
        if self.errors == MOST_ERRORS {
            let message = format!(
                "more than {MOST_ERRORS} mistakes; the rest of the scene was not looked at"
            );
            self.list.push(Diagnostic::error_nowhere(message));
        }
    }

    /// Records a mistake after which reading cannot go on.
    pub(crate) fn give_up(&mut self, diagnostic: Diagnostic) {
        self.report(diagnostic);
        self.given_up = true;
    }

    /// Whether reading should end.
    pub(crate) fn is_full(&self) -> bool {
        self.given_up || self.errors >= MOST_ERRORS
    }

    /// All messages, in order of their place in the input; last those that have none.
    pub(crate) fn into_sorted(mut self) -> Vec<Diagnostic> {
        self.list
            .sort_by_key(|d| (d.span.is_none(), d.span.map(|s| (s.file, s.start))));
        self.list
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_params::FileId;

    #[test]
    fn the_list_is_bounded_and_sorted() {
        let mut mistakes = Mistakes::default();
        let at = |start| Span {
            file: FileId(0),
            start,
            end: start,
        };
        for start in (0..1000).rev() {
            mistakes.report(Diagnostic::error(at(start), "wrong"));
            mistakes.report(Diagnostic::error(at(start), "wrong"));
        }
        assert!(mistakes.is_full());
        let list = mistakes.into_sorted();
        assert_eq!(list.len(), 51);
        assert_eq!(list[0].span, Some(at(950)));
        assert!(list[50].message.starts_with("more than 50 mistakes"));
    }
}
