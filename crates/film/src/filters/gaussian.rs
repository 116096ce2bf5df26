//! The Gaussian, cut off at four standard deviations or another radius, and lowered to meet zero there.
//!
//! ```text
//! f(x) = exp(−x² / 2σ²) − exp(−r² / 2σ²)   for |x| < r, which is 4σ unless it is given
//! ```
//!
//! Radius and offset are Mitsuba's (`gaussian`), and with a radius of its own pbrt's. Mitsuba evaluates a polynomial fitted to this
//! function, which stays within 5·10⁻⁴ of it.

use etalon_math::float64::exp;

/// A Gaussian of standard deviation σ (pixels).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gaussian {
    deviation: f64,
    radius: f64,
    offset: f64,
}

impl Gaussian {
    /// Mitsuba's default standard deviation.
    pub const DEFAULT_DEVIATION: f64 = 0.5;
    /// The radius in standard deviations.
    const CUT: f64 = 4.0;

    /// A Gaussian of Mitsuba's radius, if its standard deviation is positive and its variance a normal number.
    pub fn new(deviation: f64) -> Option<Self> {
        Self::cut_at(deviation, Self::CUT * deviation)
    }

    /// A Gaussian that ends at a radius (pixels), if that is positive and not below a hundredth of the standard deviation, where nothing
    /// but rounding would be left of it.
    pub fn cut_at(deviation: f64, radius: f64) -> Option<Self> {
        let end = radius / deviation;
        let is_sound = deviation > 0.0 && (deviation * deviation).is_normal();
        (is_sound && end >= 0.01 && radius.is_finite()).then(|| Self {
            deviation,
            radius,
            offset: exp(-0.5 * end * end),
        })
    }

    /// The standard deviation (pixels).
    pub fn deviation(self) -> f64 {
        self.deviation
    }

    /// Radius (pixels).
    pub fn radius(self) -> f64 {
        self.radius
    }

    /// Whether the radius is one of its own.
    pub(crate) fn is_cut(self) -> bool {
        self.radius != Self::CUT * self.deviation
    }

    /// The value at `x` pixels from the centre.
    pub fn eval(self, x: f64) -> f64 {
        let z = x / self.deviation;
        (exp(-0.5 * z * z) - self.offset).max(0.0)
    }
}
