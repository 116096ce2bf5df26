//! The image of an environment map as it is read.

use etalon_images::raster_file;
use glam::UVec2;
use std::path::Path;

/// Linear Rec.709 pixels, row after row from the top.
pub(super) struct Pixels {
    pub(super) size: UVec2,
    pub(super) rgb: Vec<[f32; 3]>,
    /// Number of texels with negative components, which became zero.
    pub(super) negative: usize,
    /// Remarks about the file.
    pub(super) notes: Vec<String>,
}

/// The pixels of the file `filename`; `raw` if its numbers are linear whatever its format, `poles` if a single row reaches from pole to pole.
pub(super) fn decode(
    bytes: &[u8],
    (raw, poles): (bool, bool),
    filename: &str,
) -> Result<Pixels, String> {
    let raster =
        raster_file::decode(bytes, Path::new(filename)).map_err(|error| error.to_string())?;
    let (width, height) = (raster.width(), raster.height());
    let channels = raster.channels();
    let values = match raw {
        true => raster.to_floats(),
        false => raster.to_linear(),
    };
    let mut negative = 0;
    let mut rgb = Vec::with_capacity(width * height);
    for (i, pixel) in values.chunks_exact(channels).enumerate() {
        let colour = if channels < 3 {
            [pixel[0]; 3]
        } else {
            [pixel[0], pixel[1], pixel[2]]
        };
        if colour.iter().any(|c| !c.is_finite()) {
            let (x, y) = (i % width, i / width);
            return Err(format!(
                "the pixel in column {x} of row {y} of `{filename}` is not finite (both counted from 0)"
            ));
        }
        negative += usize::from(colour.iter().any(|&c| c < 0.0));
        rgb.push(colour.map(|c| c.max(0.0)));
    }
    let height = if poles && height == 1 {
        // The same from pole to pole.
        rgb.extend_from_within(..);
        2
    } else {
        height
    };
    Ok(Pixels {
        size: UVec2::new(width as u32, height as u32),
        rgb,
        negative,
        notes: raster.notes(false).map(str::to_owned).collect(),
    })
}
