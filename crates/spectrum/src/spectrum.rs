//! One type for every spectrum a scene can name, evaluated at the four wavelengths of a path.

use crate::half_nanometres::HalfNanometres;
use crate::{Blackbody, Irregular, Regular, RgbSpectrum, SpectrumError, colour_space, error};
use crate::{LAMBDA_MAX, LAMBDA_MIN, illuminants};
use glam::Vec4;
use std::sync::Arc;

/// A function of the wavelength: a reflectance, an emission, an extinction, an index.
///
/// Cloning is cheap; tables are shared.
#[derive(Clone, Debug, PartialEq)]
pub enum Spectrum {
    /// The same value at every wavelength.
    Uniform(f32),
    /// Values at equally spaced wavelengths.
    Regular(Arc<Regular>),
    /// Values at any wavelengths.
    Irregular(Arc<Irregular>),
    /// The emission of a black body.
    Blackbody(Arc<Blackbody>),
    /// The smooth spectrum of an RGB colour.
    Srgb(RgbSpectrum),
    /// D65 (scaled to Y = 1) times the smooth spectrum of an RGB colour.
    D65(RgbSpectrum),
}

impl Spectrum {
    /// The constant `value`.
    pub fn uniform(value: f64) -> Result<Self, SpectrumError> {
        Ok(Self::Uniform(error::finite("a spectrum", value)? as f32))
    }

    /// `values` at wavelengths equally spaced from `min` to `max` nm, zero outside.
    pub fn regular(min: f64, max: f64, values: &[f64]) -> Result<Self, SpectrumError> {
        Ok(Self::Regular(Arc::new(Regular::new(min, max, values)?)))
    }

    /// `values` at strictly increasing `wavelengths` (nm), zero outside.
    pub fn irregular(wavelengths: &[f64], values: &[f64]) -> Result<Self, SpectrumError> {
        Ok(Self::Irregular(Arc::new(Irregular::new(
            wavelengths,
            values,
        )?)))
    }

    /// `values` at `wavelengths` (nm): [`Spectrum::Regular`] if they are equally spaced to within
    /// a part in a million of the range, else [`Spectrum::Irregular`].
    pub fn tabulated(wavelengths: &[f64], values: &[f64]) -> Result<Self, SpectrumError> {
        let irregular = Irregular::new(wavelengths, values)?;
        let (min, max) = (wavelengths[0], wavelengths[wavelengths.len() - 1]);
        let step = (max - min) / (wavelengths.len() - 1) as f64;
        let equally_spaced = wavelengths
            .iter()
            .enumerate()
            .all(|(i, l)| (l - (min + step * i as f64)).abs() <= 1e-6 * (max - min));
        if equally_spaced {
            Self::regular(min, max, values)
        } else {
            Ok(Self::Irregular(Arc::new(irregular)))
        }
    }

    /// The emission of a black body of `temperature` K between 360 and 830 nm,
    /// W·m⁻²·sr⁻¹·nm⁻¹.
    pub fn blackbody(temperature: f64) -> Result<Self, SpectrumError> {
        Ok(Self::Blackbody(Arc::new(Blackbody::new(temperature)?)))
    }

    /// A reflectance of the linear Rec. 709 colour `rgb`, components in [0, 1].
    pub fn reflectance(rgb: [f64; 3]) -> Result<Self, SpectrumError> {
        Ok(Self::Srgb(RgbSpectrum::bounded(rgb)?))
    }

    /// A smooth spectrum of the linear Rec. 709 colour `rgb`, components 0 or more.
    pub fn unbounded(rgb: [f64; 3]) -> Result<Self, SpectrumError> {
        Ok(Self::Srgb(RgbSpectrum::unbounded(rgb)?))
    }

    /// An emission of the linear Rec. 709 colour `rgb`, components 0 or more: D65 times
    /// [`Spectrum::unbounded`].
    pub fn emission(rgb: [f64; 3]) -> Result<Self, SpectrumError> {
        Ok(Self::D65(RgbSpectrum::unbounded(rgb)?))
    }

    /// D65 times `scale` (finite), white with luminance `scale`.
    pub fn d65(scale: f64) -> Result<Self, SpectrumError> {
        error::finite("the scale of D65", scale)?;
        Ok(Self::D65(RgbSpectrum::WHITE.scaled(scale as f32)))
    }

    /// Values at four wavelengths in nm.
    #[inline]
    pub fn eval(&self, lambda: Vec4) -> Vec4 {
        match self {
            Self::Uniform(value) => Vec4::splat(*value),
            Self::Regular(table) => table.eval(lambda),
            Self::Irregular(table) => table.eval(lambda),
            Self::Blackbody(body) => body.eval(lambda),
            Self::Srgb(colour) => colour.eval(lambda),
            Self::D65(colour) => illuminants::white().eval(lambda) * colour.eval(lambda),
        }
    }

    /// Value at `lambda` nm, in the precision of [`Spectrum::eval`].
    pub fn eval_at(&self, lambda: f64) -> f64 {
        f64::from(self.eval(Vec4::splat(lambda as f32)).x)
    }

    /// The same spectrum times `factor`.
    pub fn scaled(&self, factor: f32) -> Self {
        match self {
            Self::Uniform(value) => Self::Uniform(value * factor),
            Self::Regular(table) => Self::Regular(Arc::new((**table).clone().scaled(factor))),
            Self::Irregular(table) => Self::Irregular(Arc::new((**table).clone().scaled(factor))),
            Self::Blackbody(body) => Self::Regular(Arc::new(body.table().clone().scaled(factor))),
            Self::Srgb(colour) => Self::Srgb(colour.scaled(factor)),
            Self::D65(colour) => Self::D65(colour.scaled(factor)),
        }
    }

    /// The same spectrum with every number it was made of held to `top` or below; of the spectrum
    /// of a colour, its value at every nanometre.
    pub fn held_to(&self, top: f32) -> Self {
        match self {
            Self::Uniform(value) => Self::Uniform(value.min(top)),
            Self::Regular(table) => Self::Regular(Arc::new((**table).clone().held_to(top))),
            Self::Irregular(table) => Self::Irregular(Arc::new((**table).clone().held_to(top))),
            Self::Blackbody(body) => Self::Regular(Arc::new(body.table().clone().held_to(top))),
            Self::Srgb(_) | Self::D65(_) => {
                let values = (LAMBDA_MIN as i32..=LAMBDA_MAX as i32)
                    .map(|nm| self.eval_at(f64::from(nm)).min(f64::from(top)));
                let values: Vec<f64> = values.collect();
                // Refused only if a value is not finite, and a spectrum has none such.
                Self::regular(LAMBDA_MIN, LAMBDA_MAX, &values).unwrap_or(Self::Uniform(top))
            }
        }
    }

    /// The mean value over 360–830 nm.
    pub fn mean(&self) -> f64 {
        self.power() / (LAMBDA_MAX - LAMBDA_MIN)
    }

    /// ∫ dλ over 360–830 nm, by the trapezoidal rule at 0.5 nm.
    pub fn power(&self) -> f64 {
        HalfNanometres::new(self).power()
    }

    /// Tristimulus value (X, Y, Z), for the spectrum as a radiance.
    pub fn xyz(&self) -> [f64; 3] {
        HalfNanometres::new(self).xyz()
    }

    /// Luminance Y, for the spectrum as a radiance: 1 for D65.
    pub fn luminance(&self) -> f64 {
        self.xyz()[1]
    }

    /// Linear Rec. 709, for the spectrum as a radiance: (1, 1, 1) for D65.
    pub fn rgb(&self) -> [f64; 3] {
        colour_space::xyz_to_rgb(self.xyz())
    }

    /// Linear Rec. 709, for the spectrum as a reflectance lit by D65: (1, 1, 1) for the constant 1.
    pub fn rgb_under_d65(&self) -> [f64; 3] {
        HalfNanometres::new(self).rgb_under_d65()
    }

    /// The largest value (see [`Spectrum::range`]).
    pub fn maximum(&self) -> f64 {
        self.range()[1]
    }

    /// The smallest and the largest value at the whole nanometres of 360–830 nm and at the wavelengths of a table
    /// between them. Rounding in between does not count: no more is found than a table holds, and zero.
    pub fn range(&self) -> [f64; 2] {
        self.range_of(&HalfNanometres::new(self))
    }

    /// The same where its values are known.
    pub(crate) fn range_of(&self, values: &HalfNanometres) -> [f64; 2] {
        let extremes = |values: &mut dyn Iterator<Item = f64>| {
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| {
                [a.min(x), b.max(x)]
            })
        };
        let mut sampled = values.nanometres();
        let knots: Vec<(f64, f64)> = match self {
            Self::Uniform(value) => return [f64::from(*value); 2],
            Self::Regular(table) => table.knots().collect(),
            Self::Irregular(table) => {
                let knots = table.knots();
                knots.map(|(x, y)| (f64::from(x), f64::from(y))).collect()
            }
            Self::Blackbody(_) | Self::Srgb(_) | Self::D65(_) => return extremes(&mut sampled),
        };
        let values = knots.iter().map(|(_, y)| *y);
        let [least, most] = extremes(&mut values.chain([0.0]));
        let visible = |(x, _): &&(f64, f64)| (LAMBDA_MIN..=LAMBDA_MAX).contains(x);
        let within = knots.iter().filter(visible).map(|(_, y)| *y);
        extremes(&mut sampled.map(|y| y.clamp(least, most)).chain(within))
    }

    /// Whether the spectrum is zero at every wavelength, by construction.
    pub fn is_black(&self) -> bool {
        match self {
            Self::Uniform(value) => *value == 0.0,
            Self::Regular(table) => table.values().iter().all(|v| *v == 0.0),
            Self::Irregular(table) => table.knots().all(|(_, v)| v == 0.0),
            Self::Blackbody(_) => false,
            Self::Srgb(colour) | Self::D65(colour) => colour.is_black(),
        }
    }
}

impl From<Regular> for Spectrum {
    fn from(table: Regular) -> Self {
        Self::Regular(Arc::new(table))
    }
}

impl From<Irregular> for Spectrum {
    fn from(table: Irregular) -> Self {
        Self::Irregular(Arc::new(table))
    }
}

impl From<RgbSpectrum> for Spectrum {
    fn from(colour: RgbSpectrum) -> Self {
        Self::Srgb(colour)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_scales_and_integrates() {
        let made = [
            Spectrum::uniform(0.5),
            Spectrum::regular(360.0, 830.0, &[0.0, 1.0, 0.25]),
            Spectrum::irregular(&[300.0, 500.0, 900.0], &[0.1, 0.9, 0.2]),
            Spectrum::blackbody(3000.0),
            Spectrum::reflectance([0.8, 0.4, 0.1]),
            Spectrum::emission([8.0, 0.4, 0.1]),
            Spectrum::d65(2.0),
        ];
        for spectrum in made {
            let spectrum = spectrum.expect("valid parameters");
            let tripled = spectrum.scaled(3.0);
            for (a, b) in [
                (spectrum.luminance(), tripled.luminance()),
                (spectrum.power(), tripled.power()),
                (spectrum.maximum(), tripled.maximum()),
                (spectrum.eval_at(512.3), tripled.eval_at(512.3)),
            ] {
                assert!(
                    a > 0.0 && (b / a - 3.0).abs() < 1e-5,
                    "{spectrum:?}: {a} {b}"
                );
            }
            assert!(!spectrum.is_black());
            assert!(spectrum.scaled(0.0).luminance() == 0.0);
            assert!(spectrum.mean() <= spectrum.maximum());
        }
    }

    #[test]
    fn integrals_are_those_of_the_trapezoids() {
        let uniform = Spectrum::uniform(0.5).expect("a finite value");
        assert!((uniform.power() - 235.0).abs() < 1e-9 && (uniform.mean() - 0.5).abs() < 1e-12);
        let ramp = Spectrum::regular(360.0, 830.0, &[0.0, 1.0]).expect("a valid table");
        assert!((ramp.mean() - 0.5).abs() < 1e-6);
        assert!((Spectrum::d65(1.0).expect("a finite scale").luminance() - 1.0).abs() < 1e-6);
        let white = Spectrum::reflectance([1.0; 3]).expect("components in [0, 1]");
        let rgb = white.rgb_under_d65();
        assert!(rgb.iter().all(|c| (c - 1.0).abs() < 1e-9), "{rgb:?}");
        let wall = Spectrum::reflectance([0.63, 0.065, 0.05]).expect("components in [0, 1]");
        let rgb = wall.rgb_under_d65();
        assert!(
            (rgb[0] - 0.63).abs() < 1e-4 && (rgb[2] - 0.05).abs() < 1e-4,
            "{rgb:?}"
        );
    }

    #[test]
    fn tables_are_regular_where_the_wavelengths_are() {
        let even = Spectrum::tabulated(&[400.0, 500.0, 600.0], &[1.0, 2.0, 3.0]);
        assert!(matches!(even, Ok(Spectrum::Regular(_))));
        let uneven = Spectrum::tabulated(&[400.0, 500.0, 601.0], &[1.0, 2.0, 3.0]);
        assert!(matches!(uneven, Ok(Spectrum::Irregular(_))));
        assert!(Spectrum::tabulated(&[400.0, 300.0], &[1.0, 2.0]).is_err());
    }

    #[test]
    fn black_is_recognised() {
        assert!(Spectrum::Uniform(0.0).is_black());
        for black in [
            Spectrum::reflectance([0.0; 3]),
            Spectrum::emission([0.0; 3]),
            Spectrum::regular(400.0, 500.0, &[0.0, 0.0]),
            Spectrum::irregular(&[400.0, 500.0], &[0.0, 0.0]),
        ] {
            assert!(black.expect("valid parameters").is_black());
        }
        assert!(Spectrum::uniform(f64::NAN).is_err() && Spectrum::d65(f64::INFINITY).is_err());
        assert!(Spectrum::blackbody(0.0).is_err() && Spectrum::blackbody(f64::NAN).is_err());
        assert!(Spectrum::reflectance([0.0, 1.5, 0.0]).is_err());
        assert!(Spectrum::emission([0.0, -1.5, 0.0]).is_err());
    }
}
