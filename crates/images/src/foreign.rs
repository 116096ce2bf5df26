//! Pictures in the formats that the crate `image` reads.

use crate::raster::{RasterHeader, Samples};
use crate::{Error, Format, Raster, chromaticities, png_encoding};
use glam::DVec3;
use image::codecs::{bmp, hdr, jpeg, png, pnm, tga};
use image::{ColorType, DynamicImage, ImageDecoder, Limits};
use std::borrow::Cow;
use std::io::{BufRead, Cursor, Seek};
use std::path::Path;

#[cfg(test)]
mod tests;

/// What a file of `length` bytes may hold.
fn limits(length: u64) -> Limits {
    let mut limits = Limits::default();
    limits.max_alloc = Some((1 << 28).max(length.saturating_mul(1100)));
    limits
}

/// A decoder that refuses images too large for the file.
fn decoder(bytes: &[u8], format: Format) -> image::ImageResult<Box<dyn ImageDecoder + '_>> {
    let mut limits = limits(bytes.len() as u64);
    let bytes = Cursor::new(bytes);
    let mut decoder: Box<dyn ImageDecoder> = match format {
        Format::Png => return png_decoder(bytes, limits),
        Format::Jpeg => Box::new(jpeg::JpegDecoder::new(bytes)?),
        Format::Bmp => Box::new(bmp::BmpDecoder::new(bytes)?),
        Format::Tga => Box::new(tga::TgaDecoder::new(bytes)?),
        Format::Pnm => Box::new(pnm::PnmDecoder::new(bytes)?),
        // Strictly, a file must begin with "#?RADIANCE"; many, Mitsuba's among them, do not.
        _ => Box::new(hdr::HdrDecoder::new_nonstrict(bytes)?),
    };
    limits.reserve(decoder.total_bytes())?;
    decoder.set_limits(limits)?;
    Ok(decoder)
}

fn png_decoder<'r>(
    file: impl BufRead + Seek + 'r,
    mut limits: Limits,
) -> image::ImageResult<Box<dyn ImageDecoder + 'r>> {
    let mut decoder = png::PngDecoder::with_limits(file, limits.clone())?;
    limits.reserve(decoder.total_bytes())?;
    decoder.set_limits(limits)?;
    Ok(Box::new(decoder))
}

pub(crate) fn decode_header(
    bytes: &[u8],
    format: Format,
    path: &Path,
) -> Result<RasterHeader, Error> {
    let (bytes, _) = rgbe(bytes, format);
    let decoder = decoder(&bytes, format).map_err(|error| failure(path, error))?;
    let (width, height) = decoder.dimensions();
    let colour = decoder.color_type();
    Ok(RasterHeader {
        format,
        width: width as usize,
        height: height as usize,
        channels: usize::from(colour.channel_count()),
        bits: u32::from(colour.bits_per_pixel() / u16::from(colour.channel_count())),
    })
}

pub(crate) fn decode(bytes: &[u8], format: Format, path: &Path) -> Result<Raster, Error> {
    let (stored, in_xyz) = rgbe(bytes, format);
    let decoded = decoder(&stored, format)
        .and_then(DynamicImage::from_decoder)
        .map_err(|error| failure(path, error))?;
    // A TGA file says how many bits of a pixel are opacity; of none its fourth byte says nothing.
    let opaque = format == Format::Tga && bytes[17] & 0x0f == 0;
    let decoded = match decoded {
        DynamicImage::ImageRgba8(_) if opaque => DynamicImage::ImageRgb8(decoded.into_rgb8()),
        other => other,
    };
    let mut notes = Vec::new();
    if format == Format::Jpeg && !jpeg_ends(bytes) {
        notes.push("the JPEG file ends too early; what is missing of the picture is grey".into());
    }
    let encoding = (format == Format::Png)
        .then(|| png_encoding::note(bytes))
        .flatten();
    Ok(raster(decoded, format, in_xyz, path)?.noting(notes, encoding))
}

/// Decodes a PNG file of `length` bytes, which is read as its pixels are made; its `head` has what stands before them.
pub(crate) fn decode_png(
    file: &mut (impl BufRead + Seek + ?Sized),
    head: &[u8],
    length: u64,
    path: &Path,
) -> Result<Raster, Error> {
    let decoded = png_decoder(file, limits(length))
        .and_then(DynamicImage::from_decoder)
        .map_err(|error| failure(path, error))?;
    let raster = raster(decoded, Format::Png, false, path)?;
    Ok(raster.noting(Vec::new(), png_encoding::note(head)))
}

/// The samples of a picture, which may be of XYZ.
fn raster(
    decoded: DynamicImage,
    format: Format,
    in_xyz: bool,
    path: &Path,
) -> Result<Raster, Error> {
    let size = [decoded.width() as usize, decoded.height() as usize];
    let channels = usize::from(decoded.color().channel_count());
    let samples = match decoded.color() {
        ColorType::L8 | ColorType::La8 | ColorType::Rgb8 | ColorType::Rgba8 => {
            Samples::U8(decoded.into_bytes())
        }
        ColorType::L16 => Samples::U16(decoded.into_luma16().into_raw()),
        ColorType::La16 => Samples::U16(decoded.into_luma_alpha16().into_raw()),
        ColorType::Rgb16 => Samples::U16(decoded.into_rgb16().into_raw()),
        ColorType::Rgba16 => Samples::U16(decoded.into_rgba16().into_raw()),
        _ => match decoded {
            DynamicImage::ImageRgb32F(image) => Samples::F32(image.into_raw()),
            DynamicImage::ImageRgba32F(image) => Samples::F32(image.into_raw()),
            other => {
                return Err(Error::unsupported(
                    path,
                    format!("its pixels are {:?}", other.color()),
                ));
            }
        },
    };
    let samples = match samples {
        Samples::F32(xyz) if in_xyz => Samples::F32(from_xyz(xyz)),
        other => other,
    };
    Ok(Raster::new(size, channels, samples, format))
}

/// A Radiance file whose pixels are XYZ, as one of RGB, which the decoder knows; and whether it
/// was one.
fn rgbe(bytes: &[u8], format: Format) -> (Cow<'_, [u8]>, bool) {
    const XYZE: &[u8] = b"\nFORMAT=32-bit_rle_xyze";
    let header = bytes.windows(2).position(|pair| pair == b"\n\n");
    let header = &bytes[..header.unwrap_or(0)];
    let found = header.windows(XYZE.len()).position(|line| line == XYZE);
    match found {
        Some(at) if format == Format::Hdr => {
            let mut changed = bytes.to_vec();
            let end = at + XYZE.len();
            changed[end - 4..end].copy_from_slice(b"rgbe");
            (Cow::Owned(changed), true)
        }
        _ => (Cow::Borrowed(bytes), false),
    }
}

fn from_xyz(mut samples: Vec<f32>) -> Vec<f32> {
    let matrix = chromaticities::xyz_to_rec_709();
    for pixel in samples.chunks_exact_mut(3) {
        let xyz = DVec3::new(pixel[0].into(), pixel[1].into(), pixel[2].into());
        pixel.copy_from_slice(&(matrix * xyz).as_vec3().to_array());
    }
    samples
}

/// Whether a JPEG file has the marker that ends its last scan. Its decoder fills up what is missing
/// with grey.
fn jpeg_ends(bytes: &[u8]) -> bool {
    let last = |marker: u8| bytes.windows(2).rposition(|pair| pair == [0xff, marker]);
    last(0xd9) > last(0xda)
}

fn failure(path: &Path, error: image::ImageError) -> Error {
    use image::ImageError as Cause;
    match error {
        Cause::Limits(limit) => Error::too_large(path, limit.to_string()),
        Cause::Unsupported(what) => Error::unsupported(path, what.to_string()),
        Cause::IoError(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => {
            Error::read(path, error)
        }
        Cause::IoError(_) => Error::invalid(path, "it ends too early"),
        other => Error::invalid(path, other.to_string()),
    }
}
