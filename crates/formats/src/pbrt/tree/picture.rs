//! Pictures that the mapping itself must look into: those of lights with a given power or illuminance.

use super::super::parameters::Parameters;
use super::Mapper;
use etalon_images::raster_file;
use etalon_params::Diagnostic;

/// The largest file that is taken for a picture.
const MOST_BYTES: u64 = 16 << 30;

/// A picture in linear Rec. 709.
pub(crate) struct Picture {
    /// Pixels in a row.
    pub(crate) width: usize,
    /// Row by row from the top.
    pub(crate) rgb: Vec<[f32; 3]>,
}

impl Picture {
    /// The mean of a number of each pixel.
    pub(crate) fn mean(&self, of: impl Fn([f32; 3]) -> f64) -> f64 {
        let sum: f64 = self.rgb.iter().map(|&rgb| of(rgb)).sum();
        sum / self.rgb.len() as f64
    }
}

/// The luminance of a colour in linear Rec. 709.
pub(crate) fn luminance(rgb: [f32; 3]) -> f64 {
    let [r, g, b] = rgb.map(f64::from);
    0.212_671 * r + 0.715_160 * g + 0.072_169 * b
}

impl Mapper<'_> {
    /// The picture in the file that the parameter `filename` names; `None` after a mistake.
    pub(crate) fn picture(&self, params: &Parameters<'_>, filename: &str) -> Option<Picture> {
        let search = &self.scene.search;
        let Some(path) = search.find(filename) else {
            let message = format!("the file `{filename}` was not found");
            let mistake = Diagnostic::error(params.span("filename"), message);
            self.diagnostics
                .push(mistake.help(search.why_not(filename)));
            return None;
        };
        let raster = crate::read_bounded(&path, MOST_BYTES)
            .and_then(|bytes| raster_file::decode(&bytes, &path).map_err(|e| e.to_string()));
        let refused = |reason: &String| {
            params.error_at("filename", format!("cannot read `{filename}`: {reason}"));
        };
        let raster = raster.inspect_err(refused).ok()?;
        let pixel = |pixel: &[f32]| match *pixel {
            [r, g, b, ..] => [r, g, b],
            _ => [pixel[0]; 3],
        };
        let values = raster.to_linear();
        let pixels = values.chunks_exact(raster.channels());
        Some(Picture {
            width: raster.width(),
            rgb: pixels.map(pixel).collect(),
        })
    }
}
