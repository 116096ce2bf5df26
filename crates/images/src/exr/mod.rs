//! OpenEXR: float images with any channels, a crop's place, and one text of our own.
//!
//! Files written here are scan lines of 32-bit floats under lossless ZIP (and of 32-bit whole
//! numbers, where a caller has [`IntegerPlane`]s). Their bytes depend on the
//! content alone: besides what the format demands there is exactly one attribute, [`ATTRIBUTE`],
//! whose text (JSON, by convention) is the caller's, and the image's chromaticities if it has any.
//!
//! Read are scan lines and tiles, every lossless and lossy compression but HTJ2K, 16- and 32-bit
//! floats and 32-bit integers, several parts, and the full resolution of mip maps. Deep and
//! subsampled images are refused.

mod bounds;
mod header;
mod read;
mod write;

use crate::{Frame, Image, colour};

pub use header::{
    Attribute, Header, HeaderChannel, HeaderPart, SampleType, decode_header, read_header,
};
pub use read::{decode, decode_with_integers, read, read_with_integers};
pub use write::{encode, encode_with_integers, write, write_parts, write_with_integers};

/// The name of the attribute that holds the caller's text.
pub const ATTRIBUTE: &str = "etalon";

/// One image of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its name; files of several parts have one for each, files of one may.
    pub name: Option<String>,
    /// Its pixels.
    pub image: Image,
    /// Column and row of its upper left pixel in the whole picture.
    pub offset: [i32; 2],
}

/// A channel of whole numbers, which floats could not hold.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IntegerPlane {
    /// Its name.
    pub name: String,
    /// Its numbers, row after row.
    pub samples: Vec<u32>,
}

/// The content of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Document {
    /// The images, at least one.
    pub parts: Vec<Part>,
    /// Width and height of the whole picture.
    pub size: [usize; 2],
    /// The text of the attribute [`ATTRIBUTE`]; empty if there is none.
    pub text: String,
}

impl Document {
    /// The channels of all parts as one image, and its place.
    ///
    /// Channels of the part with the picture's colour (by the order of [`crate::colour`]; else the
    /// first) keep their names; those of another part called `name` become `name.channel`. Parts
    /// of another size or place than that are left out, as are channels whose name is already
    /// taken.
    #[must_use]
    pub fn flatten(self) -> (Image, Frame) {
        let mut parts = self.parts;
        let likeliest = (0..parts.len()).min_by_key(|&part| colour::rank(&parts[part].image));
        let first = parts.remove(likeliest.expect("a document has at least one part"));
        let frame = Frame {
            offset: first.offset,
            size: self.size,
        };
        let mut whole = first.image;
        for part in parts {
            let same_place = part.offset == first.offset
                && part.image.width() == whole.width()
                && part.image.height() == whole.height();
            if !same_place {
                continue;
            }
            for channel in part.image.into_channels() {
                let name = match &part.name {
                    // Some programs repeat the part's name in those of its channels.
                    Some(part) if !channel.name.starts_with(&format!("{part}.")) => {
                        format!("{part}.{}", channel.name)
                    }
                    _ => channel.name,
                };
                if whole.channel(&name).is_none() {
                    whole.push(name, channel.samples);
                }
            }
        }
        (whole, frame)
    }
}
