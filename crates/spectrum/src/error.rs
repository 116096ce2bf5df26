//! Why a spectrum could not be made.

use std::fmt;

/// A refused parameter of a spectrum, with what would have been accepted.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SpectrumError {
    /// A number is not finite.
    NotFinite {
        /// The meaning of the number.
        what: &'static str,
        /// The offending number.
        value: f64,
    },
    /// A number lies outside the accepted interval.
    OutOfRange {
        /// The meaning of the number.
        what: &'static str,
        /// The offending number.
        value: f64,
        /// The interval in words, as "greater than 0".
        accepted: &'static str,
    },
    /// Fewer values than an interpolated table needs.
    TooFewValues {
        /// The given number.
        given: usize,
        /// The least number.
        needed: usize,
    },
    /// The numbers of wavelengths and of values differ.
    LengthMismatch {
        /// Number of wavelengths.
        wavelengths: usize,
        /// Number of values.
        values: usize,
    },
    /// Wavelengths do not increase strictly.
    NotIncreasing {
        /// Index of the first wavelength that is not above its predecessor.
        index: usize,
        /// That wavelength, nm.
        value: f64,
    },
}

impl fmt::Display for SpectrumError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { what, value } => {
                write!(f, "{what} is {value}: expected a finite number")
            }
            Self::OutOfRange {
                what,
                value,
                accepted,
            } => write!(f, "{what} is {value}: expected a number {accepted}"),
            Self::TooFewValues { given, needed } => write!(
                f,
                "{given} values are too few: an interpolated spectrum needs at least {needed}"
            ),
            Self::LengthMismatch {
                wavelengths,
                values,
            } => write!(
                f,
                "{wavelengths} wavelengths for {values} values: expected as many of one as of the other"
            ),
            Self::NotIncreasing { index, value } => write!(
                f,
                "wavelength number {} ({value} nm) is not above the one before it: expected strictly increasing wavelengths",
                index + 1
            ),
        }
    }
}

impl std::error::Error for SpectrumError {}

/// `value` if it is finite.
pub(crate) fn finite(what: &'static str, value: f64) -> Result<f64, SpectrumError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(SpectrumError::NotFinite { what, value })
    }
}

/// `value` if it is finite and above zero.
pub(crate) fn positive(what: &'static str, value: f64) -> Result<f64, SpectrumError> {
    if finite(what, value)? > 0.0 {
        Ok(value)
    } else {
        Err(SpectrumError::OutOfRange {
            what,
            value,
            accepted: "greater than 0",
        })
    }
}
