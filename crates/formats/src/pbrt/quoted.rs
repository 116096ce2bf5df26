//! Escapes in quoted strings.

use std::borrow::Cow;
use std::ops::Range;

/// A string's text with its escapes resolved, or where an unknown escape stands in it.
pub(crate) fn unescape(text: &str) -> Result<Cow<'_, str>, Range<usize>> {
    if !text.contains('\\') {
        return Ok(Cow::Borrowed(text));
    }
    let mut result = String::with_capacity(text.len());
    let mut characters = text.char_indices();
    while let Some((start, character)) = characters.next() {
        if character != '\\' {
            result.push(character);
            continue;
        }
        let escaped = characters.next().map(|(_, escaped)| escaped);
        result.push(match escaped {
            Some('b') => '\u{8}',
            Some('f') => '\u{c}',
            Some('n') => '\n',
            Some('r') => '\r',
            Some('t') => '\t',
            Some(same @ ('\\' | '\'' | '"')) => same,
            _ => return Err(start..start + 1 + escaped.map_or(0, char::len_utf8)),
        });
    }
    Ok(Cow::Owned(result))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escapes_of_pbrt() {
        assert_eq!(unescape("plain é").as_deref(), Ok("plain é"));
        assert_eq!(
            unescape(r#"a\\b\"c\'\n\t\r\b\f"#).as_deref(),
            Ok("a\\b\"c'\n\t\r\u{8}\u{c}")
        );
        assert_eq!(unescape(r"C:\users"), Err(2..4));
        assert_eq!(unescape(r"é\é"), Err(2..5));
    }
}
