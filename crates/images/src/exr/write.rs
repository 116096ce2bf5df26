//! Writing EXR files with reproducible bytes.

use super::{ATTRIBUTE, IntegerPlane, Part};
use crate::{Chromaticities, Error, Frame, Image, write_atomically};
use ::exr::block::writer::ChunksWriter;
use ::exr::block::{self, UncompressedBlock};
use ::exr::math::Vec2;
use ::exr::meta::attribute::{
    AttributeValue, ChannelDescription, Compression, IntegerBounds, LineOrder, SampleType, Text,
};
use ::exr::meta::{BlockDescription, header::Header};
use std::io::{self, Seek, Write};
use std::path::Path;

/// Writes one image to a file, with a text for the attribute [`ATTRIBUTE`](super::ATTRIBUTE)
/// (none if empty).
///
/// # Errors
/// [`Error::Write`] where the operating system refuses, [`Error::Invalid`] where an image cannot
/// be an EXR file (see [`encode`]). The file is then as it was before.
pub fn write(path: &Path, image: &Image, frame: Frame, text: &str) -> Result<(), Error> {
    write_with_integers(path, image, &[], frame, text)
}

/// As [`write()`], with further channels of whole numbers, which stay what they are to the bit.
///
/// # Errors
/// As [`write()`]; also where a plane has another size than the image.
pub fn write_with_integers(
    path: &Path,
    image: &Image,
    integers: &[IntegerPlane],
    frame: Frame,
    text: &str,
) -> Result<(), Error> {
    write_atomically(path, |file| {
        encode_with_integers(file, image, integers, frame, text)
    })
    .map_err(|source| failure(path, source))
}

/// As [`write_with_integers`], to anything that can seek.
///
/// # Errors
/// Those of the writer; [`io::ErrorKind::InvalidData`] as for [`encode`].
pub fn encode_with_integers(
    writer: impl Write + Seek,
    image: &Image,
    integers: &[IntegerPlane],
    frame: Frame,
    text: &str,
) -> io::Result<()> {
    let part = Borrowed {
        name: None,
        image,
        integers,
        offset: frame.offset,
    };
    encode_borrowed(writer, &[part], frame.size, text)
}

/// Writes several images to one file.
///
/// # Errors
/// As [`write()`].
pub fn write_parts(path: &Path, parts: &[Part], size: [usize; 2], text: &str) -> Result<(), Error> {
    write_atomically(path, |file| encode(file, parts, size, text))
        .map_err(|source| failure(path, source))
}

fn failure(path: &Path, source: io::Error) -> Error {
    if source.kind() == io::ErrorKind::InvalidData {
        Error::invalid(path, source.to_string())
    } else {
        Error::write(path, source)
    }
}

/// Writes an EXR file to anything that can seek. `size` is that of the whole picture; the text
/// goes into the first part.
///
/// # Errors
/// Those of the writer; [`io::ErrorKind::InvalidData`] for an image without pixels or channels,
/// a name that is empty, too long (255 bytes) or taken, or no part at all.
pub fn encode(
    writer: impl Write + Seek,
    parts: &[Part],
    size: [usize; 2],
    text: &str,
) -> io::Result<()> {
    let borrowed: Vec<_> = parts
        .iter()
        .map(|part| Borrowed {
            name: part.name.as_deref(),
            image: &part.image,
            integers: &[],
            offset: part.offset,
        })
        .collect();
    encode_borrowed(writer, &borrowed, size, text)
}

/// A [`Part`] that does not own its image.
struct Borrowed<'a> {
    name: Option<&'a str>,
    image: &'a Image,
    integers: &'a [IntegerPlane],
    offset: [i32; 2],
}

/// A channel as it will be stored.
#[derive(Clone, Copy)]
enum Plane<'a> {
    Floats(&'a str, &'a [f32]),
    Integers(&'a str, &'a [u32]),
}

impl<'a> Plane<'a> {
    fn name(self) -> &'a str {
        match self {
            Self::Floats(name, _) | Self::Integers(name, _) => name,
        }
    }

    /// Puts samples, four bytes each, into a line.
    fn copy(self, start: usize, line: &mut [u8]) {
        let line = line.chunks_exact_mut(4);
        match self {
            Self::Floats(_, samples) => {
                for (bytes, sample) in line.zip(&samples[start..]) {
                    bytes.copy_from_slice(&sample.to_ne_bytes());
                }
            }
            Self::Integers(_, samples) => {
                for (bytes, sample) in line.zip(&samples[start..]) {
                    bytes.copy_from_slice(&sample.to_ne_bytes());
                }
            }
        }
    }
}

/// Images up to this many samples are compressed by the calling thread.
const SMALL: usize = 1 << 18;

fn encode_borrowed(
    writer: impl Write + Seek,
    parts: &[Borrowed<'_>],
    size: [usize; 2],
    text: &str,
) -> io::Result<()> {
    // EXR files keep their channels in alphabetical order.
    let planes: Vec<Vec<Plane<'_>>> = parts.iter().map(alphabetical).collect();
    let headers = parts
        .iter()
        .zip(&planes)
        .enumerate()
        .map(|(index, (part, planes))| {
            header(part, planes, size, if index == 0 { text } else { "" })
        })
        .collect::<io::Result<Vec<_>>>()?;
    let samples: usize = parts
        .iter()
        .zip(&planes)
        .map(|(part, planes)| part.image.width() * part.image.height() * planes.len())
        .sum();

    let outcome = block::write(writer, headers.into(), true, |meta, chunks| {
        let blocks = meta.collect_ordered_blocks(|index| {
            let width = parts[index.layer].image.width();
            let planes = &planes[index.layer];
            UncompressedBlock::from_lines(&meta.headers[index.layer].channels, index, |line| {
                let at = line.location;
                planes[at.channel].copy(at.position.y() * width, line.value);
            })
        });
        // Compressing consumes the writer, so it gets one that borrows ours.
        let chunks = chunks.on_progress(|_| ());
        if samples <= SMALL {
            chunks.compress_all_blocks_sequential(&meta, blocks)
        } else {
            chunks.compress_all_blocks_parallel(&meta, blocks)
        }
    });
    outcome.map_err(|error| match error {
        ::exr::error::Error::Io(source) => source,
        other => io::Error::new(io::ErrorKind::InvalidData, other.to_string()),
    })
}

/// The channels, sorted by name as bytes.
fn alphabetical<'a>(part: &Borrowed<'a>) -> Vec<Plane<'a>> {
    let floats = part.image.channels().iter();
    let integers = part.integers.iter();
    let mut planes: Vec<_> = floats
        .map(|channel| Plane::Floats(&channel.name, &channel.samples))
        .chain(integers.map(|plane| Plane::Integers(&plane.name, &plane.samples)))
        .collect();
    planes.sort_by_key(|plane| plane.name());
    planes
}

fn header(
    part: &Borrowed<'_>,
    planes: &[Plane<'_>],
    size: [usize; 2],
    text: &str,
) -> io::Result<Header> {
    let invalid = |reason: String| Err(io::Error::new(io::ErrorKind::InvalidData, reason));
    let image = part.image;
    if planes.is_empty() || image.width() == 0 || image.height() == 0 {
        return invalid("an EXR image needs at least one pixel and one channel".to_owned());
    }
    let pixels = image.width() * image.height();
    if let Some(plane) = (part.integers.iter()).find(|plane| plane.samples.len() != pixels) {
        let name = &plane.name;
        return invalid(format!("{name:?} has another size than the image"));
    }
    for plane in planes {
        let name = plane.name();
        if name.is_empty() || name.len() > 255 || name.contains('\0') {
            return invalid(format!("{name:?} cannot be the name of an EXR channel"));
        }
    }
    let channels = planes
        .iter()
        .map(|plane| {
            let stored = match plane {
                Plane::Floats(..) => SampleType::F32,
                Plane::Integers(..) => SampleType::U32,
            };
            let name = Text::from_slice_unchecked(plane.name().as_bytes());
            ChannelDescription::new(name, stored, true)
        })
        .collect();
    let mut header = Header::new(
        bytes(part.name.unwrap_or_default()),
        Vec2(image.width(), image.height()),
        channels,
    )
    .with_encoding(
        Compression::ZIP16,
        BlockDescription::ScanLines,
        LineOrder::Increasing,
    )
    .with_display_window(IntegerBounds::new(Vec2(0, 0), Vec2(size[0], size[1])))
    .with_position(Vec2(part.offset[0], part.offset[1]));
    header.own_attributes.layer_name = part.name.map(bytes);
    header.shared_attributes.chromaticities = image.chromaticities().map(stored);
    if !text.is_empty() {
        header
            .own_attributes
            .other
            .insert(bytes(ATTRIBUTE), AttributeValue::Text(bytes(text)));
    }
    Ok(header)
}

fn stored(c: Chromaticities) -> ::exr::meta::attribute::Chromaticities {
    let point = |[x, y]: [f32; 2]| Vec2(x, y);
    ::exr::meta::attribute::Chromaticities {
        red: point(c.red),
        green: point(c.green),
        blue: point(c.blue),
        white: point(c.white),
    }
}

/// UTF-8 bytes as they are.
fn bytes(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}
