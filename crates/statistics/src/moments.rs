//! Exact, mergeable mean and variance of replicates.
//!
//! For x₁ … xₙ in fixed point, S = Σxᵢ and Q = Σxᵢ² are kept as integers, so
//!
//! mean = S / n,  variance = (n·Q − S²) / (n·(n − 1))
//!
//! suffer no cancellation, and merging is exact, commutative and associative: the moments of an
//! image do not depend on the order in which its replicates were finished or its parts merged.

use crate::fault::InvalidValue;
use crate::fixed128::{EPSILON, Fixed128, LIMIT};
use crate::summary::Summary;
use crate::u256::U256;

/// Number, sum and sum of squares of replicates; 64 bytes.
///
/// Each replicate must be smaller than [`LIMIT`] in magnitude; then up to 2¹⁵ of any size, or
/// up to 2³² while their magnitudes add up to less than 2⁶³, are held exactly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Moments {
    count: u32,
    sum: Fixed128,
    squares: U256,
}

impl Moments {
    /// Of nothing.
    pub const ZERO: Self = Self {
        count: 0,
        sum: Fixed128::ZERO,
        squares: U256::ZERO,
    };

    /// Adds one replicate.
    ///
    /// # Errors
    /// [`InvalidValue::OutOfRange`] where it or the sum is too large; nothing is changed then.
    pub fn push(&mut self, x: Fixed128) -> Result<(), InvalidValue> {
        let magnitude = x.to_bits().unsigned_abs();
        if magnitude >= (LIMIT as u128) << 64 {
            return Err(InvalidValue::OutOfRange);
        }
        self.merge(&Self {
            count: 1,
            sum: x,
            squares: U256::from_product(magnitude, magnitude),
        })
    }

    /// Adds one replicate, rounded to the nearest multiple of 2⁻⁶⁴.
    ///
    /// # Errors
    /// [`InvalidValue`] where it is not finite or the sum is too large; nothing is changed then.
    pub fn push_f64(&mut self, x: f64) -> Result<(), InvalidValue> {
        self.push(Fixed128::from_f64(x)?)
    }

    /// Adds the replicates of another.
    ///
    /// # Errors
    /// [`InvalidValue::OutOfRange`] where the result does not fit; nothing is changed then.
    pub fn merge(&mut self, other: &Self) -> Result<(), InvalidValue> {
        let count = self.count.checked_add(other.count);
        let mut sum = self.sum;
        sum.merge(other.sum)?;
        let squares = self.squares.checked_add(other.squares);
        *self = Self {
            count: count.ok_or(InvalidValue::OutOfRange)?,
            sum,
            squares: squares.ok_or(InvalidValue::OutOfRange)?,
        };
        Ok(())
    }

    /// The number of replicates.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.count
    }

    /// The sum of the replicates.
    #[must_use]
    pub fn sum(&self) -> Fixed128 {
        self.sum
    }

    /// The sum of the replicates' squares, in units of 2⁻¹²⁸.
    #[must_use]
    pub fn squares(&self) -> U256 {
        self.squares
    }

    /// The moments with these parts, as a checkpoint kept them. `None` where no replicates can
    /// have them (n·Q < S²).
    #[must_use]
    pub fn from_parts(count: u32, sum: Fixed128, squares: U256) -> Option<Self> {
        let moments = Self {
            count,
            sum,
            squares,
        };
        let consistent = if count == 0 {
            sum == Fixed128::ZERO && squares == U256::ZERO
        } else {
            moments.deviation().is_some()
        };
        consistent.then_some(moments)
    }

    /// The mean, correctly rounded; NaN of nothing.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.sum.mean(u64::from(self.count))
    }

    /// The unbiased variance of one replicate; `None` of fewer than two.
    #[must_use]
    pub fn variance(&self) -> Option<f64> {
        if self.count < 2 {
            return None;
        }
        let n = f64::from(self.count);
        let deviation = self.deviation()?.to_f64() * EPSILON * EPSILON;
        Some(deviation / (n * (n - 1.0)))
    }

    /// The standard error of the mean; `None` of fewer than two replicates.
    #[must_use]
    pub fn standard_error(&self) -> Option<f64> {
        Some((self.variance()? / f64::from(self.count)).sqrt())
    }

    /// Number, mean and variance, for tests; `None` of fewer than two replicates.
    #[must_use]
    pub fn summary(&self) -> Option<Summary> {
        Summary::new(self.count.into(), self.mean(), self.variance()?)
    }

    /// n·Q − S², in units of 2⁻¹²⁸. `None` only for parts that do not belong together.
    fn deviation(&self) -> Option<U256> {
        let magnitude = self.sum.to_bits().unsigned_abs();
        self.squares
            .checked_mul(self.count.into())?
            .checked_sub(U256::from_product(magnitude, magnitude))
    }
}
