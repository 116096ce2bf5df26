//! What only a dict can get wrong: values that XML has no words for.

use super::keys::one_line;
use etalon_params::Diagnostic;
use pyo3::prelude::*;

/// Mistakes with their key paths.
#[derive(Default)]
pub(crate) struct Mistakes(Vec<(String, Diagnostic)>);

impl Mistakes {
    pub(super) fn add(&mut self, key: &str, message: impl Into<String>) {
        self.push(key, Diagnostic::error_nowhere(message));
    }

    pub(super) fn add_with_help(&mut self, key: &str, message: impl Into<String>, help: &str) {
        self.push(key, Diagnostic::error_nowhere(message).help(help));
    }

    pub(super) fn push(&mut self, key: &str, diagnostic: Diagnostic) {
        self.0.push((key.to_owned(), diagnostic));
    }

    /// Nothing, or an exception with all of them.
    pub(super) fn raise(&self) -> PyResult<()> {
        if self.0.is_empty() {
            return Ok(());
        }
        let said = self.0.iter();
        let said = said.map(|(key, diagnostic)| (one_line(key, diagnostic), diagnostic, key));
        Err(crate::errors::of_keys(said))
    }
}
