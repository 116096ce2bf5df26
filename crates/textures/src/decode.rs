//! From an image file to pixels.

use crate::coded::Coded;
use crate::picture::FilePixels;
use crate::pixels::Values;
use etalon_images::{Samples, halves, raster_file, srgb};
use etalon_transport::OpenFile;
use glam::UVec2;
use std::ops::Range;
use std::path::Path;

/// One channel of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ImageChannel {
    /// Red, green or blue; of a grey image grey.
    Colour(usize),
    /// Alpha.
    Alpha,
}

impl FilePixels {
    /// Decodes an open image file, whose format is known by its content, to its size and pixels. Integer samples are taken to
    /// be encoded as sRGB, unless `raw`; floats are linear. Alpha is dropped (not divided by), as
    /// Mitsuba does, unless it is the one `channel` that is wanted. `name` is for messages, which name the file. Beside the
    /// pixels stands what their user should know of the file.
    pub fn decode(
        file: &mut dyn OpenFile,
        raw: bool,
        channel: Option<ImageChannel>,
        name: &str,
    ) -> Result<(UVec2, Self, Vec<String>), String> {
        let raster =
            raster_file::decode_from(file, Path::new(name)).map_err(|error| error.to_string())?;
        let size = UVec2::new(raster.width() as u32, raster.height() as u32);
        let channels = raster.channels();
        let wanted = match channel {
            None => None,
            Some(ImageChannel::Colour(i)) => Some(if channels < 3 { 0 } else { i }),
            Some(ImageChannel::Alpha) if raster.has_alpha() => Some(channels - 1),
            Some(ImageChannel::Alpha) => return Err(format!("`{name}` has no channel `a`")),
        };
        let notes = raster.notes(raw);
        let notes = notes.map(|note| format!("`{name}`: {note}")).collect();
        if size.x == 0 || size.y == 0 {
            return Err(format!("`{name}` is an empty image"));
        }
        let kept = match wanted {
            Some(channel) => channel..channel + 1,
            None => 0..if channels < 3 { 1 } else { 3 },
        };
        let encoded = !raw && channel != Some(ImageChannel::Alpha);
        let pixels = match raster.into_samples() {
            Samples::U8(samples) => Self::Bytes(Coded {
                channels: kept.len(),
                samples: of_channels(samples, channels, kept),
                values: srgb::values_of_8_bits(encoded),
            }),
            Samples::U16(samples) => Self::Words(Coded {
                channels: kept.len(),
                samples: of_channels(samples, channels, kept),
                values: srgb::values_of_16_bits(encoded),
            }),
            Samples::F16(samples) if samples.iter().all(is_share) => Self::Halves(Coded {
                channels: kept.len(),
                samples: of_channels(samples, channels, kept),
                values: halves::values(),
            }),
            Samples::F16(samples) => {
                let floats = samples
                    .iter()
                    .map(|&bits| halves::values()[usize::from(bits)]);
                Self::of_floats(floats.collect(), (size, channels, kept), name)?
            }
            Samples::F32(samples) => Self::of_floats(samples, (size, channels, kept), name)?,
        };
        Ok((size, pixels, notes))
    }

    /// The `kept` ones of floats of this many channels.
    fn of_floats(
        samples: Vec<f32>,
        (size, channels, kept): (UVec2, usize, Range<usize>),
        name: &str,
    ) -> Result<Self, String> {
        if let Some(i) = samples.iter().position(|x| !x.is_finite()) {
            let pixel = (i / channels) as u32;
            let (x, y) = (pixel % size.x, pixel / size.x);
            return Err(format!(
                "the pixel in column {x} of row {y} of `{name}` is not finite (both counted from 0)"
            ));
        }
        let pixels = samples.chunks_exact(channels);
        Ok(Self::Floats(match kept.len() {
            1 => Values::One(of_channels(samples, channels, kept)),
            _ => Values::Three(pixels.map(|p| [p[0], p[1], p[2]]).collect()),
        }))
    }
}

/// Whether a half is a number in [0, 1], which all textures may have.
fn is_share(bits: &u16) -> bool {
    (0.0..=1.0).contains(&halves::values()[usize::from(*bits)])
}

/// Some neighbouring channels of each pixel, in the memory of all of them.
fn of_channels<S: Copy>(mut samples: Vec<S>, channels: usize, kept: Range<usize>) -> Vec<S> {
    if kept.len() == channels {
        return samples;
    }
    let pixels = samples.len() / channels;
    for pixel in 0..pixels {
        let from = pixel * channels;
        samples.copy_within(from + kept.start..from + kept.end, pixel * kept.len());
    }
    samples.truncate(pixels * kept.len());
    samples.shrink_to_fit();
    samples
}
