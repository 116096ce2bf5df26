//! The lines of an OBJ file, with their numbers, continuations joined.

use crate::mesh_error::{MeshError, Place};
use std::borrow::Cow;

/// White space to the parser, but not to `u8::is_ascii_whitespace`.
const VERTICAL_TAB: u8 = 0x0b;

/// One logical line without its comment.
pub(super) struct Line<'a> {
    text: Cow<'a, [u8]>,
    number: usize,
}

impl Line<'_> {
    /// Its words.
    pub(super) fn words(&self) -> impl Iterator<Item = &[u8]> + Clone {
        self.text
            .split(|&b| b.is_ascii_whitespace() || b == VERTICAL_TAB)
            .filter(|word| !word.is_empty())
    }

    /// An error at this line.
    pub(super) fn error(&self, message: impl Into<String>) -> MeshError {
        MeshError::new(Place::Line(self.number), message)
    }
}

/// Iterates over the lines of a file.
pub(super) struct Lines<'a> {
    rest: &'a [u8],
    number: usize,
}

impl<'a> Lines<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self {
            rest: bytes,
            number: 0,
        }
    }

    /// The next line, if there is one. It carries the number of the first of the lines that were
    /// joined.
    pub(super) fn next_line(&mut self) -> Option<Line<'a>> {
        let number = self.number + 1;
        let (mut part, mut continued) = self.physical()?;
        if !continued {
            return Some(Line {
                text: Cow::Borrowed(part),
                number,
            });
        }
        let mut joined = Vec::new();
        loop {
            joined.extend_from_slice(part);
            joined.push(b' ');
            if !continued {
                break;
            }
            match self.physical() {
                Some(next) => (part, continued) = next,
                None => break,
            }
        }
        Some(Line {
            text: Cow::Owned(joined),
            number,
        })
    }

    /// The next physical line without comment, and whether the following one continues it.
    fn physical(&mut self) -> Option<(&'a [u8], bool)> {
        if self.rest.is_empty() {
            return None;
        }
        self.number += 1;
        let end = self.rest.iter().position(|&b| b == b'\n' || b == b'\r');
        let (line, ending) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        // A carriage return ends a line alone, too; one too many is part of the same ending.
        let length = match ending {
            [b'\r', b'\n', ..] => 2,
            [b'\r', b'\r', b'\n', ..] => 3,
            [] => 0,
            _ => 1,
        };
        self.rest = &ending[length..];
        let line = match line.iter().position(|&b| b == b'#') {
            Some(comment) => return Some((&line[..comment], false)),
            None => line,
        };
        Some(match line.strip_suffix(b"\\") {
            Some(line) => (line, true),
            None => (line, false),
        })
    }
}
