//! The same spectrum everywhere.

use crate::reader::Use;
use crate::texture::TextureModel;
use crate::{Texture, TextureReader, TextureTable};
use etalon_params::{Params, Value};
use etalon_spectrum::{RgbSpectrum, Spectrum, SpectrumSummary, colour_space};
use etalon_transport::{Shapes, SpectrumKind, TexturePoint};
use glam::Vec3;
use glam::{DVec3, Vec4};

/// A spectrum with everything that others ask of a texture worked out in advance.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant {
    /// The spectrum.
    pub spectrum: Spectrum,
    /// Its value as a number: itself if uniform, the mean over the wavelengths if it came from a
    /// colour (as in Mitsuba), otherwise the luminance of that reflectance under D65.
    pub number: f32,
    /// Mean over 360–830 nm.
    pub mean: f32,
    /// Linear Rec.709 as a reflectance under D65.
    pub colour: Vec3,
    /// The smallest and the largest value at any wavelength.
    range: [f32; 2],
}

impl Constant {
    /// A spectrum.
    pub fn new(spectrum: Spectrum) -> Self {
        let SpectrumSummary {
            mean,
            rgb_under_d65: rgb,
            range,
        } = match &spectrum {
            Spectrum::Uniform(value) => {
                let value = f64::from(*value);
                SpectrumSummary {
                    mean: value,
                    rgb_under_d65: [value; 3],
                    range: [value; 2],
                }
            }
            _ => spectrum.summary(),
        };
        let number = match &spectrum {
            Spectrum::Uniform(_) | Spectrum::Srgb(_) => mean,
            _ => colour_space::luminance(rgb),
        };
        Self {
            number: number as f32,
            mean: mean as f32,
            colour: Vec3::from_array(rgb.map(|x| x as f32)),
            range: range.map(|x| x as f32),
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
            range: [value; 2],
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

impl TextureModel for Constant {
    const VARIES: bool = false;

    #[inline]
    fn spectrum(&self, _: &TextureTable, _: &impl Shapes, _: &TexturePoint, lambda: Vec4) -> Vec4 {
        self.spectrum.eval(lambda)
    }

    #[inline]
    fn number(&self, _: &TextureTable, _: &impl Shapes, _: &TexturePoint) -> f32 {
        self.number
    }

    #[inline]
    fn colour(&self, _: &TextureTable, _: &impl Shapes, _: &TexturePoint) -> Vec3 {
        self.colour
    }

    fn mean(&self, _: &TextureTable) -> f32 {
        self.mean
    }

    fn is_constant(&self, _: &TextureTable) -> bool {
        true
    }

    fn most_within(&self, _: &TextureTable, _: Vec3, _: Vec3) -> f32 {
        self.range[1]
    }

    fn least_within(&self, _: &TextureTable, _: Vec3, _: Vec3) -> f32 {
        self.range[0]
    }

    fn instead_in_space(&self) -> Option<&'static str> {
        None
    }
}

/// `constvolume`: the spectrum in `value` (1), everywhere in space.
pub(crate) fn read_volume(
    reader: &mut TextureReader<'_>,
    params: &Params<'_>,
    purpose: Use,
) -> Option<Texture> {
    let id = reader.parameter_in(params, "value", Some(1.0), purpose);
    Some(reader.set.get(id).clone())
}

/// `rawconstant`: a number or three as they are; a reflectance is held to 1 all the same.
pub(crate) fn read(
    reader: &mut TextureReader<'_>,
    params: &Params<'_>,
    purpose: Use,
) -> Option<Texture> {
    let Some(property) = params.property("value") else {
        params.missing("value", "a number or three");
        return None;
    };
    let values = match &property.value {
        Value::Float(x) if x.is_finite() => DVec3::splat(*x),
        Value::Integer(i) => DVec3::splat(*i as f64),
        Value::Vector(v) | Value::Rgb(v) if v.is_finite() => *v,
        other => {
            let kind = other.kind();
            params.error_at(
                "value",
                format!("`value` must be a finite number or three, not {kind}"),
            );
            return None;
        }
    };
    let values = if purpose.role == SpectrumKind::Reflectance && values.max_element() > 1.0 {
        reader.note_held(property.span);
        values.min(DVec3::ONE)
    } else {
        values
    };
    Some(Texture::Constant(match &property.value {
        Value::Float(_) | Value::Integer(_) => Constant::uniform(values.x as f32),
        _ => Constant::raw(values.as_vec3()),
    }))
}
