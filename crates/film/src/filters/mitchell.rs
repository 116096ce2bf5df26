//! The two-parameter family of cubic filters of Mitchell and Netravali (1988), equation (8).
//!
//! ```text
//!          ⎧ (12 − 9B − 6C) |x|³ + (−18 + 12B + 6C) |x|² + (6 − 2B)                  |x| < 1
//! 6 f(x) = ⎨ (−B − 6C) |x|³ + (6B + 30C) |x|² + (−12B − 48C) |x| + (8B + 24C)    1 ≤ |x| < 2
//!          ⎩ 0                                                                         else
//! ```
//!
//! It integrates to one for any B and C. With C > 0 it has negative lobes. With another radius r it is f(2x/r), as pbrt-v4 has it.

/// A cubic filter with blur B and ringing C.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mitchell {
    b: f64,
    c: f64,
    inner: [f64; 4],
    outer: [f64; 4],
    radius: f64,
}

impl Mitchell {
    /// The authors' recommendation, and Mitsuba's default, for both parameters.
    pub const DEFAULT: f64 = 1.0 / 3.0;
    /// The authors' radius (pixels).
    pub const DEFAULT_RADIUS: f64 = 2.0;

    /// The filter with parameters `b` and `c`, if they are finite and its lobes are.
    pub fn new(b: f64, c: f64) -> Option<Self> {
        // Beyond this the lobes cancel to nothing but noise: the sum of |f| exceeds 100.
        let usable = b.abs() <= 100.0 && c.abs() <= 100.0;
        usable.then(|| Self {
            b,
            c,
            inner: [
                (6.0 - 2.0 * b) / 6.0,
                0.0,
                (-18.0 + 12.0 * b + 6.0 * c) / 6.0,
                (12.0 - 9.0 * b - 6.0 * c) / 6.0,
            ],
            outer: [
                (8.0 * b + 24.0 * c) / 6.0,
                (-12.0 * b - 48.0 * c) / 6.0,
                (6.0 * b + 30.0 * c) / 6.0,
                (-b - 6.0 * c) / 6.0,
            ],
            radius: Self::DEFAULT_RADIUS,
        })
    }

    /// The same stretched to a radius (pixels) above 0.
    pub fn stretched(self, radius: f64) -> Option<Self> {
        (radius > 0.0 && radius.is_finite()).then_some(Self { radius, ..self })
    }

    /// Radius (pixels).
    pub fn radius(self) -> f64 {
        self.radius
    }

    /// The parameters B and C.
    pub fn parameters(self) -> [f64; 2] {
        [self.b, self.c]
    }

    /// The value at `x` pixels from the centre.
    pub fn eval(self, x: f64) -> f64 {
        let x = x.abs() * (Self::DEFAULT_RADIUS / self.radius);
        let cubic = |[a0, a1, a2, a3]: [f64; 4]| a0 + x * (a1 + x * (a2 + x * a3));
        if x < 1.0 {
            cubic(self.inner)
        } else if x < Self::DEFAULT_RADIUS {
            cubic(self.outer)
        } else {
            0.0
        }
    }
}
