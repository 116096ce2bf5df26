//! The same spectrum everywhere.

use etalon_spectrum::{RgbSpectrum, Spectrum, colour_space};
use glam::Vec3;

/// A spectrum with everything that others ask of a texture worked out in advance.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant {
    /// The spectrum.
    pub spectrum: Spectrum,
    /// What it is as a number: itself if uniform, its mean over the wavelengths if it came from
    /// a colour (as Mitsuba has it), its luminance as a reflectance under D65 otherwise.
    pub number: f32,
    /// Mean over 360–830 nm.
    pub mean: f32,
    /// Linear Rec.709 as a reflectance under D65.
    pub colour: Vec3,
}

impl Constant {
    /// A spectrum.
    pub fn new(spectrum: Spectrum) -> Self {
        let rgb = match &spectrum {
            Spectrum::Uniform(value) => [f64::from(*value); 3],
            _ => spectrum.rgb_under_d65(),
        };
        let mean = match &spectrum {
            Spectrum::Uniform(value) => f64::from(*value),
            _ => spectrum.mean(),
        };
        let number = match &spectrum {
            Spectrum::Uniform(_) | Spectrum::Srgb(_) => mean,
            _ => colour_space::luminance(rgb),
        };
        Self {
            number: number as f32,
            mean: mean as f32,
            colour: Vec3::from_array(rgb.map(|x| x as f32)),
            spectrum,
        }
    }

    /// The same value at all wavelengths.
    pub fn uniform(value: f32) -> Self {
        Self {
            spectrum: Spectrum::Uniform(value),
            number: value,
            mean: value,
            colour: Vec3::splat(value),
        }
    }

    /// Three raw channels. As a spectrum it is the colour they name, as a number its luminance.
    pub fn raw(colour: Vec3) -> Self {
        let rgb = colour.max(Vec3::ZERO).to_array().map(f64::from);
        let spectrum = RgbSpectrum::unbounded(rgb).map_or(Spectrum::Uniform(0.0), Spectrum::Srgb);
        Self {
            number: colour_space::luminance(colour.to_array().map(f64::from)) as f32,
            colour,
            ..Self::new(spectrum)
        }
    }
}
