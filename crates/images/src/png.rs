//! Eight-bit sRGB pictures for people, as PNG.

use crate::losses::Losses;
use crate::view::Development;
use crate::{Colour, Error, Image, srgb, write_atomically};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use std::io;
use std::path::Path;

/// Writes the colour of an image, developed and encoded as sRGB, with its alpha if it has any.
///
/// Values above 1 or below 0 are clipped, and pixels that are not finite are painted magenta; the
/// result counts both. Colour is premultiplied by alpha, as in EXR; PNG is not, so it is divided by
/// alpha.
///
/// # Errors
/// [`Error::Unsupported`] for an image without colour, [`Error::Write`] where the operating
/// system refuses.
pub fn write(
    path: &Path,
    image: &Image,
    development: impl Into<Development>,
) -> Result<Losses, Error> {
    let colour = image.needed_colour(path)?;
    let (bytes, losses) = develop_colour(&colour, development.into());
    let [width, height] = [image.width(), image.height()];
    write_bytes(path, &bytes, width, height, samples(&colour))?;
    Ok(losses)
}

/// The file that [`write()`] makes, in memory. `None` for an image without colour or pixels.
#[must_use]
pub fn in_memory(image: &Image, development: impl Into<Development>) -> Option<Vec<u8>> {
    let colour = image.colour()?;
    let (bytes, _) = develop_colour(&colour, development.into());
    let [width, height] = [image.width(), image.height()];
    let mut file = Vec::new();
    encode(&mut file, &bytes, width, height, samples(&colour)).ok()?;
    Some(file)
}

/// What a pixel of this colour has.
fn samples(colour: &Colour<'_>) -> ExtendedColorType {
    match colour.alpha {
        Some(_) => ExtendedColorType::Rgba8,
        None => ExtendedColorType::Rgb8,
    }
}

/// The bytes [`write()`] puts into a file: RGB, or RGBA if the image has alpha. `None` for an
/// image without colour.
#[must_use]
pub fn develop(image: &Image, development: impl Into<Development>) -> Option<(Vec<u8>, Losses)> {
    Some(develop_colour(&image.colour()?, development.into()))
}

fn develop_colour(colour: &Colour<'_>, development: Development) -> (Vec<u8>, Losses) {
    let alpha = colour.alpha;
    let gain = development.gain();
    let mut losses = Losses::default();
    let pixels = colour.planes[0].len();
    let mut bytes = Vec::with_capacity(pixels * if alpha.is_some() { 4 } else { 3 });
    for pixel in 0..pixels {
        let opacity = alpha.map(|alpha| alpha[pixel]);
        let scale = match opacity {
            Some(a) if a > 0.0 && a < 1.0 => gain / f64::from(a),
            _ => gain,
        };
        let rgb = colour.planes.each_ref().map(|plane| plane[pixel]);
        if rgb.iter().chain(&opacity).all(|x| x.is_finite()) {
            for x in rgb {
                // In double precision: no finite gain of a finite sample is not a number.
                let x = development.view.shown(f64::from(x) * scale) as f32;
                losses.negative += usize::from(x < 0.0);
                losses.too_bright += usize::from(x > 1.0);
                bytes.push(srgb::encode_u8(x));
            }
        } else {
            losses.not_finite += 1;
            bytes.extend([255, 0, 255]);
        }
        if let Some(a) = opacity {
            bytes.push(if a.is_finite() {
                (a * 255.0 + 0.5) as u8
            } else {
                255
            });
        }
    }
    (bytes, losses)
}

/// Encodes RGB bytes, three per pixel, as a PNG file in memory, for reports.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] unless there are three bytes for each of the pixels, at
/// least one.
pub fn encode_rgb(bytes: &[u8], width: usize, height: usize) -> io::Result<Vec<u8>> {
    encode_channels(bytes, [width, height], 3)
}

/// The same with 1 (grey), 2 (grey and alpha), 3 or 4 (with alpha) bytes per pixel.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] for another number of channels or bytes.
pub fn encode_channels(
    bytes: &[u8],
    [width, height]: [usize; 2],
    channels: usize,
) -> io::Result<Vec<u8>> {
    let colour = match channels {
        1 => ExtendedColorType::L8,
        2 => ExtendedColorType::La8,
        4 => ExtendedColorType::Rgba8,
        // Of others, the bytes do not match.
        _ => ExtendedColorType::Rgb8,
    };
    let mut file = Vec::new();
    encode(&mut file, bytes, width, height, colour)?;
    Ok(file)
}

fn write_bytes(
    path: &Path,
    bytes: &[u8],
    width: usize,
    height: usize,
    colour: ExtendedColorType,
) -> Result<(), Error> {
    write_atomically(path, |file| encode(file, bytes, width, height, colour))
        .map_err(|source| Error::write(path, source))
}

fn encode(
    file: &mut impl io::Write,
    bytes: &[u8],
    width: usize,
    height: usize,
    colour: ExtendedColorType,
) -> io::Result<()> {
    let invalid = |reason: String| io::Error::new(io::ErrorKind::InvalidInput, reason);
    let size = |n: usize| u32::try_from(n).map_err(|error| invalid(error.to_string()));
    let channels = usize::from(colour.channel_count());
    if width == 0
        || width
            .checked_mul(height)
            .and_then(|n| n.checked_mul(channels))
            != Some(bytes.len())
    {
        return Err(invalid(format!(
            "{} bytes are not {width} × {height} pixels of {channels}",
            bytes.len()
        )));
    }
    PngEncoder::new(file)
        .write_image(bytes, size(width)?, size(height)?, colour)
        .map_err(|error| match error {
            image::ImageError::IoError(source) => source,
            other => invalid(other.to_string()),
        })
}
