//! The cubic of Catmull and Rom (1974), which interpolates: 1 at its own pixel's centre and 0
//! at all others.
//!
//! ```text
//!        ⎧ 3/2 |x|³ − 5/2 |x|² + 1             |x| < 1
//! f(x) = ⎨ −1/2 |x|³ + 5/2 |x|² − 4 |x| + 2    1 ≤ |x| < 2
//!        ⎩ 0                                       else
//! ```

/// The Catmull-Rom filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CatmullRom;

impl CatmullRom {
    /// Radius (pixels).
    pub const RADIUS: f64 = 2.0;

    /// The value at `x` pixels from the centre.
    pub fn eval(self, x: f64) -> f64 {
        let x = x.abs();
        if x < 1.0 {
            1.0 + x * x * (1.5 * x - 2.5)
        } else if x < Self::RADIUS {
            2.0 + x * (-4.0 + x * (2.5 - 0.5 * x))
        } else {
            0.0
        }
    }
}
