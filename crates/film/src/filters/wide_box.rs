//! The box of another width than the pixel's: every position within a square about the pixel's centre counts the same.
//!
//! ```text
//! f(x) = 1   for −r ≤ x < r
//! ```

/// The box filter of a radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WideBox {
    radius: f64,
}

impl WideBox {
    /// A box of a radius (pixels) above 0.
    pub fn new(radius: f64) -> Option<Self> {
        (radius > 0.0 && radius.is_finite()).then_some(Self { radius })
    }

    /// Half the width (pixels).
    pub fn radius(self) -> f64 {
        self.radius
    }

    /// The value at `x` pixels from the centre.
    pub fn eval(self, x: f64) -> f64 {
        f64::from(u8::from((-self.radius..self.radius).contains(&x)))
    }
}
