//! Eight-bit sRGB pictures for people, as JPEG: a tenth of a PNG's bytes, for pages.

use crate::view::Development;
use crate::{Error, Image, Losses, png, write_atomically};
use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, ImageEncoder};
use std::io;
use std::path::Path;

/// Writes the colour of an image, developed and encoded as sRGB, without its alpha; `quality` is 1 to 100.
///
/// # Errors
/// [`Error::Unsupported`] for an image without colour, [`Error::Write`] where the operating
/// system refuses.
pub fn write(
    path: &Path,
    image: &Image,
    development: impl Into<Development>,
    quality: u8,
) -> Result<Losses, Error> {
    // What it says of an image that has none.
    image.needed_colour(path)?;
    let Some((mut bytes, losses)) = png::develop(image, development) else {
        return Ok(Losses::default());
    };
    if bytes.len() == 4 * image.width() * image.height() {
        let opaque = bytes.chunks_exact(4).flat_map(|rgba| &rgba[..3]);
        bytes = opaque.copied().collect();
    }
    let [width, height] = [image.width(), image.height()].map(|n| n as u32);
    let written = write_atomically(path, |file| {
        let encoder = JpegEncoder::new_with_quality(file, quality);
        encoder
            .write_image(&bytes, width, height, ExtendedColorType::Rgb8)
            .map_err(io::Error::other)
    });
    written.map_err(|source| Error::write(path, source))?;
    Ok(losses)
}
