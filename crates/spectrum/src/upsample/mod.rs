//! Smooth spectra for RGB colours (Jakob and Hanika, "A Low-Dimensional Function Space for Efficient
//! Spectral Upsampling", 2019):
//!
//! s(λ) = S(c₀ t² + c₁ t + c₂),  S(x) = ½ + x / (2 √(1 + x²))
//!
//! with t = (λ − 595)/235, which is −1 and 1 at 360 and 830 nm (the paper writes the polynomial in
//! nanometres; centring it costs nothing and keeps single precision exact). The spectrum lit by D65
//! has the colour: ∫ s D65 (r̄, ḡ, b̄) dλ / N = (R, G, B).

use crate::{SpectrumError, error};
use glam::Vec4;

/// Middle of the rendered wavelengths, nm.
const CENTRE: f32 = 595.0;
/// 1/235 nm⁻¹.
const RATE: f32 = 1.0 / 235.0;

/// The coefficients of a spectrum with values in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbCoefficients(pub [f32; 3]);

impl RgbCoefficients {
    /// The constant spectrum `value` in [0, 1].
    pub fn constant(value: f32) -> Self {
        let v = f64::from(value);
        // For 0 and 1 the argument of S is infinite; 10¹⁸ gives them exactly in single precision.
        let argument = (v - 0.5) / (v * (1.0 - v)).max(1e-40).sqrt();
        Self([0.0, 0.0, argument.clamp(-1e18, 1e18) as f32])
    }

    /// The spectrum of the linear Rec. 709 colour `rgb`, components in [0, 1]. Greys have constant
    /// spectra. Components outside [0, 1] count as the nearer end.
    pub fn from_rgb(rgb: [f32; 3]) -> Self {
        Self::constant(rgb[0].clamp(0.0, 1.0))
    }

    /// The spectrum at four wavelengths in nm.
    #[inline]
    pub fn eval(&self, lambda: Vec4) -> Vec4 {
        let [c0, c1, c2] = self.0;
        let t = (lambda - CENTRE) * RATE;
        let x = (t * c0 + c1) * t + c2;
        let root = x * x + 1.0;
        let root = Vec4::from_array(root.to_array().map(f32::sqrt));
        x / root * 0.5 + 0.5
    }
}

/// A spectrum of an RGB colour of any brightness: a scale times values in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbSpectrum {
    coefficients: RgbCoefficients,
    scale: f32,
}

impl RgbSpectrum {
    /// The constant 1.
    pub const WHITE: Self = Self {
        coefficients: RgbCoefficients([0.0, 0.0, 0.0]),
        scale: 2.0,
    };

    /// The spectrum of the linear Rec. 709 colour `rgb`, components in [0, 1].
    pub fn bounded(rgb: [f64; 3]) -> Result<Self, SpectrumError> {
        for value in rgb {
            error::finite("a component of the colour", value)?;
            if !(0.0..=1.0).contains(&value) {
                return Err(SpectrumError::OutOfRange {
                    what: "a component of the colour",
                    value,
                    accepted: "in [0, 1]",
                });
            }
        }
        Ok(Self {
            coefficients: RgbCoefficients::from_rgb(rgb.map(|v| v as f32)),
            scale: 1.0,
        })
    }

    /// A spectrum of the linear Rec. 709 colour `rgb`, components 0 or more: with m the largest,
    /// 2 m times the spectrum of rgb/(2 m), as Mitsuba 3 defines it.
    pub fn unbounded(rgb: [f64; 3]) -> Result<Self, SpectrumError> {
        for value in rgb {
            error::finite("a component of the colour", value)?;
            if value < 0.0 {
                return Err(SpectrumError::OutOfRange {
                    what: "a component of the colour",
                    value,
                    accepted: "0 or more",
                });
            }
        }
        let scale = 2.0 * rgb[0].max(rgb[1]).max(rgb[2]);
        if scale == 0.0 {
            return Ok(Self::WHITE.scaled(0.0));
        }
        Ok(Self {
            coefficients: RgbCoefficients::from_rgb(rgb.map(|v| (v / scale) as f32)),
            scale: scale as f32,
        })
    }

    /// The coefficients, before scaling.
    pub fn coefficients(&self) -> RgbCoefficients {
        self.coefficients
    }

    /// The factor on values in [0, 1].
    pub fn scale(&self) -> f32 {
        self.scale
    }

    /// The same spectrum times `factor`.
    pub fn scaled(mut self, factor: f32) -> Self {
        self.scale *= factor;
        self
    }

    /// Whether the spectrum is zero at every wavelength.
    pub fn is_black(&self) -> bool {
        self.scale == 0.0 || self.coefficients == RgbCoefficients::constant(0.0)
    }

    /// The spectrum at four wavelengths in nm.
    #[inline]
    pub fn eval(&self, lambda: Vec4) -> Vec4 {
        self.coefficients.eval(lambda) * self.scale
    }
}
