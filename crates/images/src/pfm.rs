//! Portable float maps (Debevec): `PF` (RGB) or `Pf` (grey), width and height, a scale whose
//! sign gives the byte order (negative: little-endian), then rows of 32-bit floats from the
//! *bottom*.

use crate::raster::{Raster, Samples};
use crate::{Error, Format, Image, write_atomically};
use std::io::{self, Write};
use std::path::Path;

/// The header of a map, and where its samples begin.
pub(crate) struct PfmHeader {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) channels: usize,
    scale: f32,
    start: usize,
}

pub(crate) fn decode_header(bytes: &[u8], path: &Path) -> Result<PfmHeader, Error> {
    let invalid = |reason: &str| Error::invalid(path, format!("PFM: {reason}"));
    let mut position = 0;
    let mut word = || {
        let rest = &bytes[position..];
        let skipped = rest.iter().take_while(|b| b.is_ascii_whitespace()).count();
        let word = &rest[skipped..];
        let length = word
            .iter()
            .take_while(|b| !b.is_ascii_whitespace())
            .count()
            .min(64);
        // Exactly one white-space character follows each word of the header.
        position = (position + skipped + length + 1).min(bytes.len());
        std::str::from_utf8(&word[..length]).unwrap_or_default()
    };
    let channels = match word() {
        "PF" => 3,
        "Pf" => 1,
        _ => return Err(invalid("it begins with neither PF nor Pf")),
    };
    let mut size = || {
        let word = word();
        word.parse::<usize>()
            .ok()
            .filter(|&n| n > 0 && n < 1 << 30)
            .ok_or_else(|| invalid(&format!("{word:?} is not a size in pixels")))
    };
    let (width, height) = (size()?, size()?);
    let text = word();
    let scale = text
        .parse::<f32>()
        .ok()
        .filter(|scale| scale.is_finite() && *scale != 0.0)
        .ok_or_else(|| invalid(&format!("{text:?} is not a scale")))?;
    Ok(PfmHeader {
        width,
        height,
        channels,
        scale,
        start: position,
    })
}

/// Reads a map's bytes; `path` is only for messages. Samples are multiplied by the magnitude of
/// the scale.
///
/// # Errors
/// [`Error::Invalid`] where the header is not one, or the file has not exactly the samples it
/// declares.
pub fn decode(bytes: &[u8], path: &Path) -> Result<Raster, Error> {
    let header = decode_header(bytes, path)?;
    let data = &bytes[header.start..];
    let row = header.width * header.channels;
    let expected = row as u128 * header.height as u128 * 4;
    if data.len() as u128 != expected {
        return Err(Error::invalid(
            path,
            format!(
                "PFM: {} bytes of samples, but {expected} are declared",
                data.len()
            ),
        ));
    }
    let factor = header.scale.abs();
    let sample = |bytes: &[u8]| {
        let bytes = [bytes[0], bytes[1], bytes[2], bytes[3]];
        let stored = if header.scale < 0.0 {
            f32::from_le_bytes(bytes)
        } else {
            f32::from_be_bytes(bytes)
        };
        stored * factor
    };
    let samples = data
        .chunks_exact(row * 4)
        .rev()
        .flat_map(|row| row.chunks_exact(4).map(sample))
        .collect();
    Ok(Raster::new(
        [header.width, header.height],
        header.channels,
        Samples::F32(samples),
        Format::Pfm,
    ))
}

/// Writes the colour of an image as a little-endian map.
///
/// # Errors
/// [`Error::Unsupported`] for an image without colour, [`Error::Write`] where the operating
/// system refuses.
pub fn write(path: &Path, image: &Image) -> Result<(), Error> {
    let colour = image.needed_colour(path)?;
    let planes = colour.planes.each_ref().map(|plane| &**plane);
    write_atomically(path, |file| encode(file, image, planes))
        .map_err(|source| Error::write(path, source))
}

fn encode(file: &mut impl Write, image: &Image, [r, g, b]: [&[f32]; 3]) -> io::Result<()> {
    write!(file, "PF\n{} {}\n-1.0\n", image.width(), image.height())?;
    for row in (0..image.height()).rev() {
        for pixel in row * image.width()..(row + 1) * image.width() {
            for plane in [r, g, b] {
                file.write_all(&plane[pixel].to_le_bytes())?;
            }
        }
    }
    Ok(())
}
