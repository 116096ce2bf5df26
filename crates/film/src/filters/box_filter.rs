//! The box: every position in the pixel counts the same.
//!
//! ```text
//! f(x) = 1   for −½ ≤ x < ½
//! ```
//!
//! The interval is half open, so that every raster position belongs to exactly one pixel.

/// The box filter of one pixel's width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxFilter;

impl BoxFilter {
    /// Half the width (pixels).
    pub const RADIUS: f64 = 0.5;

    /// The value at `x` pixels from the centre.
    pub fn eval(self, x: f64) -> f64 {
        if (-Self::RADIUS..Self::RADIUS).contains(&x) {
            1.0
        } else {
            0.0
        }
    }
}
