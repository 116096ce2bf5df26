//! Files of any format as pictures with their samples as stored.
//!
//! Formats are recognised by the files' content, never by their names.

use crate::raster::{Raster, RasterHeader, Samples};
use crate::{Error, Format, Frame, exr, foreign, halves, lfs_pointer, pfm};
use std::io::{BufRead, Read, Seek, SeekFrom};
use std::path::Path;

/// So many bytes at the beginning of a file are enough to know its format, and the metadata of a PNG file.
const HEAD: u64 = 1 << 20;

/// Reads a file of any format.
///
/// # Errors
/// [`Error::Read`] where the operating system refuses; otherwise as [`decode`].
pub fn read(path: &Path) -> Result<Raster, Error> {
    let bytes = std::fs::read(path).map_err(|source| Error::read(path, source))?;
    decode(&bytes, path)
}

/// Reads an open file from its beginning; `path` is only for messages. Of a PNG file no more than a few rows are held beside
/// its pixels.
///
/// # Errors
/// As [`decode`], and [`Error::Read`] where the operating system refuses.
pub fn decode_from(
    file: &mut (impl BufRead + Seek + ?Sized),
    path: &Path,
) -> Result<Raster, Error> {
    let refused = |source| Error::read(path, source);
    let length = file.seek(SeekFrom::End(0)).map_err(refused)?;
    file.rewind().map_err(refused)?;
    let mut head = Vec::with_capacity(length.min(HEAD) as usize);
    file.take(HEAD).read_to_end(&mut head).map_err(refused)?;
    if format(&head, path)? == Format::Png {
        file.rewind().map_err(refused)?;
        return foreign::decode_png(file, &head, length, path);
    }
    file.read_to_end(&mut head).map_err(refused)?;
    decode(&head, path)
}

/// Reads a file's bytes; `path` is only for messages.
///
/// # Errors
/// [`Error::Invalid`] where the file is damaged or truncated, [`Error::Unsupported`] for other
/// formats and for EXR files without colour, [`Error::TooLarge`] where a file declares more than
/// its length can justify (256 MiB of samples, or 1,100 bytes for each of its own).
pub fn decode(bytes: &[u8], path: &Path) -> Result<Raster, Error> {
    match format(bytes, path)? {
        Format::Exr => from_exr(bytes, path),
        Format::Pfm => pfm::decode(bytes, path),
        other => foreign::decode(bytes, other, path),
    }
}

/// Reads what a file says of itself, but no pixels; `path` is only for messages.
///
/// # Errors
/// As [`decode`], as far as the header shows.
pub fn decode_header(bytes: &[u8], path: &Path) -> Result<RasterHeader, Error> {
    let format = format(bytes, path)?;
    let (width, height, channels, bits) = match format {
        Format::Exr => {
            let header = exr::decode_header(bytes, path)?;
            let part = &header.parts[0];
            let half = |c: &exr::HeaderChannel| c.sample_type == exr::SampleType::F16;
            let bits = if part.channels.iter().all(half) {
                16
            } else {
                32
            };
            (part.width, part.height, part.channels.len(), bits)
        }
        Format::Pfm => {
            let header = pfm::decode_header(bytes, path)?;
            (header.width, header.height, header.channels, 32)
        }
        other => return foreign::decode_header(bytes, other, path),
    };
    Ok(RasterHeader {
        format,
        width,
        height,
        channels,
        bits,
    })
}

fn format(bytes: &[u8], path: &Path) -> Result<Format, Error> {
    Format::of(bytes).ok_or_else(|| match lfs_pointer(bytes) {
        Some(pointer) => Error::unsupported(path, pointer),
        None => Error::unsupported(path, format!("it is none of {}", Format::NAMES)),
    })
}

/// The largest number that 16 bits hold.
const LARGEST_HALF: f32 = 65504.0;

/// Holds what overflowed 16 bits to the largest number that they can; what to say of it.
fn hold_halves(samples: &mut [f32]) -> Option<String> {
    let mut count = 0;
    for sample in samples.iter_mut().filter(|sample| sample.is_infinite()) {
        *sample = LARGEST_HALF.copysign(*sample);
        count += 1;
    }
    (count > 0).then(|| {
        format!("{count} of its 16-bit numbers are infinite, and count as {LARGEST_HALF}, the largest there is")
    })
}

/// As many samples may be made of the window of any picture.
const MOST_PLACED: usize = 1 << 28;

/// Puts the pixels that a file holds where they are in the whole picture, which is black elsewhere.
fn placed(
    samples: Vec<f32>,
    [width, height]: [usize; 2],
    channels: usize,
    frame: Frame,
    notes: &mut Vec<String>,
) -> ([usize; 2], Vec<f32>) {
    let [columns, rows] = frame.size;
    let [left, top] = frame.offset;
    let words = format!(
        "its {width} × {height} pixels lie at ({left}, {top}) of a picture of {columns} × {rows}"
    );
    let count = columns
        .checked_mul(rows)
        .and_then(|n| n.checked_mul(channels));
    let Some(count) = count.filter(|count| *count <= MOST_PLACED) else {
        notes.push(format!(
            "{words}, which is too large: they are taken for all of it"
        ));
        return ([width, height], samples);
    };
    notes.push(format!("{words}, which is black elsewhere"));
    let mut whole = vec![0.0; count];
    for (y, row) in samples.chunks_exact(width * channels).enumerate() {
        let at = y as i64 + i64::from(top);
        let Some(at) = usize::try_from(at).ok().filter(|at| *at < rows) else {
            continue;
        };
        let target = &mut whole[at * columns * channels..(at + 1) * columns * channels];
        for (x, pixel) in row.chunks_exact(channels).enumerate() {
            let at = x as i64 + i64::from(left);
            if let Some(at) = usize::try_from(at).ok().filter(|at| *at < columns) {
                target[at * channels..(at + 1) * channels].copy_from_slice(pixel);
            }
        }
    }
    (frame.size, whole)
}

fn from_exr(bytes: &[u8], path: &Path) -> Result<Raster, Error> {
    let document = exr::decode(bytes, path)?;
    let ours = !document.text.is_empty();
    let (image, frame) = document.flatten();
    let size = [image.width(), image.height()];
    let header = exr::decode_header(bytes, path)?;
    let is_half = (header.parts.iter().flat_map(|part| &part.channels))
        .all(|channel| channel.sample_type == exr::SampleType::F16);
    let raster = |planes: &[&[f32]], mut notes: Vec<String>| {
        let mut samples = Vec::with_capacity(size[0] * size[1] * planes.len());
        for pixel in 0..size[0] * size[1] {
            samples.extend(planes.iter().map(|plane| plane[pixel]));
        }
        if is_half {
            notes.extend(hold_halves(&mut samples));
        }
        let (size, samples) = match frame == Frame::whole(&image) {
            true => (size, samples),
            false => placed(samples, size, planes.len(), frame, &mut notes),
        };
        // Colours of other primaries have been converted, and need more bits.
        let halves = is_half.then(|| halves::of_floats(&samples)).flatten();
        let samples = halves.map_or_else(|| Samples::F32(samples), Samples::F16);
        Raster::new(size, planes.len(), samples, Format::Exr).noting(notes, None)
    };
    if let (None, [only]) = (image.colour(), image.channels()) {
        return Ok(raster(&[&only.samples], Vec::new()));
    }
    let colour = image.needed_colour(path)?;
    let count = if colour.grey { 1 } else { 3 };
    let planes = colour.planes.iter().take(count).map(|plane| &**plane);
    let planes: Vec<&[f32]> = planes.chain(colour.alpha).collect();
    // In our own files the picture has no layer, and other channels are intended.
    let notes = if ours { Vec::new() } else { colour.notes };
    Ok(raster(&planes, notes))
}
