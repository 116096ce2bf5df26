//! Pictures with their samples as stored, for textures.

use crate::{Format, Image, halves, srgb};

/// Samples, pixel after pixel, row after row from the top.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// 8-bit integers; 255 is 1.
    U8(Vec<u8>),
    /// 16-bit integers; 65,535 is 1.
    U16(Vec<u16>),
    /// 16-bit floats, by their bits.
    F16(Vec<u16>),
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
    notes: Vec<String>,
    encoding: Option<String>,
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
    pub(crate) fn new(
        [width, height]: [usize; 2],
        channels: usize,
        samples: Samples,
        format: Format,
    ) -> Self {
        Self {
            width,
            height,
            channels,
            samples,
            format,
            notes: Vec::new(),
            encoding: None,
        }
    }

    /// With notes for [`Raster::notes`], and one on the encoding.
    pub(crate) fn noting(mut self, notes: Vec<String>, encoding: Option<String>) -> Self {
        self.notes = notes;
        self.encoding = encoding;
        self
    }

    /// Remarks about the file, each a sentence about "it". Those on the encoding of integers are left
    /// out if these are used as they are (`raw`).
    pub fn notes(&self, raw: bool) -> impl Iterator<Item = &str> {
        let encoding = self.encoding.as_deref().filter(|_| !raw);
        self.notes.iter().map(String::as_str).chain(encoding)
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

    /// The samples as they were stored, without the picture.
    #[must_use]
    pub fn into_samples(self) -> Samples {
        self.samples
    }

    /// The kind of file it came from.
    #[must_use]
    pub fn format(&self) -> Format {
        self.format
    }

    /// Whether the samples are integers, whose colour is by convention encoded as sRGB.
    #[must_use]
    pub fn is_encoded(&self) -> bool {
        matches!(self.samples, Samples::U8(_) | Samples::U16(_))
    }

    /// The samples as floats, integers divided by their greatest value; no transfer function.
    #[must_use]
    pub fn to_floats(&self) -> Vec<f32> {
        match &self.samples {
            Samples::U8(bytes) => bytes.iter().map(|&x| f32::from(x) / 255.0).collect(),
            Samples::U16(words) => words.iter().map(|&x| f32::from(x) / 65535.0).collect(),
            Samples::F16(halves) => halves::to_floats(halves),
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
            Samples::F16(halves) => halves::to_floats(halves),
            Samples::F32(floats) => floats.clone(),
        }
    }
}

impl Raster {
    /// The picture as planes of linear floats, by the usual names. Alpha of integer formats is
    /// not multiplied into their colour, that of images is: so it is here.
    #[must_use]
    pub fn to_image(&self) -> Image {
        let names: &[&str] = match self.channels {
            1 => &["Y"],
            2 => &["Y", "A"],
            3 => &["R", "G", "B"],
            _ => &["R", "G", "B", "A"],
        };
        let mut values = self.to_linear();
        if self.has_alpha() && self.is_encoded() {
            for pixel in values.chunks_exact_mut(self.channels) {
                let (alpha, colour) = pixel.split_last_mut().expect("two samples at least");
                colour.iter_mut().for_each(|x| *x *= *alpha);
            }
        }
        let mut image = Image::new(self.width, self.height);
        for (index, name) in names.iter().enumerate() {
            let plane = values.iter().skip(index).step_by(names.len()).copied();
            image.push(*name, plane.collect());
        }
        image
    }
}
