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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster_file;

    #[test]
    fn a_picture_is_read_back_but_for_the_losses_of_the_format() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.jpg");
        let slope = |scale: f32| {
            (0..32 * 16)
                .map(|i| scale * (i % 32) as f32 / 32.0)
                .collect()
        };
        let image = Image::new(32, 16)
            .with("R", slope(0.5))
            .with("G", slope(1.0))
            .with("B", slope(0.25))
            .with("A", vec![1.0; 32 * 16]);
        // Mutants rejected: alpha among the colours; no exposure.
        write(&path, &image, 1.0, 95).expect("it is written");
        let read = raster_file::read(&path)
            .expect("it is read")
            .to_linear()
            .to_vec();
        for (i, pixel) in read.chunks_exact(3).enumerate() {
            let x = (i % 32) as f32 / 32.0;
            for (value, known) in pixel.iter().zip([x, (2.0 * x).min(1.0), 0.5 * x]) {
                assert!((value - known).abs() < 0.06, "{i}: {value} {known}");
            }
        }
        let grey = Image::new(1, 1).with("depth", vec![1.0]);
        assert!(write(&folder.path().join("b.jpg"), &grey, 0.0, 95).is_err());
    }
}
