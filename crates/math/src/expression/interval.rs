//! Interval arithmetic: every operation encloses all values that its operands may give (R. Moore 1966, *Interval
//! Analysis*).
//!
//! Ends are rounded outward: by one ulp for correctly rounded operations of IEEE 754, by a few for the elementary functions.
//! A result that may be undefined (a pole, a root of an interval with negative numbers) is [`Interval::ALL`]. One that is
//! certainly undefined (the root of a negative interval) is [`Interval::NONE`], which contains no zero; it propagates.

use super::number::Number;
use crate::noise::{self, LARGEST_CURVATURE, LARGEST_SLOPE};
use core::f64::consts::{FRAC_PI_2, PI, TAU};
use glam::DVec3;

/// The numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The least.
    pub low: f64,
    /// The greatest.
    pub high: f64,
}

impl Interval {
    /// All numbers, and undefined.
    pub const ALL: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// The empty interval: undefined.
    pub const NONE: Self = Self {
        low: f64::NAN,
        high: f64::NAN,
    };

    /// Whether it is no number.
    #[inline]
    pub fn is_none(&self) -> bool {
        self.low.is_nan()
    }

    /// From `low` to `high`, a neighbouring number further on both sides; all if one of them is no number.
    #[inline]
    pub fn around(low: f64, high: f64) -> Self {
        if low.is_nan() || high.is_nan() {
            return Self::ALL;
        }
        Self {
            low: low.next_down(),
            high: high.next_up(),
        }
    }

    /// The same, wider by `parts` of the ends' magnitude.
    fn wide(low: f64, high: f64, parts: f64) -> Self {
        Self::around(low - parts * low.abs(), high + parts * high.abs())
    }

    /// Whether zero is in it.
    #[inline]
    pub fn has_zero(&self) -> bool {
        self.low <= 0.0 && self.high >= 0.0
    }

    /// The intersection, which must not be empty.
    #[inline]
    pub fn meet(self, other: Self) -> Self {
        Self {
            low: self.low.max(other.low),
            high: self.high.min(other.high),
        }
    }

    fn hull(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    fn at_least(self, least: f64) -> Self {
        Self {
            low: self.low.max(least),
            high: self.high.max(least),
        }
    }
}

/// A bound on the relative error of `libm`.
const ELEMENTARY: f64 = 1e-15;

impl Number for Interval {
    fn constant(value: f64) -> Self {
        if value.is_nan() {
            return Self::ALL;
        }
        Self {
            low: value,
            high: value,
        }
    }
    fn add(self, b: Self) -> Self {
        if self.is_none() || b.is_none() {
            return Self::NONE;
        }
        Self::around(self.low + b.low, self.high + b.high)
    }
    fn shift(self, c: f64) -> Self {
        if self.is_none() {
            return self;
        }
        Self::around(self.low + c, self.high + c)
    }
    fn scale(self, c: f64) -> Self {
        if self.is_none() {
            return self;
        }
        let (a, b) = (self.low * c, self.high * c);
        if c < 0.0 {
            Self::around(b, a)
        } else {
            Self::around(a, b)
        }
    }
    fn mul(self, b: Self) -> Self {
        if self.is_none() || b.is_none() {
            return Self::NONE;
        }
        let ends = [
            self.low * b.low,
            self.low * b.high,
            self.high * b.low,
            self.high * b.high,
        ];
        if ends.iter().any(|end| end.is_nan()) {
            return Self::ALL;
        }
        Self::around(
            ends.into_iter().fold(f64::INFINITY, f64::min),
            ends.into_iter().fold(f64::NEG_INFINITY, f64::max),
        )
    }
    fn div(self, b: Self) -> Self {
        if self.is_none() || b.is_none() {
            return Self::NONE;
        }
        if b.has_zero() {
            // The sign of the constant 0 is known.
            let is_zero = [b.low, b.high].iter().all(|end| end.to_bits() == 0);
            return match (is_zero, self) {
                (true, a) if a.low > 0.0 => Self::constant(f64::INFINITY),
                (true, a) if a.high < 0.0 => Self::constant(f64::NEG_INFINITY),
                (true, a) if a.low == 0.0 && a.high == 0.0 => Self::NONE,
                _ => Self::ALL,
            };
        }
        self.mul(Self::around(1.0 / b.high, 1.0 / b.low))
    }
    fn neg(self) -> Self {
        Self {
            low: -self.high,
            high: -self.low,
        }
    }
    fn powi(self, n: i32) -> Self {
        if self.is_none() && n != 0 {
            return self;
        }
        if n < 0 {
            return Self::constant(1.0).div(self.powi(-n));
        }
        let parts = f64::EPSILON * f64::from(n);
        let power = <f64 as Number>::powi;
        let (a, b) = (power(self.low, n), power(self.high, n));
        if n % 2 == 1 {
            return Self::wide(a, b, parts);
        }
        let least = if self.has_zero() { 0.0 } else { a.min(b) };
        Self::wide(least, a.max(b), parts).at_least(0.0)
    }
    fn sqrt(self) -> Self {
        if self.is_none() || self.high < 0.0 {
            return Self::NONE;
        }
        if self.low < 0.0 {
            return Self::ALL;
        }
        Self::around(self.low.sqrt(), self.high.sqrt()).at_least(0.0)
    }
    fn exp(self) -> Self {
        if self.is_none() {
            return self;
        }
        let end = <f64 as Number>::exp;
        Self::wide(end(self.low), end(self.high), ELEMENTARY).at_least(0.0)
    }
    fn ln(self) -> Self {
        if self.is_none() || self.high < 0.0 {
            return Self::NONE;
        }
        if self.low < 0.0 {
            return Self::ALL;
        }
        let end = <f64 as Number>::ln;
        Self::wide(end(self.low), end(self.high), ELEMENTARY)
    }
    fn sin(self) -> Self {
        if self.is_none() {
            return self;
        }
        let far = self.low.abs().max(self.high.abs());
        // Far away π is not known well enough to tell the waves apart.
        if !(self.high - self.low < TAU && far < 1e9) {
            return Self {
                low: -1.0,
                high: 1.0,
            };
        }
        let slack = 1e-14 * (1.0 + far);
        let passes = |peak: f64| {
            let next = ((self.low - slack - peak) / TAU).ceil() * TAU + peak;
            next <= self.high + slack
        };
        let (a, b) = (Number::sin(self.low), Number::sin(self.high));
        Self {
            low: if passes(-FRAC_PI_2) {
                -1.0
            } else {
                a.min(b) - 2.0 * ELEMENTARY
            },
            high: if passes(FRAC_PI_2) {
                1.0
            } else {
                a.max(b) + 2.0 * ELEMENTARY
            },
        }
    }
    fn cos(self) -> Self {
        // The quarter turn, and its own error.
        self.add(Self::wide(FRAC_PI_2, FRAC_PI_2, ELEMENTARY)).sin()
    }
    fn atan(self) -> Self {
        if self.is_none() {
            return self;
        }
        let end = <f64 as Number>::atan;
        Self::wide(end(self.low), end(self.high), ELEMENTARY).meet(Self::around(-PI, PI))
    }
    fn max_with(a: Self, b: Self, da: Self, db: Self) -> (Self, Self) {
        // As of numbers: NaN is never the greater.
        if a.is_none() || b.is_none() {
            return (b, db);
        }
        let value = Self {
            low: a.low.max(b.low),
            high: a.high.max(b.high),
        };
        if a.low > b.high {
            (value, da)
        } else if b.low > a.high {
            (value, db)
        } else {
            (value, da.hull(db))
        }
    }
    fn noise(p: [Self; 3]) -> (Self, [Self; 3]) {
        let unknown = |most: f64| Self {
            low: -most,
            high: most,
        };
        let reach: f64 = p.iter().map(|x| 0.5 * (x.high - x.low)).sum();
        if !(reach < 1.0) {
            return (unknown(1.0), [unknown(LARGEST_SLOPE); 3]);
        }
        let middle = DVec3::from(p.map(|x| 0.5 * (x.low + x.high)));
        let (value, gradient) = noise::noise_and_gradient(middle);
        // Rounding in the noise itself: some hundred operations on numbers up to 10.
        let near = |value: f64, off: f64, most: f64| {
            let off = off * (1.0 + 1e-9) + 1e-13;
            Self::around(value - off, value + off).meet(unknown(most))
        };
        (
            near(value, LARGEST_SLOPE * reach, 1.0),
            gradient
                .to_array()
                .map(|slope| near(slope, LARGEST_CURVATURE * reach, LARGEST_SLOPE)),
        )
    }
}
