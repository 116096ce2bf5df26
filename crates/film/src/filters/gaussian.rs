//! The Gaussian, cut off at four standard deviations and lowered to meet zero there.
//!
//! ```text
//! f(x) = exp(−x² / 2σ²) − exp(−r² / 2σ²)   for |x| < r = 4σ
//! ```
//!
//! Radius and offset are Mitsuba's (`gaussian`). Mitsuba evaluates a polynomial fitted to this
//! function, which stays within 5·10⁻⁴ of it.

use etalon_math::float64::exp;

/// A Gaussian of standard deviation σ (pixels).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gaussian {
    deviation: f64,
    offset: f64,
}

impl Gaussian {
    /// Mitsuba's default standard deviation.
    pub const DEFAULT_DEVIATION: f64 = 0.5;
    /// The radius in standard deviations.
    const CUT: f64 = 4.0;

    /// A Gaussian, if its standard deviation is positive and its variance a normal number.
    pub fn new(deviation: f64) -> Option<Self> {
        (deviation > 0.0 && (deviation * deviation).is_normal()).then(|| Self {
            deviation,
            offset: exp(-0.5 * Self::CUT * Self::CUT),
        })
    }

    /// The standard deviation (pixels).
    pub fn deviation(self) -> f64 {
        self.deviation
    }

    /// Radius (pixels).
    pub fn radius(self) -> f64 {
        Self::CUT * self.deviation
    }

    /// The value at `x` pixels from the centre.
    pub fn eval(self, x: f64) -> f64 {
        let z = x / self.deviation;
        (exp(-0.5 * z * z) - self.offset).max(0.0)
    }
}
