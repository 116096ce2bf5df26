//! Key paths in messages: where a dict says what XML says in a line.

use etalon_params::{Diagnostic, Sources};

/// What a scene from a dict is called in messages without a key path.
pub(crate) const NAME: &str = "<dict>";

/// The key path of each line of the text of a dict, such as `cube.bsdf.reflectance`; empty for the dict itself.
#[derive(Clone, Debug, Default)]
pub(crate) struct Keys(pub(super) Vec<String>);

impl Keys {
    /// The key path of what a message is about, if that stands in a dict.
    pub(crate) fn of(&self, diagnostic: &Diagnostic, sources: &Sources) -> Option<&str> {
        let span = diagnostic.span?;
        if sources.name(span.file) != NAME {
            return None;
        }
        let (line, _) = sources.position(span);
        self.0.get(line - 1).map(String::as_str)
    }

    /// The message in one line: `cube.bsdf.reflectance: error: …`, or with the place in a file.
    pub(crate) fn one_line(&self, diagnostic: &Diagnostic, sources: &Sources) -> String {
        match self.of(diagnostic, sources) {
            Some(key) => one_line(key, diagnostic),
            None => diagnostic.one_line(sources),
        }
    }
}

/// The message about a key path.
pub(super) fn one_line(key: &str, diagnostic: &Diagnostic) -> String {
    let nowhere = Diagnostic {
        span: None,
        ..diagnostic.clone()
    };
    let key = if key.is_empty() { NAME } else { key };
    format!("{key}: {}", nowhere.one_line(&Sources::default()))
}
