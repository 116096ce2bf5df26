//! The ideal low-pass filter under the window of Lanczos (Duchon 1979).
//!
//! ```text
//! f(x) = sinc(x) · sinc(x / a)   for |x| < r,   sinc(x) = sin(πx) / (πx)
//! ```
//!
//! r is a unless it is given, as pbrt-v4 has it.

use core::f64::consts::PI;
use etalon_math::float64::sin;

/// A windowed sinc with `lobes` lobes on either side, the main lobe included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanczos {
    lobes: u32,
    radius: f64,
}

impl Lanczos {
    /// Mitsuba's default number of lobes.
    pub const DEFAULT_LOBES: u32 = 3;
    /// The most lobes accepted: a wider window ends in lobes below 10⁻⁴.
    pub const MOST_LOBES: u32 = 64;

    /// A filter with 1 to [`Lanczos::MOST_LOBES`] lobes.
    pub fn new(lobes: u32) -> Option<Self> {
        (1..=Self::MOST_LOBES).contains(&lobes).then(|| Self {
            lobes,
            radius: f64::from(lobes),
        })
    }

    /// The same ending at a radius (pixels), which must be above 0 and at most twice the window's: what follows is its echo.
    pub fn cut_at(self, radius: f64) -> Option<Self> {
        let fits = radius > 0.0 && radius <= 2.0 * f64::from(self.lobes);
        fits.then_some(Self { radius, ..self })
    }

    /// Whether the radius is one of its own.
    pub(crate) fn is_cut(self) -> bool {
        self.radius != f64::from(self.lobes)
    }

    /// The number of lobes on either side.
    pub fn lobes(self) -> u32 {
        self.lobes
    }

    /// Radius (pixels).
    pub fn radius(self) -> f64 {
        self.radius
    }

    /// The value at `x` pixels from the centre.
    pub fn eval(self, x: f64) -> f64 {
        if x.abs() < self.radius() {
            sinc(x) * sinc(x / f64::from(self.lobes))
        } else {
            0.0
        }
    }
}

/// sin(πx) / (πx).
fn sinc(x: f64) -> f64 {
    let angle = PI * x;
    if angle.abs() < 1e-8 {
        1.0
    } else {
        sin(angle) / angle
    }
}
