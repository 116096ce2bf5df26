//! A spectrum at every half nanometre from 360 to 830 nm: what its colour, mean and range are taken from.

use crate::{LAMBDA_MAX, LAMBDA_MIN, Spectrum, cie, colour_space, illuminants};
use glam::Vec4;
use std::sync::LazyLock;

/// Number of values.
const COUNT: usize = 2 * (LAMBDA_MAX - LAMBDA_MIN) as usize + 1;

/// D65 with Y = 1.
static WHITE: LazyLock<Vec<f64>> = LazyLock::new(|| {
    (0..COUNT)
        .map(|i| illuminants::d65(wavelength(i)))
        .collect()
});

fn wavelength(index: usize) -> f64 {
    LAMBDA_MIN + 0.5 * index as f64
}

fn index(lambda: f64) -> usize {
    (2.0 * (lambda - LAMBDA_MIN)) as usize
}

/// Values of a spectrum, in the precision of [`Spectrum::eval`].
pub(crate) struct HalfNanometres([f32; COUNT]);

impl HalfNanometres {
    /// Four wavelengths are evaluated at a time.
    pub(crate) fn new(spectrum: &Spectrum) -> Self {
        let mut values = [0.0; COUNT];
        for (number, four) in values.chunks_mut(4).enumerate() {
            let lambda = [0, 1, 2, 3].map(|i| wavelength(4 * number + i) as f32);
            let evaluated = spectrum.eval(Vec4::from_array(lambda)).to_array();
            four.copy_from_slice(&evaluated[..four.len()]);
        }
        Self(values)
    }

    /// The value at a multiple of ½ nm.
    fn at(&self, lambda: f64) -> f64 {
        f64::from(self.0[index(lambda)])
    }

    /// Those at every nanometre.
    pub(crate) fn nanometres(&self) -> impl Iterator<Item = f64> {
        self.0.iter().step_by(2).map(|value| f64::from(*value))
    }

    /// ∫ dλ, by the trapezoidal rule.
    pub(crate) fn power(&self) -> f64 {
        let term = |(i, value): (usize, &f32)| {
            let weight = match i == 0 || i == COUNT - 1 {
                true => 0.25,
                false => 0.5,
            };
            weight * f64::from(*value)
        };
        self.0.iter().enumerate().map(term).sum()
    }

    /// The tristimulus value of the spectrum as a radiance.
    pub(crate) fn xyz(&self) -> [f64; 3] {
        cie::xyz(|lambda| self.at(lambda))
    }

    /// Linear Rec. 709 of the spectrum as a reflectance lit by D65.
    pub(crate) fn rgb_under_d65(&self) -> [f64; 3] {
        let white = &*WHITE;
        colour_space::xyz_to_rgb(cie::xyz(|lambda| self.at(lambda) * white[index(lambda)]))
    }
}

/// What a spectrum comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectrumSummary {
    /// Its mean over 360–830 nm.
    pub mean: f64,
    /// See [`Spectrum::rgb_under_d65`].
    pub rgb_under_d65: [f64; 3],
    /// See [`Spectrum::range`].
    pub range: [f64; 2],
}

impl Spectrum {
    /// Its mean, colour and range together, in less time than one after the other.
    pub fn summary(&self) -> SpectrumSummary {
        let values = HalfNanometres::new(self);
        SpectrumSummary {
            mean: values.power() / (LAMBDA_MAX - LAMBDA_MIN),
            rgb_under_d65: values.rgb_under_d65(),
            range: self.range_of(&values),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mutant: a value of the neighbouring wavelength.
    #[test]
    fn values_are_those_of_the_spectrum() {
        let spectra = [
            Spectrum::emission([0.2, 3.0, 0.7]),
            Spectrum::reflectance([0.2, 0.9, 0.7]),
            Spectrum::blackbody(3000.0),
            Spectrum::irregular(&[400.0, 455.5, 700.0], &[0.1, 2.0, 0.3]),
        ];
        for spectrum in spectra.map(|spectrum| spectrum.expect("valid")) {
            let values = HalfNanometres::new(&spectrum);
            for i in 0..COUNT {
                let lambda = wavelength(i);
                assert_eq!(values.at(lambda), spectrum.eval_at(lambda), "{lambda} nm");
            }
            let SpectrumSummary {
                mean,
                rgb_under_d65,
                range,
            } = spectrum.summary();
            assert_eq!(mean, spectrum.mean());
            assert_eq!(rgb_under_d65, spectrum.rgb_under_d65());
            assert_eq!(range, spectrum.range());
        }
    }
}
