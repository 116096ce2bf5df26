//! Writing EXR files with reproducible bytes.

use super::{ATTRIBUTE, Part};
use crate::{Error, Frame, Image, write_atomically};
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
    write_atomically(path, |file| {
        encode_borrowed(
            file,
            &[Borrowed {
                name: None,
                image,
                offset: frame.offset,
            }],
            frame.size,
            text,
        )
    })
    .map_err(|source| failure(path, source))
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
            offset: part.offset,
        })
        .collect();
    encode_borrowed(writer, &borrowed, size, text)
}

/// A [`Part`] that does not own its image.
struct Borrowed<'a> {
    name: Option<&'a str>,
    image: &'a Image,
    offset: [i32; 2],
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
    let orders: Vec<Vec<usize>> = parts.iter().map(|part| alphabetical(part.image)).collect();
    let headers = parts
        .iter()
        .zip(&orders)
        .enumerate()
        .map(|(index, (part, order))| header(part, order, size, if index == 0 { text } else { "" }))
        .collect::<io::Result<Vec<_>>>()?;
    let samples: usize = parts
        .iter()
        .map(|part| part.image.width() * part.image.height() * part.image.channels().len())
        .sum();

    let outcome = block::write(writer, headers.into(), true, |meta, chunks| {
        let blocks = meta.collect_ordered_blocks(|index| {
            let (part, order) = (&parts[index.layer], &orders[index.layer]);
            UncompressedBlock::from_lines(&meta.headers[index.layer].channels, index, |line| {
                let at = line.location;
                let row = at.position.y() * part.image.width();
                let channel = &part.image.channels()[order[at.channel]];
                let source = &channel.samples[row..row + at.sample_count];
                for (bytes, sample) in line.value.chunks_exact_mut(4).zip(source) {
                    bytes.copy_from_slice(&sample.to_ne_bytes());
                }
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

/// The indices of the channels, sorted by name as bytes.
fn alphabetical(image: &Image) -> Vec<usize> {
    let channels = image.channels();
    let mut order: Vec<_> = (0..channels.len()).collect();
    order.sort_by(|&a, &b| channels[a].name.cmp(&channels[b].name));
    order
}

fn header(
    part: &Borrowed<'_>,
    order: &[usize],
    size: [usize; 2],
    text: &str,
) -> io::Result<Header> {
    let invalid = |reason: String| Err(io::Error::new(io::ErrorKind::InvalidData, reason));
    let image = part.image;
    if image.channels().is_empty() || image.width() == 0 || image.height() == 0 {
        return invalid("an EXR image needs at least one pixel and one channel".to_owned());
    }
    for channel in image.channels() {
        let name = &channel.name;
        if name.is_empty() || name.len() > 255 || name.contains('\0') {
            return invalid(format!("{name:?} cannot be the name of an EXR channel"));
        }
    }
    let channels = order
        .iter()
        .map(|&index| {
            let name = Text::from_slice_unchecked(image.channels()[index].name.as_bytes());
            ChannelDescription::new(name, SampleType::F32, true)
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
    if !text.is_empty() {
        header
            .own_attributes
            .other
            .insert(bytes(ATTRIBUTE), AttributeValue::Text(bytes(text)));
    }
    Ok(header)
}

/// UTF-8 bytes as they are.
fn bytes(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}
