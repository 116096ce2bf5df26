//! What an EXR file says of itself, without its pixels.

use super::ATTRIBUTE;
use crate::{Chromaticities, Error, lfs_pointer};
use ::exr::math::Vec2;
use ::exr::meta::attribute::{AttributeValue, Text};
use ::exr::meta::{BlockDescription, MetaData};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

/// How a channel's samples are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleType {
    /// 16-bit floats.
    F16,
    /// 32-bit floats.
    F32,
    /// 32-bit unsigned integers.
    U32,
}

impl std::fmt::Display for SampleType {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::F16 => "f16",
            Self::F32 => "f32",
            Self::U32 => "u32",
        })
    }
}

/// A channel of a part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HeaderChannel {
    /// Its name.
    pub name: String,
    /// How its samples are stored.
    pub sample_type: SampleType,
}

/// An attribute, its value as text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attribute {
    /// Its name.
    pub name: String,
    /// Its value, readable by people.
    pub value: String,
}

/// An image of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct HeaderPart {
    /// Its name, if it has one.
    pub name: Option<String>,
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Column and row of its upper left pixel in the whole picture.
    pub offset: [i32; 2],
    /// Its channels, alphabetically.
    pub channels: Vec<HeaderChannel>,
    /// Its compression, such as `ZIP16`.
    pub compression: String,
    /// Whether it is stored in tiles.
    pub tiled: bool,
    /// Attributes the format does not demand, alphabetically, without [`ATTRIBUTE`].
    pub attributes: Vec<Attribute>,
}

/// What a file says of itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// The images.
    pub parts: Vec<HeaderPart>,
    /// Width and height of the whole picture.
    pub size: [usize; 2],
    /// The text of the attribute [`ATTRIBUTE`]; empty if there is none.
    pub text: String,
}

/// Reads the header of a file, and none of its pixels.
///
/// # Errors
/// [`Error::Read`] where the operating system refuses, [`Error::Invalid`] and
/// [`Error::Unsupported`] where the header is not one.
pub fn read_header(path: &Path) -> Result<Header, Error> {
    let file = File::open(path).map_err(|source| Error::read(path, source))?;
    let mut reader = BufReader::new(file);
    let head = reader.fill_buf();
    refuse_pointer(head.map_err(|source| Error::read(path, source))?, path)?;
    let meta = metadata(reader, path)?;
    Ok(describe(&meta))
}

/// As [`read_header`], of a file's bytes; `path` is only for messages.
///
/// # Errors
/// [`Error::Invalid`] and [`Error::Unsupported`].
pub fn decode_header(bytes: &[u8], path: &Path) -> Result<Header, Error> {
    Ok(describe(&metadata_of_bytes(bytes, path)?))
}

/// As [`metadata`], of a file's bytes.
pub(super) fn metadata_of_bytes(bytes: &[u8], path: &Path) -> Result<MetaData, Error> {
    refuse_pointer(bytes, path)?;
    metadata(bytes, path).map_err(|error| match unknown_compression(bytes) {
        Some(number) => {
            let name = match number {
                13 => " (ZSTD)",
                _ => "",
            };
            Error::unsupported(
                path,
                format!(
                    "EXR: its compression, number {number}{name}, is not known; it is of a newer \
                     version of the format; write it with ZIP or PIZ"
                ),
            )
        }
        None => error,
    })
}

fn refuse_pointer(bytes: &[u8], path: &Path) -> Result<(), Error> {
    match lfs_pointer(bytes) {
        Some(pointer) => Err(Error::unsupported(path, pointer)),
        None => Ok(()),
    }
}

/// The number of a compression beyond those of OpenEXR 3.4, if a header that could not be read
/// has one.
fn unknown_compression(bytes: &[u8]) -> Option<u8> {
    const BEFORE: &[u8] = b"compression\0compression\0\x01\0\0\0";
    let header = &bytes[..bytes.len().min(1 << 20)];
    let places = header.windows(BEFORE.len() + 1);
    let numbers = places.filter(|place| place.starts_with(BEFORE));
    numbers
        .map(|place| place[BEFORE.len()])
        .find(|&number| number > 11)
}

/// The header as the decoder sees it.
pub(super) fn metadata(reader: impl Read, path: &Path) -> Result<MetaData, Error> {
    let meta = MetaData::read_from_buffered(reader, false).map_err(|error| failure(path, error))?;
    if meta.headers.is_empty() {
        return Err(Error::invalid(path, "it has no image"));
    }
    Ok(meta)
}

/// An error of the decoder, with the file's name.
pub(super) fn failure(path: &Path, error: ::exr::error::Error) -> Error {
    use ::exr::error::Error as Cause;
    match error {
        Cause::Io(source) if source.kind() == io::ErrorKind::UnexpectedEof => {
            Error::invalid(path, "it ends too early")
        }
        Cause::Io(source) => Error::read(path, source),
        // A size that is no multiple of the sampling, which is allowed, is called invalid.
        Cause::NotSupported(reason) | Cause::Invalid(reason)
            if reason.contains("subsampling") || reason.contains("sampling factor not") =>
        {
            Error::unsupported(
                path,
                "EXR: its channels are subsampled (as luminance with chroma mostly is), which \
                 cannot be read; write R, G and B, or every channel at full size",
            )
        }
        Cause::NotSupported(reason) if reason.contains("compression method") => {
            Error::unsupported(path, format!("EXR: {reason}; write it with ZIP or PIZ"))
        }
        Cause::NotSupported(reason) => Error::unsupported(path, format!("EXR: {reason}")),
        Cause::Invalid(reason) => Error::invalid(path, format!("EXR: {reason}")),
        Cause::Aborted => Error::invalid(path, "EXR: reading was aborted"),
    }
}

/// A name or text; bytes that are not UTF-8 are shown as replacement characters.
pub(super) fn utf8(text: &Text) -> String {
    String::from_utf8_lossy(text.bytes()).into_owned()
}

/// The caller's text in a decoded header.
pub(super) fn text(meta: &MetaData) -> String {
    let attribute = meta
        .headers
        .iter()
        .flat_map(|header| &header.own_attributes.other)
        .find(|(name, _)| name.bytes() == ATTRIBUTE.as_bytes());
    match attribute {
        Some((_, AttributeValue::Text(text))) => utf8(text),
        _ => String::new(),
    }
}

/// The primaries of the file's colours, if it says them.
pub(super) fn chromaticities(header: &::exr::meta::header::Header) -> Option<Chromaticities> {
    let stored = header.shared_attributes.chromaticities?;
    let point = |Vec2(x, y)| [x, y];
    Some(Chromaticities {
        red: point(stored.red),
        green: point(stored.green),
        blue: point(stored.blue),
        white: point(stored.white),
    })
}

/// Width and height of the whole picture.
pub(super) fn size(meta: &MetaData) -> [usize; 2] {
    let window = meta.headers[0].shared_attributes.display_window;
    [window.size.width(), window.size.height()]
}

/// Column and row of a part's upper left pixel, counted from that of the whole picture.
pub(super) fn offset(header: &::exr::meta::header::Header) -> [i32; 2] {
    let data = header.own_attributes.layer_position;
    let display = header.shared_attributes.display_window.position;
    // Both lie within ±2³⁰ in a valid file.
    [
        data.x().saturating_sub(display.x()),
        data.y().saturating_sub(display.y()),
    ]
}

fn describe(meta: &MetaData) -> Header {
    let parts = meta
        .headers
        .iter()
        .map(|header| {
            let custom = (header.own_attributes.other.iter())
                .chain(&header.shared_attributes.other)
                .filter(|(name, _)| name.bytes() != ATTRIBUTE.as_bytes());
            let mut attributes: Vec<_> = custom
                .map(|(name, value)| Attribute {
                    name: utf8(name),
                    value: readable(value),
                })
                .collect();
            attributes.sort_by(|a, b| a.name.cmp(&b.name));
            HeaderPart {
                name: header.own_attributes.layer_name.as_ref().map(utf8),
                width: header.layer_size.width(),
                height: header.layer_size.height(),
                offset: offset(header),
                channels: header
                    .channels
                    .list
                    .iter()
                    .map(|channel| HeaderChannel {
                        name: utf8(&channel.name),
                        sample_type: sample_type(channel.sample_type),
                    })
                    .collect(),
                compression: header.compression.to_string(),
                tiled: matches!(header.blocks, BlockDescription::Tiles(_)),
                attributes,
            }
        })
        .collect();
    Header {
        parts,
        size: size(meta),
        text: text(meta),
    }
}

fn sample_type(stored: ::exr::meta::attribute::SampleType) -> SampleType {
    use ::exr::meta::attribute::SampleType as Stored;
    match stored {
        Stored::F16 => SampleType::F16,
        Stored::F32 => SampleType::F32,
        Stored::U32 => SampleType::U32,
    }
}

fn readable(value: &AttributeValue) -> String {
    match value {
        AttributeValue::Text(text) => utf8(text),
        AttributeValue::I32(x) => x.to_string(),
        AttributeValue::F32(x) => x.to_string(),
        AttributeValue::F64(x) => x.to_string(),
        AttributeValue::Rational((above, below)) => format!("{above}/{below}"),
        AttributeValue::Bytes { bytes, .. } | AttributeValue::Custom { bytes, .. } => {
            format!("{} bytes", bytes.len())
        }
        AttributeValue::TextVector(texts) => texts.iter().map(utf8).collect::<Vec<_>>().join(", "),
        other => format!("{other:?}"),
    }
}
