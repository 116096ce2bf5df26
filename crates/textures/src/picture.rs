//! The texels of an image file, in the type of the file where that has integers.

use crate::coded::{At, Coded};
use crate::palette::Palette;
use crate::pixels::{Image, Pixels, Recent, Texels, Values, mean, mean_colour};
use crate::recalled::{Recalled, is_heavy};
use crate::recovered::luminance;
use etalon_transport::SpectrumKind;
use glam::UVec2;

/// Pixels of a file without alpha.
#[derive(Clone, Debug, PartialEq)]
pub enum FilePixels {
    /// Floats.
    Floats(Values),
    /// 8-bit integers.
    Bytes(Coded<u8>),
    /// 16-bit integers.
    Words(Coded<u16>),
    /// 16-bit floats from 0 to 1.
    Halves(Coded<u16>),
}

/// Texels of an image, with statistics of all of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Columns and rows; neither is zero.
    pub size: UVec2,
    /// The texels.
    pub stored: Stored,
    /// Mean of the numbers or luminances.
    pub mean: f32,
    /// How many texels had components that no reflectance can have, and were moved to the
    /// nearer of 0 and 1.
    pub moved: usize,
}

/// Texels, in the form in which they are looked up.
#[derive(Clone, Debug, PartialEq)]
pub enum Stored {
    /// Floats, and colours of 16 bits in small pictures.
    Floats(Texels),
    /// Numbers of 8 bits.
    Bytes(Coded<u8>),
    /// Numbers of 16 bits.
    Words(Coded<u16>),
    /// Three channels of 8 bits, which are no colour.
    RawBytes(Coded<u8>),
    /// Three channels of 16 bits, which are no colour.
    RawWords(Coded<u16>),
    /// Colours of 8 bits.
    Palette(Palette),
    /// The same in large pictures with too many of them.
    RecalledBytes(Recalled<u8>),
    /// Colours of 16 bits in large pictures.
    RecalledWords(Recalled<u16>),
}

/// Asks texels: of numbers, of three raw channels, of the coefficients of colours, and of coefficients with a factor.
macro_rules! ask {
    ($stored:expr, $number:ident => $a:expr, $raw:ident => $b:expr, $colour:ident => $c:expr, $bright:ident => $d:expr) => {
        match $stored {
            Stored::Floats(Texels::Number($number)) => $a,
            Stored::Bytes($number) => $a,
            Stored::Words($number) => $a,
            Stored::Floats(Texels::Raw($raw)) => $b,
            Stored::RawBytes($raw) => $b,
            Stored::RawWords($raw) => $b,
            Stored::Floats(Texels::Colour($colour)) => $c,
            Stored::Palette($colour) => $c,
            Stored::RecalledBytes($colour) => $c,
            Stored::RecalledWords($colour) => $c,
            Stored::Floats(Texels::Bright($bright)) => $d,
        }
    };
}

pub(crate) use ask;

impl Picture {
    /// Prepares the pixels of a file for look-up, as [`Image::new`] does those of floats.
    pub fn new(size: UVec2, pixels: FilePixels, raw: bool, role: SpectrumKind) -> Self {
        let of_integers = |mean, stored| Self {
            size,
            stored,
            mean,
            moved: 0,
        };
        match pixels {
            FilePixels::Floats(values) => {
                Image::new(Pixels { size, values }, raw, role, false).into()
            }
            FilePixels::Bytes(bytes) => {
                let mean = mean_of(&bytes, size);
                of_integers(
                    mean,
                    match (bytes.channels, raw) {
                        (1, _) => Stored::Bytes(bytes),
                        (_, true) => Stored::RawBytes(bytes),
                        (_, false) => match Palette::new(bytes) {
                            Ok(palette) => Stored::Palette(palette),
                            Err(pixels) => Stored::RecalledBytes(Recalled(pixels)),
                        },
                    },
                )
            }
            FilePixels::Words(words) | FilePixels::Halves(words) => {
                let mean = mean_of(&words, size);
                of_integers(
                    mean,
                    match (words.channels, raw) {
                        (1, _) => Stored::Words(words),
                        (_, true) => Stored::RawWords(words),
                        (_, false) if is_heavy(words.samples.len() / 3, &words) => {
                            Stored::RecalledWords(Recalled(words))
                        }
                        (_, false) => {
                            let mut recent = Recent::new();
                            let texels = texels(size).map(|i| recent.coefficients(words.at(i)));
                            Stored::Floats(Texels::Colour(texels.collect()))
                        }
                    },
                )
            }
        }
    }

    /// Memory of its texels (bytes).
    pub(crate) fn bytes(&self) -> usize {
        match &self.stored {
            Stored::Floats(texels) => texels.bytes(),
            Stored::Bytes(bytes) | Stored::RawBytes(bytes) => bytes.bytes(),
            Stored::Words(words) | Stored::RawWords(words) => words.bytes(),
            Stored::Palette(palette) => palette.bytes(),
            Stored::RecalledBytes(Recalled(bytes)) => bytes.bytes(),
            Stored::RecalledWords(Recalled(words)) => words.bytes(),
        }
    }
}

impl From<Image> for Picture {
    fn from(image: Image) -> Self {
        Self {
            size: image.size,
            stored: Stored::Floats(image.texels),
            mean: image.mean,
            moved: image.moved,
        }
    }
}

/// The indices of texels.
fn texels(size: UVec2) -> impl ExactSizeIterator<Item = usize> {
    0..size.x as usize * size.y as usize
}

fn mean_of<S: Copy + Into<usize>>(coded: &Coded<S>, size: UVec2) -> f32 {
    match coded.channels {
        1 => mean(texels(size).map(|i| coded.at(i))),
        _ => luminance(mean_colour(texels(size).map(|i| coded.at(i)))),
    }
}
