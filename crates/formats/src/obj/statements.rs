//! The statements of an OBJ file in the form in which the parser reads them as Mitsuba does.
//!
//! Only `v`, `vt`, `vn` and `f` pass: without groups and materials the parser makes one mesh and
//! wants no other file, and names in any encoding do no harm. Continued lines are joined, comments
//! cut, and numbers beyond those that mean something to a mesh left out (such as the weight `w` of
//! a position, for curves), a `vt` of one number gets its second, 0.
//!
//! Three things are noted or refused here because the parser would not tell: which corners have no
//! texture coordinate or normal (it fills in the previous one), indices that it takes for
//! "missing" or that overflow its arithmetic, and colours that only some vertices have.

use super::lines::{Line, Lines};
use super::mistakes::{Counts, check, list_of};
use crate::nan::is_nan;
use std::io::{BufRead, Error, ErrorKind, Read, Result};

/// How much text is prepared at once, in bytes.
const CHUNK: usize = 1 << 16;

/// The longest index that is left to the parser unseen, in digits.
const LONGEST_INDEX: usize = 9;

/// What a corner of a face has besides its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Form {
    pub(super) uv: bool,
    pub(super) normal: bool,
}

/// A reader of prepared statements.
pub(super) struct Statements<'a> {
    lines: Lines<'a>,
    ready: Vec<u8>,
    taken: usize,
    given: Counts,
    /// Whether vertices keep their colours; if `None`, the first vertex decides.
    colours: Option<bool>,
    /// Whether reading stopped because vertices with and without colours were found.
    pub(super) mixed_colours: bool,
    /// The forms of all corners in order, as runs: a form and how many corners have it.
    pub(super) forms: Vec<(Form, usize)>,
}

impl<'a> Statements<'a> {
    /// The statements of a file; `colours` is `Some(false)` to leave colours out.
    pub(super) fn new(bytes: &'a [u8], colours: Option<bool>) -> Self {
        Self {
            lines: Lines::new(bytes),
            ready: Vec::with_capacity(CHUNK + 256),
            taken: 0,
            given: Counts::default(),
            colours,
            mixed_colours: false,
            forms: Vec::new(),
        }
    }

    fn statement(&mut self, line: &Line<'_>) -> Result<()> {
        let mut words = line.words();
        let Some(keyword) = words.next() else {
            return Ok(());
        };
        let mut wanted = match keyword {
            b"v" => 3,
            b"vt" => 2,
            b"vn" => 3,
            b"f" => return self.face(line, words),
            _ => return Ok(()),
        };
        if keyword == b"v" {
            let coloured = words.clone().nth(5).is_some();
            if coloured {
                self.check(line)?;
            }
            let keep = *self.colours.get_or_insert(coloured);
            if keep && !coloured {
                self.mixed_colours = true;
                return Err(refused());
            }
            wanted = if keep { 6 } else { 3 };
        }
        self.ready.extend_from_slice(keyword);
        let mut found = 0;
        for word in words.take(wanted) {
            self.ready.push(b' ');
            let word = if is_nan(word) { b"nan" } else { word };
            self.ready.extend_from_slice(word);
            found += 1;
        }
        if keyword == b"vt" && found == 1 {
            self.ready.extend_from_slice(b" 0");
        }
        self.ready.push(b'\n');
        if let Some(list) = list_of(keyword) {
            self.given[list] += 1;
        }
        Ok(())
    }

    fn face<'l>(&mut self, line: &Line<'_>, words: impl Iterator<Item = &'l [u8]>) -> Result<()> {
        let mut plain = true;
        self.ready.push(b'f');
        for word in words {
            self.ready.push(b' ');
            self.ready.extend_from_slice(word);
            let mut parts = word.split(|&b| b == b'/').skip(1);
            let [uv, normal] = [(); 2].map(|()| parts.next().unwrap_or_default());
            plain &= is_plain(uv) && is_plain(normal) && parts.next().is_none();
            let form = Form {
                uv: !uv.is_empty(),
                normal: !normal.is_empty(),
            };
            match self.forms.last_mut() {
                Some((last, count)) if *last == form => *count += 1,
                _ => self.forms.push((form, 1)),
            }
        }
        self.ready.push(b'\n');
        if plain { Ok(()) } else { self.check(line) }
    }

    /// Refuses mistakes that do not depend on later lines; an index may refer forward.
    fn check(&self, line: &Line<'_>) -> Result<()> {
        check(line, self.given, [u32::MAX as usize; 3]).map_err(|_| refused())
    }
}

/// Whether the parser can be trusted with this index of a texture coordinate or normal.
fn is_plain(index: &[u8]) -> bool {
    match index.first() {
        None => true,
        Some(first) => (b'1'..=b'9').contains(first) && index.len() <= LONGEST_INDEX,
    }
}

fn refused() -> Error {
    Error::from(ErrorKind::InvalidData)
}

impl BufRead for Statements<'_> {
    fn fill_buf(&mut self) -> Result<&[u8]> {
        if self.taken == self.ready.len() {
            self.ready.clear();
            self.taken = 0;
            while self.ready.len() < CHUNK {
                let Some(line) = self.lines.next_line() else {
                    break;
                };
                self.statement(&line)?;
            }
        }
        Ok(&self.ready[self.taken..])
    }

    fn consume(&mut self, amount: usize) {
        self.taken += amount;
    }
}

impl Read for Statements<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        let count = self.fill_buf()?.read(buffer)?;
        self.consume(count);
        Ok(count)
    }
}
