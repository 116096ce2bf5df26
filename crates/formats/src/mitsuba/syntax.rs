//! Mistakes of XML itself, in words.

use etalon_params::{Diagnostic, FileId, Span};
use roxmltree::{Error, TextPos};

/// The diagnostic of a failed parse of `text`.
pub(crate) fn diagnose(error: &Error, file: FileId, text: &str) -> Diagnostic {
    let start = match error {
        Error::DtdDetected => text.find("<!DOCTYPE").unwrap_or(0),
        Error::NoRootNode => 0,
        Error::UnclosedRootNode | Error::UnexpectedEndOfStream => text.trim_end().len(),
        Error::NodesLimitReached | Error::AttributesLimitReached => 0,
        other => offset(text, other.pos()),
    };
    let (message, help) = match error {
        Error::UnknownToken(_) if !text[..start].trim().is_empty() => (
            "there is something behind the end of the outermost element".into(),
            Some("a scene is one `<scene>`; comments are written `<!-- … -->`"),
        ),
        other => describe(other),
    };
    let end = text[start..]
        .chars()
        .next()
        .map_or(start, |c| start + c.len_utf8());
    let span = Span {
        file,
        start: start as u32,
        end: end as u32,
    };
    let diagnostic = Diagnostic::error(span, message);
    match help {
        Some(help) => diagnostic.help(help),
        None => diagnostic,
    }
}

fn describe(error: &Error) -> (String, Option<&'static str>) {
    match error {
        Error::DtdDetected => (
            "a document type declaration can only stand, whole, before the scene".into(),
            Some("remove `<!DOCTYPE …>`: scenes have no use for it"),
        ),
        Error::NoRootNode => ("the file contains no `<scene>`".into(), None),
        Error::UnclosedRootNode | Error::UnexpectedEndOfStream => (
            "the file ends in the middle of an element".into(),
            Some("an element that was opened is not closed"),
        ),
        Error::UnexpectedCloseTag(expected, found, _) => (
            format!("`</{found}>` closes `<{expected}>`"),
            Some("every element is closed by its own name or by `/>`"),
        ),
        Error::DuplicatedAttribute(name, _) => (
            format!("the attribute `{name}` is written twice in one element"),
            None,
        ),
        Error::InvalidAttributeValue(_) => (
            "`<` cannot stand in an attribute's value".into(),
            Some("a closing quote may be missing; a `<` itself is written `&lt;`"),
        ),
        Error::UnknownEntityReference(name, _) => (
            format!("unknown entity `&{name};`"),
            Some("known: &amp; &lt; &gt; &quot; &apos; &#…;"),
        ),
        Error::MalformedEntityReference(_) => (
            "malformed entity reference".into(),
            Some("an ampersand itself is written `&amp;`"),
        ),
        Error::UnknownNamespace(prefix, _) => (
            format!("the name space `{prefix}` is not declared"),
            Some("tags of a scene have no prefix"),
        ),
        Error::NonXmlChar(c, _) => (
            format!("the character U+{:04X} cannot stand in XML", u32::from(*c)),
            None,
        ),
        Error::InvalidChar(expected, found, _) => (
            format!(
                "expected `{}`, found `{}`",
                char::from(*expected).escape_default(),
                char::from(*found).escape_default()
            ),
            None,
        ),
        Error::InvalidChar2(expected, found, _) => (
            format!(
                "expected {expected}, found `{}`",
                char::from(*found).escape_default()
            ),
            Some("attributes are written `name=\"value\"`; is a quote missing?"),
        ),
        Error::InvalidString(expected, _) => (format!("expected `{expected}`"), None),
        Error::InvalidName(_) => ("a name was expected here".into(), None),
        Error::InvalidComment(_) => (
            "malformed comment".into(),
            Some("comments are written `<!-- … -->`"),
        ),
        Error::InvalidCharacterData(_) => ("`]]>` cannot stand in text".into(), None),
        Error::UnknownToken(_) => (
            "this is not XML".into(),
            Some("a scene begins with `<scene version=\"3.0.0\">`"),
        ),
        Error::NodesLimitReached | Error::AttributesLimitReached => {
            ("the file has too many elements".into(), None)
        }
        other => (format!("malformed XML: {}", without_place(other)), None),
    }
}

/// The crate's own message without its trailing ` at line:column`.
fn without_place(error: &Error) -> String {
    let text = error.to_string();
    match text.rfind(" at ") {
        Some(at) => text[..at].to_owned(),
        None => text,
    }
}

/// The byte offset of a row and column (both from 1; columns count characters).
fn offset(text: &str, position: TextPos) -> usize {
    let mut line_start = 0;
    for _ in 1..position.row {
        match text[line_start..].find('\n') {
            Some(at) => line_start += at + 1,
            None => return text.len(),
        }
    }
    text[line_start..]
        .char_indices()
        .nth(position.col.saturating_sub(1) as usize)
        .map_or(text.len(), |(at, _)| line_start + at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mistake_has_its_place() {
        let message = |text: &str| {
            let options = roxmltree::ParsingOptions::default();
            let error = roxmltree::Document::parse_with_options(text, options)
                .expect_err("malformed on purpose");
            let mut sources = etalon_params::Sources::default();
            let file = sources.add("s", text);
            diagnose(&error, file, text).one_line(&sources)
        };
        assert_eq!(
            message("<scene>\n <bsdf></scene>"),
            "s:2:8: error: `</scene>` closes `<bsdf>` \
             (every element is closed by its own name or by `/>`)"
        );
        assert_eq!(
            message("<é>\n <a b='1' b='2'/></é>"),
            "s:2:11: error: the attribute `b` is written twice in one element"
        );
        assert!(message("").starts_with("s:1:1: error: the file contains no `<scene>`"));
        assert!(message("<a>\n<b/>\n").starts_with("s:2:5: error: the file ends"));
        assert!(message("\n<!DOCTYPE a").starts_with("s:2:1: error: a document type"));
        assert!(message("<a b='&q;'/>").starts_with("s:1:7: error: unknown entity `&q;`"));
        assert!(message("<a/><a/>").starts_with("s:1:5: error: there is something behind"));
        assert!(message("hello").starts_with("s:1:1: error: this is not XML"));
    }
}
