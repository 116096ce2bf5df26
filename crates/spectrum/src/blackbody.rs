//! Planck's law: the spectral radiance of a black body (Planck 1901),
//!
//! L(λ, T) = 2 h c² λ⁻⁵ / (e^(h c / (λ k T)) − 1), in W·m⁻²·sr⁻¹·nm⁻¹.
//!
//! Constants are the exact ones of the SI since 2019.

use crate::{LAMBDA_MAX, LAMBDA_MIN, SpectrumError, error};
use etalon_math::float64;
use glam::Vec4;

/// Planck's constant, J·s.
const PLANCK: f64 = 6.626_070_15e-34;
/// Speed of light in vacuum, m·s⁻¹.
const LIGHT_SPEED: f64 = 299_792_458.0;
/// Boltzmann's constant, J·K⁻¹.
const BOLTZMANN: f64 = 1.380_649e-23;

/// Spectral radiance of a black body of `temperature` K at `lambda` nm, W·m⁻²·sr⁻¹·nm⁻¹.
pub fn radiance(lambda: f64, temperature: f64) -> f64 {
    let metres = lambda * 1e-9;
    let exponent = PLANCK * LIGHT_SPEED / (metres * BOLTZMANN * temperature);
    let squared = metres * metres;
    let fifth = squared * squared * metres;
    // The factor 10⁻⁹ turns "per metre of wavelength" into "per nanometre".
    1e-9 * 2.0 * PLANCK * LIGHT_SPEED * LIGHT_SPEED / (fifth * (float64::exp(exponent) - 1.0))
}

/// Most steps of a table: bodies too cold to be seen need no more.
const MAX_STEPS: f64 = 16_384.0;

/// The emission of a black body over a range, zero outside it, tabulated at 1 nm or less so that
/// interpolation errs by less than 10⁻⁴.
#[derive(Clone, Debug, PartialEq)]
pub struct Blackbody {
    temperature: f64,
    table: crate::Regular,
}

impl Blackbody {
    /// A black body of `temperature` K, emitting between 360 and 830 nm.
    pub fn new(temperature: f64) -> Result<Self, SpectrumError> {
        Self::with_range(temperature, LAMBDA_MIN, LAMBDA_MAX)
    }

    /// A black body of `temperature` K, emitting between `min` and `max` nm.
    pub fn with_range(temperature: f64, min: f64, max: f64) -> Result<Self, SpectrumError> {
        error::positive("the temperature of a black body", temperature)?;
        error::positive("the shortest wavelength", min)?;
        error::finite("the longest wavelength", max)?;
        if max <= min {
            return Err(SpectrumError::OutOfRange {
                what: "the longest wavelength",
                value: max,
                accepted: "above the shortest wavelength",
            });
        }
        // Linear interpolation at the step h errs by h² L″/(8 L), and L″/L is greatest at the blue
        // end, where it is about (hc / (k T λ²))² under Wien's law: 5·10⁻⁵ bounds the error.
        let slope = PLANCK * LIGHT_SPEED / (BOLTZMANN * temperature * min * min * 1e-9);
        let step = (8.0_f64 * 5e-5).sqrt() / slope;
        let steps = ((max - min) / step.min(1.0)).ceil().clamp(1.0, MAX_STEPS) as usize;
        let values: Vec<f64> = (0..=steps)
            .map(|i| radiance(min + (max - min) * i as f64 / steps as f64, temperature))
            .collect();
        Ok(Self {
            temperature,
            table: crate::Regular::new(min, max, &values)?,
        })
    }

    /// The emission as a table, W·m⁻²·sr⁻¹·nm⁻¹.
    pub fn table(&self) -> &crate::Regular {
        &self.table
    }

    /// Temperature, K.
    pub fn temperature(&self) -> f64 {
        self.temperature
    }

    /// Spectral radiance at four wavelengths in nm, W·m⁻²·sr⁻¹·nm⁻¹.
    #[inline]
    pub fn eval(&self, lambda: Vec4) -> Vec4 {
        self.table.eval(lambda)
    }
}
