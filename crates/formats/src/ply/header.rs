//! The header: which elements there are, how many of each, and what each consists of.

use crate::mesh_error::{MeshError, Place};

/// How the data behind the header are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// A type of number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Number {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// Its size in bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// Whether it is a whole number.
    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// What a property consists of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Number(Number),
    List { count: Number, item: Number },
}

/// A property of an element.
#[derive(Clone, Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
}

impl Property {
    /// The fewest bytes that it takes in a binary file.
    pub(super) fn smallest(&self) -> usize {
        match self.kind {
            Kind::Number(number) => number.size(),
            Kind::List { count, .. } => count.size(),
        }
    }
}

/// A kind of element.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
    /// The line of the header in which it is declared.
    pub(super) line: usize,
}

impl Element {
    /// The number of the property with this name.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        self.properties.iter().position(|p| p.name == name)
    }

    /// The bytes of one such element, if it contains no list.
    pub(super) fn stride(&self) -> Option<usize> {
        self.properties
            .iter()
            .map(|p| match p.kind {
                Kind::Number(number) => Some(number.size()),
                Kind::List { .. } => None,
            })
            .sum()
    }
}

/// A header.
#[derive(Clone, Debug)]
pub(super) struct Header {
    pub(super) format: Format,
    pub(super) elements: Vec<Element>,
    /// Where the data begin.
    pub(super) data: usize,
    /// How many lines the header has.
    pub(super) lines: usize,
}

/// The most bytes and properties of a header.
const MOST_BYTES: usize = 1 << 20;
const MOST_PROPERTIES: usize = 1024;

impl Header {
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, MeshError> {
        let mut format = None;
        let mut elements: Vec<Element> = Vec::new();
        let mut properties = 0;
        let mut at = 0;
        let mut number = 0;
        let ending = line_ending(bytes);
        loop {
            number += 1;
            let error = |message: String| MeshError::new(Place::Line(number), message);
            let rest = &bytes[at..bytes.len().min(MOST_BYTES)];
            let Some(end) = rest.iter().position(|&b| b == ending) else {
                return Err(error(if number == 1 {
                    "the file does not begin with a line `ply`".into()
                } else {
                    "the header has no `end_header`".into()
                }));
            };
            let line = String::from_utf8_lossy(&rest[..end]);
            at += end + 1;
            let words: Vec<&str> = line.split_ascii_whitespace().collect();
            match words[..] {
                ["ply"] if number == 1 => {}
                _ if number == 1 => {
                    return Err(error("the file does not begin with a line `ply`".into()));
                }
                [] | ["comment" | "obj_info", ..] => {}
                ["format", name, version] => {
                    format = Some(match name {
                        "ascii" => Format::Ascii,
                        "binary_little_endian" => Format::LittleEndian,
                        "binary_big_endian" => Format::BigEndian,
                        other => {
                            return Err(error(format!(
                                "unknown format `{}`",
                                other.escape_debug()
                            )));
                        }
                    });
                    if version != "1.0" {
                        return Err(error(format!(
                            "unknown version `{}`, expected 1.0",
                            version.escape_debug()
                        )));
                    }
                }
                ["element", name, count] => elements.push(Element {
                    name: name.to_owned(),
                    count: count
                        .parse()
                        .map_err(|_| error(format!("`{}` is not a count", count.escape_debug())))?,
                    properties: Vec::new(),
                    line: number,
                }),
                ["property", ref definition @ ..] => {
                    let Some(element) = elements.last_mut() else {
                        return Err(error("a property stands before any element".into()));
                    };
                    properties += 1;
                    if properties > MOST_PROPERTIES {
                        return Err(error("too many properties".into()));
                    }
                    let property = property(definition).map_err(error)?;
                    if element.find(&property.name).is_some() {
                        let name = property.name;
                        return Err(error(format!("the property `{name}` is declared twice")));
                    }
                    element.properties.push(property);
                }
                ["end_header"] => break,
                _ => {
                    let shown: String = line.chars().take(60).collect();
                    return Err(error(format!(
                        "`{}` is not a line of a PLY header",
                        shown.trim_end().escape_debug()
                    )));
                }
            }
        }
        let format = format.ok_or_else(|| {
            MeshError::new(Place::Line(number), "the header declares no `format`")
        })?;
        Ok(Self {
            format,
            elements,
            data: at,
            lines: number,
        })
    }
}

/// What ends the lines of the header: a line feed, or a carriage return that none follows.
fn line_ending(bytes: &[u8]) -> u8 {
    let first = bytes.iter().position(|&b| b == b'\n' || b == b'\r');
    match first.map(|at| &bytes[at..]) {
        Some([b'\r', b'\n', ..]) | None => b'\n',
        Some(rest) => rest[0],
    }
}

/// `TYPE NAME` or `list COUNT ITEM NAME`.
fn property(definition: &[&str]) -> Result<Property, String> {
    let number = |name: &str| {
        Number::named(name).ok_or_else(|| format!("unknown type `{}`", name.escape_debug()))
    };
    let (kind, name) = match *definition {
        ["list", count, item, name] => {
            let (count, item) = (number(count)?, number(item)?);
            if !count.is_integer() {
                return Err("the count of a list must be an integer".into());
            }
            (Kind::List { count, item }, name)
        }
        [kind, name] => (Kind::Number(number(kind)?), name),
        _ => return Err("expected `property TYPE NAME` or `property list TYPE TYPE NAME`".into()),
    };
    Ok(Property {
        name: name.escape_debug().to_string(),
        kind,
    })
}
