//! Smooth spectra for RGB colours (Jakob and Hanika, "A Low-Dimensional Function Space for Efficient
//! Spectral Upsampling", 2019):
//!
//! s(λ) = S(c₀ t² + c₁ t + c₂),  S(x) = ½ + x / (2 √(1 + x²))
//!
//! with t = (λ − 595)/235, which is −1 and 1 at 360 and 830 nm (the paper writes the polynomial in
//! nanometres; centring it costs nothing and keeps single precision exact). The spectrum lit by D65
//! has the colour: ∫ s D65 (r̄, ḡ, b̄) dλ / N = (R, G, B).

pub mod basis;
pub mod fit;
pub mod table;

use crate::{SpectrumError, error};
use etalon_math::lane::{Lane, Spectral};
use glam::Vec4;

/// Middle of the rendered wavelengths, nm.
const CENTRE: f32 = 595.0;
/// Half their range, nm.
const HALF_RANGE: f32 = 235.0;

/// The wavelength variable t of the polynomial.
fn variable(lambda: f64) -> f64 {
    (lambda - f64::from(CENTRE)) / f64::from(HALF_RANGE)
}

/// The coefficients c₀, c₁, c₂ of a spectrum with values in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbCoefficients(pub [f32; 3]);

impl RgbCoefficients {
    /// The constant spectrum `value` in [0, 1].
    pub fn constant(value: f32) -> Self {
        /// An argument at which S is exactly 0 or 1 in single precision.
        const SATURATED: f32 = 1e30;
        let argument = if value <= 0.0 {
            -SATURATED
        } else if value >= 1.0 {
            SATURATED
        } else {
            let v = f64::from(value);
            ((v - 0.5) / (v * (1.0 - v)).sqrt()) as f32
        };
        Self([0.0, 0.0, argument])
    }

    /// The spectrum of the linear Rec. 709 colour `rgb`. Components are clamped to [0, 1] (NaN to 0),
    /// as textures may hold others. For numbers from scene files use [`RgbSpectrum::bounded`], which
    /// refuses them.
    ///
    /// Greys have constant spectra, without error. For the others the round trip to RGB errs by
    /// less than 0.0016 in any component, and by less than 5·10⁻⁶ in nine colours of ten.
    pub fn from_rgb(rgb: [f32; 3]) -> Self {
        let rgb = rgb.map(|v| if v >= 0.0 { v.min(1.0) } else { 0.0 });
        if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
            Self::constant(rgb[0])
        } else {
            Self(table::lookup(table::shipped(), rgb))
        }
    }

    /// The spectrum at four wavelengths in nm.
    #[inline]
    pub fn eval(&self, lambda: Vec4) -> Vec4 {
        Self::eval_lanes::<f32>(self.0, lambda)
    }

    /// Spectra with these coefficients, each at its wavelengths.
    #[inline(always)]
    pub fn eval_lanes<F: Lane>([c0, c1, c2]: [F; 3], lambda: F::Spectrum) -> F::Spectrum {
        let t = (lambda - F::splat(CENTRE)) * F::splat(1.0 / HALF_RANGE);
        sigmoid::<F>((t * c0 + c1) * t + c2)
    }
}

/// S(x) = ½ + x/(2 √(1 + x²)), written so that neither end cancels: with r = √(1 + x²),
/// S(−|x|) = 1/(2 r (r + |x|)) and S(|x|) = 1 − S(−|x|).
#[inline(always)]
fn sigmoid<F: Lane>(x: F::Spectrum) -> F::Spectrum {
    let root = (x * x + F::ONE).square_roots();
    let low = F::Spectrum::uniform(F::splat(0.5)) / (root * (root + x.magnitudes()));
    x.where_negative(low, F::Spectrum::uniform(F::ONE) - low)
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
