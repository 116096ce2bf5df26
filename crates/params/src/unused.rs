//! Messages about unused parameters.

use crate::{Class, Diagnostic, Span, Value, ignored, unbuilt};

/// A parameter that its plugin does not read.
#[derive(Clone, Copy, Debug)]
pub struct Unused<'a> {
    /// The class of the plugin.
    pub class: Class,
    /// Its name.
    pub plugin: &'a str,
    /// The parameter's name, empty for a nested object without one.
    pub name: &'a str,
    /// Where the name stands.
    pub span: Span,
}

impl Unused<'_> {
    /// An error, or a note or nothing if the parameter changes nothing; `known` are the names of those that the plugin has.
    pub fn judge<'k>(
        self,
        value: &Value,
        known: impl IntoIterator<Item = &'k str>,
    ) -> Option<Diagnostic> {
        let Self {
            class,
            plugin,
            name,
            span,
        } = self;
        if let Some(entry) = ignored::entry(class, plugin, name) {
            return match entry.only.filter(|only| !(only.holds)(value)) {
                Some(only) => {
                    let message = format!("`{name}` must be {}", only.words);
                    Some(Diagnostic::error(span, message).label(entry.reason))
                }
                None if entry.said => {
                    let message = format!("`{name}` has no effect: {}", entry.reason);
                    Some(Diagnostic::note(span, message))
                }
                None => None,
            };
        }
        if let Some(entry) = unbuilt::entry(class, plugin, name) {
            let message = format!("`{name}` of `{plugin}`, which Mitsuba 0.6 obeys, is not built");
            let instead = format!("instead: {}", entry.instead);
            return Some(Diagnostic::error(span, message).help(instead));
        }
        let message = match (name, value) {
            ("", Value::Object(node)) => {
                let class = node.class.name();
                format!("`{plugin}` does not take an object of the class `{class}`")
            }
            ("", _) => format!("`{plugin}` does not take {}", value.kind()),
            _ => format!("`{plugin}` has no parameter `{name}`"),
        };
        let unknown = Diagnostic::error(span, message).label("not a parameter of this plugin");
        Some(unknown.suggest(name, known))
    }
}
