//! From the pixels of an image file to texels that can be looked up.

use crate::recovered::luminance;
use etalon_spectrum::{RgbCoefficients, RgbSpectrum};
use etalon_transport::SpectrumKind;
use glam::{DVec3, UVec2, Vec3};

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

/// Texels of an image, with statistics of the whole image.
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

impl Texels {
    /// Their memory (bytes).
    pub(crate) fn bytes(&self) -> usize {
        match self {
            Self::Number(texels) => size_of_val(&texels[..]),
            Self::Raw(texels) | Self::Colour(texels) => size_of_val(&texels[..]),
            Self::Bright(texels) => size_of_val(&texels[..]),
        }
    }
}

impl Image {
    /// Prepares pixels for look-up. With `raw`, three channels are not converted to spectra. Numbers and
    /// colours above 1 are kept if `role` allows them, colours with a spectrum as for a bright `rgb`
    /// value; negative colours never are.
    ///
    /// With `bright`, all colours have a spectrum as for a bright `rgb` value, as those of Mitsuba's volumes do.
    pub fn new(pixels: Pixels, raw: bool, role: SpectrumKind, bright: bool) -> Self {
        let mut moved = 0;
        let (texels, mean) = match pixels.values {
            Values::One(mut values) => {
                if role == SpectrumKind::Reflectance {
                    for value in &mut values {
                        let held = value.clamp(0.0, 1.0);
                        moved += usize::from(held != *value);
                        *value = held;
                    }
                }
                let mean = mean(values.iter().copied());
                (Texels::Number(values), mean)
            }
            Values::Three(values) => {
                let mean = luminance(mean_colour(values.iter().copied()));
                let texels = if raw {
                    Texels::Raw(values)
                } else {
                    let beyond = role != SpectrumKind::Reflectance
                        && values.iter().flatten().any(|&component| component > 1.0);
                    let from = if bright { 0.0 } else { 1.0 };
                    upsample(values, (bright || beyond).then_some(from), &mut moved)
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
pub(crate) fn mean(values: impl ExactSizeIterator<Item = f32>) -> f32 {
    let count = values.len() as f64;
    (values.map(f64::from).sum::<f64>() / count) as f32
}

/// The mean colour, summed in double precision.
pub(crate) fn mean_colour(values: impl ExactSizeIterator<Item = [f32; 3]>) -> Vec3 {
    let count = values.len() as f64;
    let sum = values.fold(DVec3::ZERO, |sum, rgb| {
        sum + Vec3::from_array(rgb).as_dvec3()
    });
    (sum / count).as_vec3()
}

/// Coefficients of colours met lately: the images of the world repeat themselves.
pub(crate) struct Recent {
    /// Colours with their coefficients, each at the place that its hash gives it.
    places: Vec<([f32; 3], [f32; 3])>,
}

impl Recent {
    /// log₂ of the number of places: 96 KiB, which stay in a processor's second cache.
    const BITS: u32 = 12;

    pub(crate) fn new() -> Self {
        let RgbCoefficients(black) = RgbCoefficients::from_rgb([0.0; 3]);
        Self {
            places: vec![([0.0; 3], black); 1 << Self::BITS],
        }
    }

    /// The coefficients of a colour.
    #[inline]
    pub(crate) fn coefficients(&mut self, rgb: [f32; 3]) -> [f32; 3] {
        let [r, g, b] = rgb.map(f32::to_bits);
        // Multiplicative hashing; the multipliers are odd and otherwise arbitrary.
        let mixed = r.wrapping_mul(0x9e37_79b1) ^ g.wrapping_mul(0x85eb_ca77);
        let hash = (mixed ^ b.wrapping_mul(0xc2b2_ae3d)).wrapping_mul(0x27d4_eb2f);
        let place = &mut self.places[(hash >> (32 - Self::BITS)) as usize];
        if place.0 != rgb {
            *place = (rgb, RgbCoefficients::from_rgb(rgb).0);
        }
        place.1
    }
}

/// Spectra of colours; those with a component above `bright` have one with a factor.
fn upsample(values: Vec<[f32; 3]>, bright: Option<f32>, moved: &mut usize) -> Texels {
    let mut recent = Recent::new();
    let mut fit = |rgb: [f32; 3]| recent.coefficients(rgb);
    let mut inside = |rgb: [f32; 3], top: f32| {
        let clamped = rgb.map(|component| component.clamp(0.0, top));
        *moved += usize::from(clamped != rgb);
        clamped
    };
    let Some(bright) = bright else {
        let coefficients = values.into_iter().map(|rgb| fit(inside(rgb, 1.0)));
        return Texels::Colour(coefficients.collect());
    };
    let texels = values.into_iter().map(|rgb| {
        let rgb = inside(rgb, f32::INFINITY);
        if rgb.iter().all(|&component| component <= bright) {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of one channel are held as colours are, unless nothing bounds them.
    #[test]
    fn numbers_follow_their_role() {
        let numbers = |role| {
            let pixels = Pixels {
                size: UVec2::new(3, 1),
                values: Values::One(vec![-1.0, 0.5, 50.0]),
            };
            let image = Image::new(pixels, false, role, false);
            (image.texels, image.moved)
        };
        let held = (Texels::Number(vec![0.0, 0.5, 1.0]), 2);
        assert_eq!(numbers(SpectrumKind::Reflectance), held);
        let free = (Texels::Number(vec![-1.0, 0.5, 50.0]), 0);
        assert_eq!(numbers(SpectrumKind::Unbounded), free);
    }

    /// Repetition and collisions do not change a texel: each is what its colour gives alone.
    #[test]
    fn texels_are_those_of_their_colours() {
        let mut state = 1_u32;
        let mut component = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 27) as f32 / 31.0
        };
        let colours: Vec<[f32; 3]> = (0..20_000)
            .map(|_| [component(), component(), component()])
            .collect();
        let pixels = Pixels {
            size: UVec2::new(20_000, 1),
            values: Values::Three(colours.clone()),
        };
        let image = Image::new(pixels, false, SpectrumKind::Reflectance, false);
        let Texels::Colour(texels) = &image.texels else {
            panic!("colours become coefficients");
        };
        for (colour, texel) in colours.iter().zip(texels) {
            assert_eq!(RgbCoefficients::from_rgb(*colour).0, *texel);
        }
        assert_eq!(image.moved, 0);
        assert!((image.mean - 0.5).abs() < 0.01);
    }
}
