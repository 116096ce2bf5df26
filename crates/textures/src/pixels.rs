//! From the pixels of an image file to texels that can be looked up.

use crate::recovered::luminance;
use etalon_spectrum::{RgbCoefficients, RgbSpectrum};
use etalon_transport::Role;
use glam::{UVec2, Vec3};

/// Linear (or raw) pixels without alpha, row after row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Pixels {
    /// Columns and rows; neither is zero.
    pub size: UVec2,
    /// Their values.
    pub values: Values,
}

/// One channel or three.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Grey.
    One(Vec<f32>),
    /// Linear Rec.709, or raw channels.
    Three(Vec<[f32; 3]>),
}

/// Texels in the form in which they are looked up.
#[derive(Clone, Debug, PartialEq)]
pub enum Texels {
    /// Numbers.
    Number(Vec<f32>),
    /// Three channels as stored in the file.
    Raw(Vec<[f32; 3]>),
    /// Coefficients of the spectra of colours in [0, 1].
    Colour(Vec<[f32; 3]>),
    /// The same with a factor, for images with colours beyond 1 where that makes sense.
    Bright(Vec<[f32; 4]>),
}

/// Texels of an image, with what is known of the whole of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Columns and rows.
    pub size: UVec2,
    /// The texels.
    pub texels: Texels,
    /// Mean of the numbers or luminances.
    pub mean: f32,
    /// How many texels had components that no reflectance can have, and were moved to the
    /// nearer of 0 and 1.
    pub moved: usize,
}

impl Image {
    /// Prepares pixels for lookup. With `raw`, three channels stay what they are. Colours beyond
    /// 1 are kept if `role` allows them, with a spectrum as for a bright `rgb` value; negative
    /// ones never.
    pub fn new(pixels: Pixels, raw: bool, role: Role) -> Self {
        let mut moved = 0;
        let (texels, mean) = match pixels.values {
            Values::One(values) => {
                let mean = mean(values.iter().copied());
                (Texels::Number(values), mean)
            }
            Values::Three(values) => {
                let mean = mean(values.iter().map(|&rgb| luminance(Vec3::from_array(rgb))));
                let texels = if raw {
                    Texels::Raw(values)
                } else {
                    let bright = role != Role::Reflectance
                        && values.iter().flatten().any(|&component| component > 1.0);
                    upsample(values, bright, &mut moved)
                };
                (texels, mean)
            }
        };
        Self {
            size: pixels.size,
            texels,
            mean,
            moved,
        }
    }
}

/// The mean, summed in double precision.
fn mean(values: impl ExactSizeIterator<Item = f32>) -> f32 {
    let count = values.len() as f64;
    (values.map(f64::from).sum::<f64>() / count) as f32
}

/// Spectra of colours, each run of equal colours fitted once.
fn upsample(values: Vec<[f32; 3]>, bright: bool, moved: &mut usize) -> Texels {
    let mut last = None;
    let mut fit = |rgb: [f32; 3]| match last {
        Some((colour, coefficients)) if colour == rgb => coefficients,
        _ => {
            let RgbCoefficients(coefficients) = RgbCoefficients::from_rgb(rgb);
            last = Some((rgb, coefficients));
            coefficients
        }
    };
    let mut inside = |rgb: [f32; 3], top: f32| {
        let clamped = rgb.map(|component| component.clamp(0.0, top));
        *moved += usize::from(clamped != rgb);
        clamped
    };
    if !bright {
        let coefficients = values.into_iter().map(|rgb| fit(inside(rgb, 1.0)));
        return Texels::Colour(coefficients.collect());
    }
    let texels = values.into_iter().map(|rgb| {
        let rgb = inside(rgb, f32::INFINITY);
        if rgb.iter().all(|&component| component <= 1.0) {
            let [a, b, c] = fit(rgb);
            return [a, b, c, 1.0];
        }
        // Refused only if not finite or negative, and neither is left.
        match RgbSpectrum::unbounded(rgb.map(f64::from)) {
            Ok(spectrum) => {
                let RgbCoefficients([a, b, c]) = spectrum.coefficients();
                [a, b, c, spectrum.scale()]
            }
            Err(_) => [0.0; 4],
        }
    });
    Texels::Bright(texels.collect())
}
