//! Pictures with the samples they were stored with: what textures are made of.
//!
//! PNG, JPEG, BMP, Radiance HDR, PFM and EXR are told apart by their first bytes, never by the
//! file's name.

use crate::{Error, exr, pfm, srgb};
use image::codecs::{bmp::BmpDecoder, hdr::HdrDecoder, jpeg::JpegDecoder, png::PngDecoder};
use image::{ColorType, DynamicImage, ImageDecoder, Limits};
use std::io::Cursor;
use std::path::Path;

/// The kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Portable Network Graphics.
    Png,
    /// JPEG.
    Jpeg,
    /// Windows bitmap.
    Bmp,
    /// Radiance RGBE.
    Hdr,
    /// Portable float map.
    Pfm,
    /// OpenEXR.
    Exr,
}

impl Format {
    /// The format of a file that begins with these bytes.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Option<Self> {
        const BEGINNINGS: [(&[u8], Format); 8] = [
            (b"\x89PNG\r\n\x1a\n", Format::Png),
            (b"\xff\xd8\xff", Format::Jpeg),
            (b"BM", Format::Bmp),
            (b"#?RADIANCE", Format::Hdr),
            (b"#?RGBE", Format::Hdr),
            (b"PF", Format::Pfm),
            (b"Pf", Format::Pfm),
            (b"\x76\x2f\x31\x01", Format::Exr),
        ];
        BEGINNINGS
            .iter()
            .find(|(beginning, _)| bytes.starts_with(beginning))
            .map(|&(_, format)| format)
    }
}

impl std::fmt::Display for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::Bmp => "BMP",
            Self::Hdr => "Radiance HDR",
            Self::Pfm => "PFM",
            Self::Exr => "OpenEXR",
        })
    }
}

/// Samples, pixel after pixel, row after row from the top.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// 8-bit integers; 255 stands for 1.
    U8(Vec<u8>),
    /// 16-bit integers; 65,535 stands for 1.
    U16(Vec<u16>),
    /// Floats.
    F32(Vec<f32>),
}

/// A picture of one (grey), two (grey, alpha), three (RGB) or four (RGBA) channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    width: usize,
    height: usize,
    channels: usize,
    samples: Samples,
    format: Format,
}

/// What a file says of itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RasterHeader {
    /// The kind of file.
    pub format: Format,
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Samples per pixel.
    pub channels: usize,
    /// Bits per sample; 32 are floats.
    pub bits: u32,
}

impl Raster {
    pub(crate) fn from_floats(
        width: usize,
        height: usize,
        channels: usize,
        samples: Vec<f32>,
        format: Format,
    ) -> Self {
        Self {
            width,
            height,
            channels,
            samples: Samples::F32(samples),
            format,
        }
    }

    /// Pixels in a row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Samples per pixel, 1 to 4.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Whether the last channel is alpha.
    #[must_use]
    pub fn has_alpha(&self) -> bool {
        self.channels.is_multiple_of(2)
    }

    /// The samples as they were stored.
    #[must_use]
    pub fn samples(&self) -> &Samples {
        &self.samples
    }

    /// The kind of file it came from.
    #[must_use]
    pub fn format(&self) -> Format {
        self.format
    }

    /// Whether the samples are integers, whose colour is by convention encoded as sRGB.
    #[must_use]
    pub fn is_encoded(&self) -> bool {
        !matches!(self.samples, Samples::F32(_))
    }

    /// The samples as floats, integers divided by their greatest value; no transfer function.
    #[must_use]
    pub fn to_floats(&self) -> Vec<f32> {
        match &self.samples {
            Samples::U8(bytes) => bytes.iter().map(|&x| f32::from(x) / 255.0).collect(),
            Samples::U16(words) => words.iter().map(|&x| f32::from(x) / 65535.0).collect(),
            Samples::F32(floats) => floats.clone(),
        }
    }

    /// The samples as linear floats: integer colour decoded from sRGB, alpha and floats as they
    /// are.
    #[must_use]
    pub fn to_linear(&self) -> Vec<f32> {
        let colour =
            |index: usize| !(self.has_alpha() && index % self.channels == self.channels - 1);
        match &self.samples {
            Samples::U8(bytes) => (bytes.iter().enumerate())
                .map(|(i, &x)| {
                    if colour(i) {
                        srgb::decode_u8(x)
                    } else {
                        f32::from(x) / 255.0
                    }
                })
                .collect(),
            Samples::U16(words) => (words.iter().enumerate())
                .map(|(i, &x)| {
                    let x = f32::from(x) / 65535.0;
                    if colour(i) { srgb::decode(x) } else { x }
                })
                .collect(),
            Samples::F32(floats) => floats.clone(),
        }
    }
}

/// Reads a file of any format.
///
/// # Errors
/// [`Error::Read`] where the operating system refuses; otherwise as [`decode`].
pub fn read(path: &Path) -> Result<Raster, Error> {
    let bytes = std::fs::read(path).map_err(|source| Error::read(path, source))?;
    decode(&bytes, path)
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
        foreign => from_foreign(bytes, foreign, path),
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
        foreign => {
            let decoder = decoder(bytes, foreign).map_err(|error| failure(path, error))?;
            let (width, height) = decoder.dimensions();
            let colour = decoder.color_type();
            let channels = usize::from(colour.channel_count());
            let bits = u32::from(colour.bits_per_pixel() / u16::from(colour.channel_count()));
            (width as usize, height as usize, channels, bits)
        }
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
    Format::of(bytes).ok_or_else(|| {
        Error::unsupported(
            path,
            "it is none of PNG, JPEG, BMP, Radiance HDR, PFM and OpenEXR",
        )
    })
}

fn from_exr(bytes: &[u8], path: &Path) -> Result<Raster, Error> {
    let (image, _) = exr::decode(bytes, path)?.flatten();
    let grey = image.channel("Y").is_some() && image.channel("R").is_none();
    let planes: Vec<&[f32]> = match (image.colour(), image.channels()) {
        (Some([grey_plane, ..]), _) if grey => vec![grey_plane],
        (Some(colour), _) => colour.to_vec(),
        (None, [only]) => vec![&only.samples],
        (None, channels) => {
            let names: Vec<_> = channels.iter().map(|c| c.name.as_str()).collect();
            return Err(Error::unsupported(
                path,
                format!(
                    "it has the channels {}; R, G and B, or Y, or a single one are expected",
                    names.join(", ")
                ),
            ));
        }
    };
    let planes: Vec<&[f32]> = planes.into_iter().chain(image.alpha()).collect();
    let pixels = image.width() * image.height();
    let mut samples = Vec::with_capacity(pixels * planes.len());
    for pixel in 0..pixels {
        samples.extend(planes.iter().map(|plane| plane[pixel]));
    }
    Ok(Raster::from_floats(
        image.width(),
        image.height(),
        planes.len(),
        samples,
        Format::Exr,
    ))
}

/// A decoder that refuses images too large for the file.
fn decoder(bytes: &[u8], format: Format) -> image::ImageResult<Box<dyn ImageDecoder + '_>> {
    let mut limits = Limits::default();
    limits.max_alloc = Some((1 << 28).max(1100 * bytes.len() as u64));
    let bytes = Cursor::new(bytes);
    let mut decoder: Box<dyn ImageDecoder> = match format {
        Format::Png => Box::new(PngDecoder::with_limits(bytes, limits.clone())?),
        Format::Jpeg => Box::new(JpegDecoder::new(bytes)?),
        Format::Bmp => Box::new(BmpDecoder::new(bytes)?),
        // Strictly, a file must begin with "#?RADIANCE"; many, Mitsuba's among them, do not.
        _ => Box::new(HdrDecoder::new_nonstrict(bytes)?),
    };
    limits.reserve(decoder.total_bytes())?;
    decoder.set_limits(limits)?;
    Ok(decoder)
}

fn from_foreign(bytes: &[u8], format: Format, path: &Path) -> Result<Raster, Error> {
    if format == Format::Jpeg && !jpeg_ends(bytes) {
        return Err(Error::invalid(path, "the JPEG file ends too early"));
    }
    let decoded = decoder(bytes, format)
        .and_then(DynamicImage::from_decoder)
        .map_err(|error| failure(path, error))?;
    let (width, height) = (decoded.width() as usize, decoded.height() as usize);
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
    Ok(Raster {
        width,
        height,
        channels,
        samples,
        format,
    })
}

/// Whether a JPEG file has the marker that ends its last scan. Its decoder would fill up what is
/// missing with grey.
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
