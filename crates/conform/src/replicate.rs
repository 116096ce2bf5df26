//! What a program answered: a picture as luminances.

use crate::truth::Picture;
use etalon_images::{Chromaticities, exr, raster_file};
use std::path::Path;

/// A picture of one pose with one seed.
#[derive(Clone, Debug, PartialEq)]
pub struct Replicate {
    /// The number of the pose.
    pub pose: u32,
    /// The program's seed.
    pub seed: u32,
    /// The luminance of each pixel, the top row first.
    pub luminance: Vec<f64>,
}

impl Replicate {
    /// Reads the colour of an EXR or PFM of `pixels` rows and columns.
    ///
    /// # Errors
    /// What is wrong with it, in one sentence.
    pub fn read(path: &Path, pixels: u32, pose: u32, seed: u32) -> Result<Self, String> {
        let image = match path.extension().is_some_and(|ending| ending == "pfm") {
            true => raster_file::read(path).map(|raster| raster.to_image()),
            false => exr::read(path).map(|document| document.flatten().0),
        };
        let image = image.map_err(|error| error.to_string())?;
        let size = [image.width(), image.height()];
        if size != [pixels as usize; 2] {
            let [width, height] = size;
            return Err(format!(
                "a picture of {width} × {height} pixels, where {pixels} × {pixels} were asked for"
            ));
        }
        let colour = image
            .needed_colour(path)
            .map_err(|error| error.to_string())?;
        let [r, g, b] = &colour.planes;
        let weights = Chromaticities::REC_709.luminance_weights();
        let luminance: Vec<f64> = (0..r.len())
            .map(|i| {
                let rgb = [r[i], g[i], b[i]].map(f64::from);
                rgb.iter().zip(weights).map(|(c, weight)| c * weight).sum()
            })
            .collect();
        if let Some(index) = luminance.iter().position(|value| !value.is_finite()) {
            let [column, row] = [index % size[0], index / size[0]];
            return Err(format!("pixel ({column}, {row}) is not finite"));
        }
        Ok(Self {
            pose,
            seed,
            luminance,
        })
    }

    /// The mean of all pixels.
    pub fn mean(&self) -> f64 {
        self.luminance.iter().sum::<f64>() / self.luminance.len() as f64
    }

    /// Whether both have the same bits.
    pub fn is_copy_of(&self, other: &Self) -> bool {
        let pairs = self.luminance.iter().zip(&other.luminance);
        pairs.into_iter().all(|(a, b)| a.to_bits() == b.to_bits())
    }
}

/// The mean of pictures of this many rows and columns; `None` of no pictures.
pub fn mean(replicates: &[Replicate], pixels: u32) -> Option<Picture> {
    let count = replicates.len() as f64;
    let mean = |index: usize| replicates.iter().map(|r| r.luminance[index]).sum::<f64>() / count;
    let pixel_count = (pixels * pixels) as usize;
    (!replicates.is_empty()).then(|| Picture::exact(pixels, (0..pixel_count).map(mean).collect()))
}
