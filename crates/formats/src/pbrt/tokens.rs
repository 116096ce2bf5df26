//! Tokens of a pbrt file: quoted strings, brackets, and words, which are everything else.
//!
//! Blanks separate tokens, and `#` at the start of a token begins a comment up to the end of the line.
//! A word ends at a blank, a quotation mark or a bracket, as in pbrt: `1#2` is one word.

use etalon_params::{FileId, Span};

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TokenKind {
    /// A quoted string.
    Quoted,
    /// A quotation mark without its partner on the same line; the token reaches to the end of that line.
    Unterminated,
    /// `[`
    Open,
    /// `]`
    Close,
    /// A directive, a number, `true` or `false`.
    Word,
}

/// A token and where it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Token<'t> {
    pub(crate) kind: TokenKind,
    /// A quoted string's text is what stands between its quotation marks, with the escapes as written.
    pub(crate) text: &'t str,
    /// With its quotation marks.
    pub(crate) span: Span,
}

/// A place in a text that moves forward token by token.
#[derive(Clone, Debug)]
pub(crate) struct Cursor<'t> {
    text: &'t str,
    file: FileId,
    position: usize,
}

impl<'t> Cursor<'t> {
    /// The beginning of a text of less than 4 GiB, which is what a [`Span`] can point into.
    pub(crate) fn new(text: &'t str, file: FileId) -> Self {
        let position = 0;
        Self {
            text,
            file,
            position,
        }
    }

    /// The next token, if there is one.
    pub(crate) fn next(&mut self) -> Option<Token<'t>> {
        let first = self.skip_blanks()?;
        let start = self.position;
        let bytes = self.text.as_bytes();
        let (kind, text, end) = match first {
            b'[' => (TokenKind::Open, start..start + 1, start + 1),
            b']' => (TokenKind::Close, start..start + 1, start + 1),
            b'"' => match closing_quote(bytes, start + 1) {
                Ok(end) => (TokenKind::Quoted, start + 1..end, end + 1),
                Err(end) => (TokenKind::Unterminated, start..end, end),
            },
            _ => {
                let rest = &bytes[start..];
                let length = rest.iter().position(|&byte| ends_word(byte));
                let end = start + length.unwrap_or(rest.len());
                (TokenKind::Word, start..end, end)
            }
        };
        self.position = end;
        Some(Token {
            kind,
            // Tokens begin and end at ASCII characters, so this never fails.
            text: self.text.get(text).unwrap_or_default(),
            span: self.span(start, end),
        })
    }

    /// The next token, which stays the next one.
    pub(crate) fn peek(&self) -> Option<Token<'t>> {
        self.clone().next()
    }

    /// Moves to the next token and gives its first byte.
    pub(crate) fn skip_blanks(&mut self) -> Option<u8> {
        let bytes = self.text.as_bytes();
        loop {
            match bytes.get(self.position)? {
                b' ' | b'\n' | b'\t' | b'\r' => self.position += 1,
                b'#' => {
                    let rest = &bytes[self.position..];
                    let length = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
                    self.position += length.unwrap_or(rest.len());
                }
                byte => return Some(*byte),
            }
        }
    }

    /// Reads a word with `read`, which is given the bytes from here on, and says how many of them it took. If it took less
    /// than a whole word, nothing was read.
    pub(crate) fn word_by<T>(
        &mut self,
        read: impl Fn(&'t [u8]) -> Option<(T, usize)>,
    ) -> Option<T> {
        let rest = self.text.as_bytes().get(self.position..)?;
        let (value, length) = read(rest)?;
        if rest.get(length).is_some_and(|&byte| !ends_word(byte)) {
            return None;
        }
        self.position += length;
        Some(value)
    }

    /// An empty span where the cursor is.
    pub(crate) fn here(&self) -> Span {
        self.span(self.position, self.position)
    }

    fn span(&self, start: usize, end: usize) -> Span {
        Span {
            file: self.file,
            start: start as u32,
            end: end as u32,
        }
    }
}

/// Whether a word ends before this byte.
fn ends_word(byte: u8) -> bool {
    matches!(byte, b' ' | b'\n' | b'\t' | b'\r' | b'"' | b'[' | b']')
}

/// The position of the closing quotation mark, or of the end of the line if there is none before it.
fn closing_quote(bytes: &[u8], start: usize) -> Result<usize, usize> {
    let mut at = start;
    loop {
        match bytes.get(at) {
            Some(b'"') => return Ok(at),
            None | Some(b'\n') => return Err(at.min(bytes.len())),
            // The escaped character may be a quotation mark. The end of the line cannot be escaped.
            Some(b'\\') if bytes.get(at + 1).is_some_and(|&byte| byte != b'\n') => at += 2,
            Some(_) => at += 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tokens(text: &str) -> Vec<(TokenKind, &str, u32, u32)> {
        let mut cursor = Cursor::new(text, FileId(0));
        std::iter::from_fn(|| cursor.next())
            .map(|token| (token.kind, token.text, token.span.start, token.span.end))
            .collect()
    }

    #[test]
    fn tokens_and_their_places() {
        assert_eq!(
            tokens("Shape\"a b\"[1 ]# x ]\n é"),
            [
                (TokenKind::Word, "Shape", 0, 5),
                (TokenKind::Quoted, "a b", 5, 10),
                (TokenKind::Open, "[", 10, 11),
                (TokenKind::Word, "1", 11, 12),
                (TokenKind::Close, "]", 13, 14),
                (TokenKind::Word, "é", 21, 23),
            ]
        );
        assert_eq!(tokens(" # only a comment"), []);
        assert_eq!(tokens("1#2"), [(TokenKind::Word, "1#2", 0, 3)]);
        assert_eq!(tokens(r#""a\"b""#), [(TokenKind::Quoted, r#"a\"b"#, 0, 6)]);
    }

    #[test]
    fn strings_end_with_their_line() {
        let unterminated = (TokenKind::Unterminated, "\"a", 0, 2);
        assert_eq!(tokens("\"a"), [unterminated]);
        assert_eq!(
            tokens("\"a\n1"),
            [unterminated, (TokenKind::Word, "1", 3, 4)]
        );
        assert_eq!(tokens("\"a\\"), [(TokenKind::Unterminated, "\"a\\", 0, 3)]);
        assert_eq!(tokens("\"a\\\nb")[0].3, 3);
    }
}
