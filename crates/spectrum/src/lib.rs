//! What a renderer needs to know about colour and wavelength: the four wavelengths of a path,
//! spectra that can be evaluated at them, the response of the sensor, CIE observers and
//! illuminants, black bodies, spectra for RGB colours, refractive indices.
//!
//! Wavelengths are vacuum wavelengths in nanometres everywhere except where a published formula
//! is quoted (dispersion coefficients are per micrometre, as the literature prints them).
//!
//! The scale of everything that emits is Mitsuba 3's: a pixel that sees the spectrum
//! [`Spectrum::d65`] is exactly white, (1, 1, 1) in linear Rec. 709.

pub mod blackbody;
pub mod cie;
pub mod colour_space;
pub mod conductor_colour;
pub mod conductors;
pub mod error;
mod half_nanometres;
pub mod illuminants;
pub mod named_illuminants;
pub mod quadrature;
pub mod refractive_index;
pub mod sensor;
pub mod spd;
pub mod spectrum;
mod tables;
pub mod tabulated;
pub mod upsample;
pub mod wavelengths;
mod white_balance;

pub use blackbody::Blackbody;
pub use error::SpectrumError;
pub use half_nanometres::SpectrumSummary;
pub use quadrature::QuadratureNode;
pub use refractive_index::RefractiveIndex;
pub use sensor::{Sensor, SensorWeights, sensor_response};
pub use spd::{SpdTable, parse_spb, parse_spd};
pub use spectrum::Spectrum;
pub use tabulated::{Irregular, Regular};
pub use upsample::{RgbCoefficients, RgbSpectrum};
pub use wavelengths::{WavelengthDistribution, Wavelengths};
pub use white_balance::white_balance;

/// Shortest wavelength rendered unless a scene asks otherwise, nm.
pub const LAMBDA_MIN: f64 = 360.0;

/// Longest wavelength rendered unless a scene asks otherwise, nm.
pub const LAMBDA_MAX: f64 = 830.0;
