//! The tent: linear interpolation between pixel centres, for a radius of one.
//!
//! ```text
//! f(x) = 1 − |x| / r   for |x| < r
//! ```

/// A tent of any radius (pixels).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tent {
    radius: f64,
}

impl Tent {
    /// Mitsuba's default radius.
    pub const DEFAULT_RADIUS: f64 = 1.0;

    /// A tent, if the radius is positive and finite.
    pub fn new(radius: f64) -> Option<Self> {
        (radius > 0.0 && radius.is_finite()).then_some(Self { radius })
    }

    /// Radius (pixels).
    pub fn radius(self) -> f64 {
        self.radius
    }

    /// The value at `x` pixels from the centre.
    pub fn eval(self, x: f64) -> f64 {
        (1.0 - x.abs() / self.radius).max(0.0)
    }
}
