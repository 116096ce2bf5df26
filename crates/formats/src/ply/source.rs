//! Numbers of the data section, in any of its formats.

use super::header::{Element, Format, Header, Number};
use crate::mesh_error::{MeshError, Place};
use crate::nan::is_nan;

/// The data section and how far it has been read.
#[derive(Clone)]
pub(super) struct Source<'a> {
    bytes: &'a [u8],
    at: usize,
    /// The line of `at`, in text files.
    line: usize,
    format: Format,
}

impl<'a> Source<'a> {
    pub(super) fn new(bytes: &'a [u8], header: &Header) -> Self {
        Self {
            bytes,
            at: header.data,
            line: header.lines + 1,
            format: header.format,
        }
    }

    pub(super) fn is_binary(&self) -> bool {
        self.format != Format::Ascii
    }

    pub(super) fn format(&self) -> Format {
        self.format
    }

    /// The line on which the next word of a text file stands.
    pub(super) fn line(&mut self) -> usize {
        self.skip_space();
        self.line
    }

    fn skip_space(&mut self) {
        while let Some(b) = self.bytes.get(self.at) {
            if !b.is_ascii_whitespace() {
                break;
            }
            // A lone carriage return ends a line, too.
            let ends = *b == b'\n' || *b == b'\r' && self.bytes.get(self.at + 1) != Some(&b'\n');
            self.line += usize::from(ends);
            self.at += 1;
        }
    }

    /// An error at the place that was read last.
    #[cold]
    pub(super) fn error(&self, message: impl Into<String>) -> MeshError {
        let place = match self.format {
            Format::Ascii => Place::Line(self.line),
            _ => Place::Byte(self.at),
        };
        MeshError::new(place, message)
    }

    #[cold]
    fn ended(&self) -> MeshError {
        self.error("the file ends before all its elements have come")
    }

    /// `count`, but no more than the rest of the file has room for if each takes `size` bytes in
    /// binary files and `words` words in text.
    pub(super) fn room_for(&self, count: usize, size: usize, words: usize) -> usize {
        let size = if self.is_binary() { size } else { 2 * words };
        count.min((self.bytes.len() - self.at) / size.max(1) + 1)
    }

    /// The bytes of all elements of one kind, `stride` bytes each, and where they begin.
    pub(super) fn rows(
        &mut self,
        element: &Element,
        stride: usize,
    ) -> Result<(&'a [u8], usize), MeshError> {
        let start = self.at;
        let rest = &self.bytes[start..];
        match element.count.checked_mul(stride) {
            Some(length) if length <= rest.len() => {
                self.at += length;
                Ok((&rest[..length], start))
            }
            _ => Err(self.error(format!(
                "{} elements `{}` of {stride} bytes are announced, but {} bytes are left",
                element.count,
                element.name,
                rest.len()
            ))),
        }
    }

    /// The next word of a text file.
    fn word(&mut self) -> Result<&'a str, MeshError> {
        self.skip_space();
        let rest = &self.bytes[self.at..];
        let end = rest
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(rest.len());
        if end == 0 {
            return Err(self.ended());
        }
        self.at += end;
        std::str::from_utf8(&rest[..end]).map_err(|_| self.error("this is not a number"))
    }

    #[inline]
    fn take<const N: usize>(&mut self) -> Result<[u8; N], MeshError> {
        match self.bytes[self.at..].first_chunk::<N>() {
            Some(chunk) => {
                self.at += N;
                Ok(*chunk)
            }
            None => Err(self.ended()),
        }
    }

    /// The next number.
    #[inline]
    pub(super) fn number(&mut self, number: Number) -> Result<f64, MeshError> {
        if self.format == Format::Ascii {
            let word = self.word()?;
            return match word.parse() {
                Ok(number) => Ok(number),
                Err(_) if is_nan(word.as_bytes()) => Ok(f64::NAN),
                Err(_) => Err(self.not_a_number(word)),
            };
        }
        let big = self.format == Format::BigEndian;
        Ok(match number.size() {
            1 => decode(number, &self.take::<1>()?, big),
            2 => decode(number, &self.take::<2>()?, big),
            4 => decode(number, &self.take::<4>()?, big),
            _ => decode(number, &self.take::<8>()?, big),
        })
    }

    #[cold]
    fn not_a_number(&self, word: &str) -> MeshError {
        let shown: String = word.chars().take(40).collect();
        self.error(format!("`{}` is not a number", shown.escape_debug()))
    }

    /// The next number, which must be whole.
    #[inline]
    pub(super) fn integer(&mut self, number: Number) -> Result<i64, MeshError> {
        if let (Format::LittleEndian, Number::I32 | Number::U32) = (self.format, number) {
            let bits = u32::from_le_bytes(self.take()?);
            return Ok(match number {
                Number::I32 => i64::from(bits as i32),
                _ => i64::from(bits),
            });
        }
        let value = self.number(number)?;
        let whole = value as i64;
        if whole as f64 == value {
            Ok(whole)
        } else {
            Err(self.error(format!("{value} is not a whole number")))
        }
    }

    /// The next number, as the length of a list.
    #[inline]
    pub(super) fn length(&mut self, number: Number) -> Result<usize, MeshError> {
        if self.is_binary() && number == Number::U8 {
            return self.take::<1>().map(|[length]| usize::from(length));
        }
        let length = self.integer(number)?;
        usize::try_from(length).map_err(|_| self.error(format!("a list of {length} numbers")))
    }
}

/// The number in the first bytes of `bytes`.
#[inline]
pub(super) fn decode(number: Number, bytes: &[u8], big: bool) -> f64 {
    macro_rules! number {
        ($type:ty) => {{
            let mut raw = [0; size_of::<$type>()];
            raw.copy_from_slice(&bytes[..size_of::<$type>()]);
            let value = if big {
                <$type>::from_be_bytes(raw)
            } else {
                <$type>::from_le_bytes(raw)
            };
            f64::from(value)
        }};
    }
    match number {
        Number::I8 => number!(i8),
        Number::U8 => number!(u8),
        Number::I16 => number!(i16),
        Number::U16 => number!(u16),
        Number::I32 => number!(i32),
        Number::U32 => number!(u32),
        Number::F32 => number!(f32),
        Number::F64 => number!(f64),
    }
}
