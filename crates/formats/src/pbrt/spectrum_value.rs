//! Getters of spectra and textures.

use super::number::excerpt;
use super::parameter::{ColorSpace, Parameter, ParameterType, Values};
use super::parameters::{Parameters, numbers};
use super::scene::{TextureId, TextureKind};
use etalon_params::Diagnostic;

/// A spectrum as it was written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpectrumValue<'a> {
    /// An RGB colour, which may lie outside [0, 1], in a colour space.
    Rgb([f64; 3], ColorSpace),
    /// The temperature of a black body in kelvin.
    Blackbody(f64),
    /// Wavelengths in nanometres, in ascending order, each with its value.
    Samples(&'a [[f64; 2]]),
    /// The name of a spectrum that pbrt knows, or else of a file.
    Named(&'a str),
}

/// A number, or a texture of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FloatOrTexture {
    /// The same everywhere.
    Value(f64),
    /// A float texture.
    Texture(TextureId),
}

/// A spectrum, or a texture of spectra.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpectrumOrTexture<'a> {
    /// The same everywhere.
    Value(SpectrumValue<'a>),
    /// A spectrum texture.
    Texture(TextureId),
}

/// A number, or a spectrum: the index of refraction of a dielectric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FloatOrSpectrum<'a> {
    /// The same at all wavelengths.
    Float(f64),
    /// A spectrum.
    Spectrum(SpectrumValue<'a>),
}

const FLOAT_OR_TEXTURE: [ParameterType; 2] = [ParameterType::Float, ParameterType::Texture];
const SPECTRUM: [ParameterType; 3] = [
    ParameterType::Spectrum,
    ParameterType::Rgb,
    ParameterType::Blackbody,
];
const SPECTRUM_OR_TEXTURE: [ParameterType; 4] = [
    ParameterType::Spectrum,
    ParameterType::Rgb,
    ParameterType::Blackbody,
    ParameterType::Texture,
];
const FLOAT_OR_SPECTRUM: [ParameterType; 4] = [
    ParameterType::Float,
    ParameterType::Spectrum,
    ParameterType::Rgb,
    ParameterType::Blackbody,
];

impl<'a> Parameters<'a> {
    /// A spectrum, if given.
    pub fn spectrum(&self, name: &str) -> Option<SpectrumValue<'a>> {
        let parameter = self.typed(name, &SPECTRUM)?;
        self.spectrum_of(parameter)
    }

    /// A number or a float texture, if given.
    pub fn float_texture(&self, name: &str) -> Option<FloatOrTexture> {
        let parameter = self.typed(name, &FLOAT_OR_TEXTURE)?;
        if parameter.kind == ParameterType::Texture {
            let texture = self.texture_of(parameter, TextureKind::Float);
            return texture.map(FloatOrTexture::Texture);
        }
        let value = self.one(parameter, numbers(parameter));
        value.map(FloatOrTexture::Value)
    }

    /// A spectrum or a spectrum texture, if given.
    pub fn spectrum_texture(&self, name: &str) -> Option<SpectrumOrTexture<'a>> {
        let parameter = self.typed(name, &SPECTRUM_OR_TEXTURE)?;
        if parameter.kind == ParameterType::Texture {
            let texture = self.texture_of(parameter, TextureKind::Spectrum);
            return texture.map(SpectrumOrTexture::Texture);
        }
        self.spectrum_of(parameter).map(SpectrumOrTexture::Value)
    }

    /// A number or a spectrum, if given.
    pub fn float_or_spectrum(&self, name: &str) -> Option<FloatOrSpectrum<'a>> {
        let parameter = self.typed(name, &FLOAT_OR_SPECTRUM)?;
        if parameter.kind == ParameterType::Float {
            let value = self.one(parameter, numbers(parameter));
            return value.map(FloatOrSpectrum::Float);
        }
        self.spectrum_of(parameter).map(FloatOrSpectrum::Spectrum)
    }

    fn spectrum_of(&self, parameter: &'a Parameter) -> Option<SpectrumValue<'a>> {
        let list = numbers(parameter);
        match parameter.kind {
            ParameterType::Rgb => {
                let colour = self.one(parameter, list.as_chunks().0)?;
                Some(SpectrumValue::Rgb(colour, parameter.color_space))
            }
            ParameterType::Blackbody => {
                if let [_, _] = list {
                    let message = "a blackbody is one temperature";
                    let help =
                        "pbrt-v3 had a factor behind it; in pbrt-v4 lights have a `float scale`";
                    let mistake = Diagnostic::error(parameter.span, message).help(help);
                    self.diagnostics.push(mistake);
                    return None;
                }
                let temperature = self.one(parameter, list)?;
                if temperature > 0.0 {
                    return Some(SpectrumValue::Blackbody(temperature));
                }
                self.refuse(&parameter.name, temperature, "temperatures above 0 kelvin");
                None
            }
            _ => match &parameter.values {
                Values::Strings(_) => self.one_string(parameter).map(SpectrumValue::Named),
                _ => self.samples_of(parameter).map(SpectrumValue::Samples),
            },
        }
    }

    fn samples_of(&self, parameter: &'a Parameter) -> Option<&'a [[f64; 2]]> {
        let samples = numbers(parameter).as_chunks::<2>().0;
        if samples.is_empty() {
            self.wrong_count(parameter, 0, "pairs of a wavelength and a value");
            return None;
        }
        let falls = |pair: &&[[f64; 2]]| !(pair[0][0] < pair[1][0]);
        if let Some([[before, _], [after, _]]) = samples.windows(2).find(falls) {
            let message = format!("wavelengths must ascend, but {after} nm follows {before} nm");
            self.error_at(&parameter.name, message);
            return None;
        }
        Some(samples)
    }

    /// The texture that a parameter names. That there is none at all was a mistake when the scene was read.
    fn texture_of(&self, parameter: &'a Parameter, kind: TextureKind) -> Option<TextureId> {
        let name = self.one_string(parameter)?;
        let found = self.scene.texture(kind, name);
        if found.is_none() {
            let other = match kind {
                TextureKind::Float => TextureKind::Spectrum,
                TextureKind::Spectrum => TextureKind::Float,
            };
            if let Some(other) = self.scene.texture(other, name) {
                let texture = &self.scene.textures[other];
                let message = format!(
                    "`{}` of `{}` needs a {} texture, and `{}` is a {} texture",
                    parameter.name,
                    self.entity.kind,
                    kind.name(),
                    excerpt(name),
                    texture.kind.name()
                );
                let mistake = Diagnostic::error(parameter.span, message);
                (self.diagnostics).push(mistake.related(texture.name.span, "defined here"));
            }
        }
        found
    }
}
