//! Sampling a function that changes sign, such as a reconstruction filter with negative lobes.
//!
//! The density is |f| / ∫|f|, and the estimate of ∫f·g is sgn f(x) · g(x) · ∫|f|. Which
//! sign it is comes before the place: the share of [0, 1) given to the positive part is one
//! interval, so that stratified numbers give each sign its exact share of the samples.

use super::{PiecewiseLinear, TableError};

/// A function, linear between given points, that is sampled by its absolute value.
#[derive(Clone, Debug)]
pub struct SignedPiecewiseLinear {
    positive: Option<PiecewiseLinear>,
    negative: Option<PiecewiseLinear>,
    /// The share of the positive part in ∫|f|.
    positive_share: f64,
    absolute_integral: f64,
    integral: f64,
}

/// A point at which the function was sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignedSample {
    /// Position.
    pub x: f64,
    /// The sign of the function there, 1 or −1.
    pub sign: f64,
}

impl SignedPiecewiseLinear {
    /// The function whose graph is the polygon through (`abscissae`, `values`). A sign change
    /// between two points is found exactly, where the polygon crosses zero.
    ///
    /// # Errors
    /// If there are fewer than two points, numbers differ, abscissae do not increase, a value
    /// is not finite or all are zero.
    pub fn new(abscissae: &[f64], values: &[f64]) -> Result<Self, TableError> {
        if abscissae.len() != values.len() {
            return Err(TableError::WrongShape {
                entries: abscissae.len(),
                needed: values.len(),
            });
        }
        if let Some(index) = values.iter().position(|v| !v.is_finite()) {
            return Err(TableError::BadEntry {
                index,
                value: values[index],
            });
        }
        let (mut x, mut f) = (Vec::new(), Vec::new());
        for (i, (&at, &value)) in abscissae.iter().zip(values).enumerate() {
            if i > 0 && values[i - 1] * value < 0.0 {
                let (from, before) = (abscissae[i - 1], values[i - 1]);
                let crossing = from + (at - from) * (before / (before - value));
                // Next to a point the crossing may round onto it.
                if crossing > from && crossing < at {
                    x.push(crossing);
                    f.push(0.0);
                }
            }
            x.push(at);
            f.push(value);
        }
        let part = |sign: f64| -> Result<Option<PiecewiseLinear>, TableError> {
            let values: Vec<f64> = f.iter().map(|&v| (sign * v).max(0.0)).collect();
            match PiecewiseLinear::new(&x, &values) {
                Ok(part) => Ok(Some(part)),
                Err(TableError::Zero) => Ok(None),
                Err(error) => Err(error),
            }
        };
        let (positive, negative) = (part(1.0)?, part(-1.0)?);
        let integral =
            |part: &Option<PiecewiseLinear>| part.as_ref().map_or(0.0, PiecewiseLinear::integral);
        let (plus, minus) = (integral(&positive), integral(&negative));
        if !(plus + minus > 0.0) {
            return Err(TableError::Zero);
        }
        Ok(Self {
            positive,
            negative,
            positive_share: plus / (plus + minus),
            absolute_integral: plus + minus,
            integral: plus - minus,
        })
    }

    /// ∫f.
    #[inline]
    pub fn integral(&self) -> f64 {
        self.integral
    }

    /// ∫|f|.
    #[inline]
    pub fn absolute_integral(&self) -> f64 {
        self.absolute_integral
    }

    /// A point with density |f| / ∫|f|, and the sign of f there, for `u` ∈ [0, 1).
    #[inline]
    pub fn sample(&self, u: f64) -> SignedSample {
        let share = self.positive_share;
        let (part, u, sign) = if u < share {
            (&self.positive, u / share, 1.0)
        } else {
            (&self.negative, (u - share) / (1.0 - share), -1.0)
        };
        let u = u.min(1.0 - f64::EPSILON);
        // A part that does not exist has no share of [0, 1).
        let x = part.as_ref().map_or(0.0, |part| part.sample(u));
        SignedSample { x, sign }
    }

    /// The density |f| / ∫|f| at `x`, per unit of length; zero outside.
    #[inline]
    pub fn density(&self, x: f64) -> f64 {
        let of = |part: &Option<PiecewiseLinear>| part.as_ref().map_or(0.0, |p| p.density(x));
        self.positive_share * of(&self.positive) + (1.0 - self.positive_share) * of(&self.negative)
    }
}
