//! The attributes of an element, after `$name` has been replaced, each with its place.

use super::number::{self, NotANumber};
use super::reader::Reader;
use etalon_math::Expression;
use etalon_params::{DVec3, Diagnostic, FileId, Span};
use std::borrow::Cow;
use std::ops::Range;

/// One attribute.
pub(crate) struct Attribute<'a> {
    pub(crate) name: &'a str,
    /// The value.
    pub(crate) text: Cow<'a, str>,
    /// Where the value stands.
    pub(crate) span: Span,
    /// Where the name stands.
    pub(crate) name_span: Span,
    /// Whether `text` is the text at `span`, letter by letter.
    verbatim: bool,
    /// The `<default>`s that the value was made from.
    defaults: Vec<Span>,
}

impl Attribute<'_> {
    /// The place of a part of the value (of the whole value if it was not written as it is).
    pub(crate) fn part(&self, range: Range<usize>) -> Span {
        if self.verbatim {
            Span {
                start: self.span.start + range.start as u32,
                end: self.span.start + range.end as u32,
                ..self.span
            }
        } else {
            self.span
        }
    }

    /// An error at a part of the value, which also shows the `<default>` it came from.
    pub(crate) fn error(&self, range: Range<usize>, message: impl Into<String>) -> Diagnostic {
        self.defaults.iter().fold(
            Diagnostic::error(self.part(range), message),
            |diagnostic, &span| diagnostic.related(span, "the value comes from here"),
        )
    }

    /// An error at the whole value.
    pub(crate) fn error_whole(&self, message: impl Into<String>) -> Diagnostic {
        self.error(0..self.text.len(), message)
    }

    /// The finite number in a part of it: written out, or by an expression of constants.
    fn float(&self, range: Range<usize>, wanted: &str) -> Result<f64, Diagnostic> {
        let text = &self.text[range.clone()];
        match number::float(text) {
            Err(NotANumber::Malformed) if number::is_computed(text) => {
                number::computed(text).map_err(|error| {
                    // From there to the end of the part.
                    let place = text.char_indices().nth(error.character - 1);
                    let start = range.start + place.map_or(text.len(), |(byte, _)| byte);
                    let message =
                        format!("{} in `{}`", error.message, number::excerpt(text.trim()));
                    let diagnostic = self.error(start.min(range.end)..range.end, message);
                    match &error.unknown {
                        Some(word) => diagnostic.suggest(word, Expression::names()),
                        None => diagnostic.label(format!("expected {wanted}")),
                    }
                })
            }
            other => other.map_err(|error| self.not_a_number(range, wanted, error)),
        }
    }

    fn not_a_number(&self, range: Range<usize>, wanted: &str, error: NotANumber) -> Diagnostic {
        let text = &self.text[range.clone()];
        self.error(range, error.message(text.trim(), wanted))
            .label(format!("expected {wanted}"))
    }
}

/// The attributes of one element.
pub(crate) struct Attributes<'a> {
    list: Vec<Attribute<'a>>,
    /// Where the opening tag's name stands.
    pub(crate) tag_span: Span,
}

/// The place of an element's opening `<name`.
pub(crate) fn tag_span(file: FileId, node: roxmltree::Node<'_, '_>) -> Span {
    let start = node.range().start;
    let text = node.document().input_text();
    let length = text[start..]
        .find(|c: char| c.is_whitespace() || c == '>' || c == '/')
        .unwrap_or(1);
    Span {
        file,
        start: start as u32,
        end: (start + length) as u32,
    }
}

fn span(file: FileId, range: Range<usize>) -> Span {
    Span {
        file,
        start: range.start as u32,
        end: range.end as u32,
    }
}

impl<'a> Attributes<'a> {
    /// Reads an element's attributes; `accepted` are their names, with `!` before those that must
    /// be there. `None` if one that must be there is not, or is broken; all mistakes have been
    /// reported.
    pub(crate) fn read(
        reader: &mut Reader<'_>,
        file: FileId,
        node: roxmltree::Node<'a, '_>,
        accepted: &[&'static str],
    ) -> Option<Self> {
        let tag = node.tag_name().name();
        let bare = |name: &'static str| name.trim_start_matches('!');
        let mut complete = true;
        let mut misspelt = Vec::new();
        let mut attributes = Self {
            list: Vec::with_capacity(4),
            tag_span: tag_span(file, node),
        };
        // Those of other name spaces are for other programs.
        for attribute in node.attributes().filter(|a| a.namespace().is_none()) {
            let name_span = span(file, attribute.range_qname());
            let value_span = span(file, attribute.range_value());
            if !accepted.iter().any(|a| bare(a) == attribute.name()) {
                let names = accepted.iter().map(|a| bare(a));
                misspelt.extend(etalon_params::suggest::nearest(attribute.name(), names));
                reader.report(
                    Diagnostic::error(
                        name_span,
                        format!("`<{tag}>` has no attribute `{}`", attribute.name()),
                    )
                    .suggest(attribute.name(), accepted.iter().map(|a| bare(a))),
                );
                continue;
            }
            let written = &node.document().input_text()[attribute.range_value()];
            let mut verbatim = written == attribute.value();
            let mut defaults = Vec::new();
            let text = if attribute.value().contains('$') {
                match reader.substitute(attribute.value(), value_span, verbatim) {
                    Some(substituted) => {
                        verbatim &= substituted.text == attribute.value();
                        defaults = substituted.defaults;
                        Cow::Owned(substituted.text)
                    }
                    None => {
                        complete = false;
                        continue;
                    }
                }
            } else {
                Cow::Borrowed(attribute.value())
            };
            attributes.list.push(Attribute {
                name: attribute.name(),
                text,
                span: value_span,
                name_span,
                verbatim,
                defaults,
            });
        }
        for needed in accepted.iter().filter_map(|a| a.strip_prefix('!')) {
            if !node.attributes().any(|a| a.name() == needed) {
                complete = false;
                // Said already where it is misspelt.
                if misspelt.contains(&needed) {
                    continue;
                }
                reader.report(
                    Diagnostic::error(
                        attributes.tag_span,
                        format!("`<{tag}>` needs the attribute `{needed}`"),
                    )
                    .label(format!("`{needed}` is missing")),
                );
            }
        }
        complete.then_some(attributes)
    }

    /// An attribute by its name.
    pub(crate) fn get(&self, name: &str) -> Option<&Attribute<'a>> {
        self.list.iter().find(|a| a.name == name)
    }

    /// An attribute that is there because [`Attributes::read`] has checked it.
    pub(crate) fn required(&self, name: &str) -> &Attribute<'a> {
        self.get(name)
            .expect("`Attributes::read` returns only when what is required is there")
    }

    /// The finite float in an attribute.
    pub(crate) fn float(&self, reader: &mut Reader<'_>, name: &str) -> Option<f64> {
        let attribute = self.required(name);
        attribute
            .float(0..attribute.text.len(), "a number")
            .map_err(|error| reader.report(error))
            .ok()
    }

    /// The integer in an attribute.
    pub(crate) fn integer(&self, reader: &mut Reader<'_>, name: &str) -> Option<i64> {
        let attribute = self.required(name);
        let all = 0..attribute.text.len();
        let value = match number::integer(&attribute.text) {
            Err(NotANumber::Malformed) if number::is_computed(&attribute.text) => attribute
                .float(all.clone(), "an integer")
                .and_then(|value| {
                    let is_whole = value.fract() == 0.0 && value.abs() < 9e15;
                    let message = format!(
                        "`{}` is {value}, not an integer",
                        number::excerpt(attribute.text.trim())
                    );
                    if is_whole {
                        Ok(value as i64)
                    } else {
                        Err(attribute.error(all, message))
                    }
                }),
            other => other.map_err(|error| attribute.not_a_number(all, "an integer", error)),
        };
        value.map_err(|error| reader.report(error)).ok()
    }

    /// The numbers of a list; how many there may be is in `counts`.
    pub(crate) fn list(
        &self,
        reader: &mut Reader<'_>,
        name: &str,
        counts: &[usize],
    ) -> Option<Vec<f64>> {
        let attribute = self.required(name);
        let mut numbers = Vec::with_capacity(16);
        for (range, _) in number::tokens(&attribute.text) {
            match attribute.float(range, "a number") {
                Ok(x) => numbers.push(x),
                Err(error) => {
                    reader.report(error);
                    return None;
                }
            }
        }
        if counts.contains(&numbers.len()) {
            return Some(numbers);
        }
        let accepted: Vec<String> = counts.iter().map(usize::to_string).collect();
        reader.report(attribute.error_whole(format!(
            "expected {} numbers, found {}",
            accepted.join(" or "),
            numbers.len()
        )));
        None
    }

    /// A vector in `x`, `y` and `z` (each `default` if absent) or in `value` (of one number for
    /// all three, or of three), with its place.
    pub(crate) fn vector(
        &self,
        reader: &mut Reader<'_>,
        tag: &str,
        default: f64,
    ) -> Option<(DVec3, Span)> {
        let axes = ["x", "y", "z"].map(|axis| self.get(axis));
        let Some(value) = self.get("value") else {
            let mut vector = DVec3::splat(default);
            let mut sound = true;
            for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
                if self.get(axis).is_some() {
                    match self.float(reader, axis) {
                        Some(x) => vector[i] = x,
                        None => sound = false,
                    }
                }
            }
            let mut spans = axes.into_iter().flatten().map(|a| a.span);
            let span = spans.next().map_or(self.tag_span, |first| {
                spans.fold(first, |all, next| Span {
                    start: all.start.min(next.start),
                    end: all.end.max(next.end),
                    ..all
                })
            });
            return sound.then_some((vector, span));
        };
        if let Some(extra) = axes.into_iter().flatten().next() {
            reader.report(
                Diagnostic::error(
                    extra.name_span,
                    format!("`<{tag}>` takes either `value` or `x`, `y`, `z`"),
                )
                .related(value.name_span, "`value` is here"),
            );
            return None;
        }
        let numbers = self.list(reader, "value", &[1, 3])?;
        let vector = match numbers[..] {
            [x, y, z] => DVec3::new(x, y, z),
            _ => DVec3::splat(numbers[0]),
        };
        Some((vector, value.span))
    }
}
