//! From the bytes of an image file to pixels.

use crate::pixels::{Pixels, Values};
use etalon_images::raster_file;
use glam::UVec2;
use std::path::Path;

/// One channel of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ImageChannel {
    /// Red, green or blue; of a grey image grey.
    Colour(usize),
    /// Alpha.
    Alpha,
}

impl Pixels {
    /// Decodes an image file, whose format is known by its content. Integer samples are taken to
    /// be encoded as sRGB, unless `raw`; floats are linear. Alpha is dropped (not divided by), as
    /// Mitsuba does, unless it is the one `channel` that is wanted. `name` is for messages, which name the file. Beside the
    /// pixels stands what their user should know of the file.
    pub fn decode(
        bytes: &[u8],
        raw: bool,
        channel: Option<ImageChannel>,
        name: &str,
    ) -> Result<(Self, Vec<String>), String> {
        let raster =
            raster_file::decode(bytes, Path::new(name)).map_err(|error| error.to_string())?;
        let size = UVec2::new(raster.width() as u32, raster.height() as u32);
        let samples = if raw {
            raster.to_floats()
        } else {
            raster.to_linear()
        };
        let channels = raster.channels();
        let wanted = match channel {
            None => None,
            Some(ImageChannel::Colour(i)) => Some(if channels < 3 { 0 } else { i }),
            Some(ImageChannel::Alpha) if raster.has_alpha() => Some(channels - 1),
            Some(ImageChannel::Alpha) => return Err(format!("`{name}` has no channel `a`")),
        };
        let notes = raster.notes(raw);
        let notes = notes.map(|note| format!("`{name}`: {note}")).collect();
        drop(raster);
        if size.x == 0 || size.y == 0 {
            return Err(format!("`{name}` is an empty image"));
        }
        if let Some(i) = samples.iter().position(|x| !x.is_finite()) {
            let pixel = (i / channels) as u32;
            let (x, y) = (pixel % size.x, pixel / size.x);
            return Err(format!(
                "the pixel in column {x} of row {y} of `{name}` is not finite (both counted from 0)"
            ));
        }
        let pixels = samples.chunks_exact(channels);
        let values = match (wanted, channels) {
            (Some(wanted), _) => Values::One(pixels.map(|pixel| pixel[wanted]).collect()),
            (None, 1) => Values::One(samples),
            (None, 2) => Values::One(pixels.map(|pixel| pixel[0]).collect()),
            (None, _) => Values::Three(pixels.map(|p| [p[0], p[1], p[2]]).collect()),
        };
        Ok((Self { size, values }, notes))
    }
}
