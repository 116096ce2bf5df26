//! Pictures that the mapping itself must look into: those of lights with a given power or illuminance, and those that are numbers.

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

/// What a picture is as a number, to pbrt (`util/mipmap.cpp`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Number {
    /// Its only channel, or any of the three that are the same.
    Grey,
    /// Its opacity, if it is not opaque everywhere.
    Alpha,
    /// The mean of red, green and blue.
    Mean,
}

/// The luminance of a colour in linear Rec. 709.
pub(crate) fn luminance(rgb: [f32; 3]) -> f64 {
    let [r, g, b] = rgb.map(f64::from);
    0.212_671 * r + 0.715_160 * g + 0.072_169 * b
}

impl Mapper<'_> {
    /// What a picture is as a number. Of a file that cannot be read the texture itself complains.
    pub(crate) fn number_in(&self, filename: &str) -> Number {
        let read = || {
            let path = self.scene.search.find(filename)?;
            let bytes = crate::read_bounded(&path, MOST_BYTES).ok()?;
            raster_file::decode(&bytes, &path).ok()
        };
        let Some(raster) = read() else {
            return Number::Grey;
        };
        let values = raster.to_linear();
        let mut pixels = values.chunks_exact(raster.channels());
        let is_clear = |pixel: &[f32]| pixel.last().is_some_and(|alpha| *alpha != 1.0);
        if raster.has_alpha() && pixels.clone().any(is_clear) {
            return Number::Alpha;
        }
        let is_grey = |pixel: &[f32]| match *pixel {
            [r, g, b, ..] => r == g && g == b,
            _ => true,
        };
        if pixels.all(is_grey) {
            Number::Grey
        } else {
            Number::Mean
        }
    }

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
