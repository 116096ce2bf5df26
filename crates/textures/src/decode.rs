//! From the bytes of an image file to pixels: OpenEXR.

use crate::pixels::{Pixels, Values};
use etalon_images::{Image, exr};
use glam::UVec2;
use std::path::Path;

/// The first bytes of every OpenEXR file.
const EXR: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

impl Pixels {
    /// Decodes an image file, whose format is known by its content. Alpha is dropped (not
    /// divided by). With `raw`, sRGB encoding is not undone.
    pub fn decode(bytes: &[u8], _raw: bool, name: &Path) -> Result<Self, String> {
        if !bytes.starts_with(&EXR) {
            return Err("the format of this image is not known".into());
        }
        let document = exr::decode(bytes, name).map_err(|error| error.to_string())?;
        let (image, _) = document.flatten();
        Self::from_image(&image)
    }

    /// The colour channels of a picture of floats.
    fn from_image(image: &Image) -> Result<Self, String> {
        let [r, g, b] = image
            .colour()
            .ok_or("there are no channels R, G, B or Y in it")?;
        let size = UVec2::new(image.width() as u32, image.height() as u32);
        let values = if std::ptr::eq(r, g) {
            Values::One(r.to_vec())
        } else {
            let rgb = r.iter().zip(g).zip(b).map(|((&r, &g), &b)| [r, g, b]);
            Values::Three(rgb.collect())
        };
        Self::checked(size, values)
    }

    /// Refuses empty images and values that are not finite.
    fn checked(size: UVec2, values: Values) -> Result<Self, String> {
        if size.x == 0 || size.y == 0 {
            return Err("the image is empty".into());
        }
        let bad = match &values {
            Values::One(values) => values.iter().position(|x| !x.is_finite()),
            Values::Three(values) => values
                .iter()
                .position(|rgb| rgb.iter().any(|x| !x.is_finite())),
        };
        match bad {
            None => Ok(Self { size, values }),
            Some(i) => {
                let (x, y) = (i as u32 % size.x, i as u32 / size.x);
                Err(format!(
                    "the pixel in column {x} of row {y} is not finite (both counted from 0)"
                ))
            }
        }
    }
}
