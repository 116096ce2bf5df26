//! An exact, associative accumulator: 128-bit fixed point with 64 fractional bits.
//!
//! A floating-point sum depends on the order of its terms, so an image summed by eight threads
//! differs from one summed by two. [`Fixed128`] adds integers instead: every term is rounded
//! once to the nearest multiple of 2⁻⁶⁴ ≈ 5.4 · 10⁻²⁰ (ties to even), a rounding that depends on
//! the term alone, and from there on addition is exact, commutative and associative.
//!
//! **Range.** A term must satisfy |x| < 2⁴⁸ ≈ 2.8 · 10¹⁴ ([`LIMIT`]); a sum may reach
//! ±2⁶³ ≈ 9.2 · 10¹⁸. Hence 2¹⁵ terms of the greatest size, or any number of terms whose
//! magnitudes add up to less than 2⁶³, are summed exactly in any order. Other values are
//! refused with an [`InvalidValue`], which leaves the sum as it was; nothing wraps or saturates.
//!
//! **Resolution.** An `f32` of magnitude at least 2⁻⁴¹ ≈ 4.5 · 10⁻¹³ and an `f64` of at least
//! 2⁻¹² are held without any rounding.

use crate::fault::InvalidValue;
use crate::u256::U256;

/// Terms must be smaller in magnitude than this: 2⁴⁸.
pub const LIMIT: f64 = 281_474_976_710_656.0;

/// An exact sum of floating-point numbers; see the [module](self) for range and resolution.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Fixed128(i128);

impl Fixed128 {
    /// The empty sum.
    pub const ZERO: Self = Self(0);

    /// The number nearest to `x`, ties to even.
    ///
    /// # Errors
    /// [`InvalidValue`] where `x` is not finite or not smaller than [`LIMIT`] in magnitude.
    #[inline]
    pub fn from_f32(x: f32) -> Result<Self, InvalidValue> {
        let bits = x.to_bits();
        let exponent = (bits >> 23) & 0xff;
        let mantissa = (bits & 0x7f_ffff) | 0x80_0000;
        // A normal number is mantissa · 2^(exponent − 150), so its integer is
        // mantissa · 2^(exponent − 86): a plain shift to the left from 2⁻⁴¹ to the limit.
        let shift = exponent.wrapping_sub(86);
        if shift < 127 + 48 - 86 {
            Ok(Self(with_sign(
                i128::from(mantissa) << shift,
                bits >> 31 != 0,
            )))
        } else {
            Self::from_f32_slowly(x)
        }
    }

    /// Zero, small and unusable numbers.
    fn from_f32_slowly(x: f32) -> Result<Self, InvalidValue> {
        if x == 0.0 {
            return Ok(Self::ZERO);
        }
        // Every f32 is an f64.
        Self::from_f64(f64::from(x))
    }

    /// The number nearest to `x`, ties to even.
    ///
    /// # Errors
    /// [`InvalidValue`] where `x` is not finite or not smaller than [`LIMIT`] in magnitude.
    #[inline]
    pub fn from_f64(x: f64) -> Result<Self, InvalidValue> {
        if !(x.abs() < LIMIT) {
            return Err(InvalidValue::of(x));
        }
        let bits = x.to_bits();
        let exponent = ((bits >> 52) & 0x7ff) as u32;
        let mantissa = (bits & 0xf_ffff_ffff_ffff) | (u64::from(exponent != 0) << 52);
        // The integer is mantissa · 2^(exponent − 1011).
        let magnitude = if exponent >= 1011 {
            i128::from(mantissa) << (exponent - 1011)
        } else {
            i128::from(shift_right_to_nearest(mantissa, 1011 - exponent))
        };
        Ok(Self(with_sign(magnitude, bits >> 63 != 0)))
    }

    /// Adds one term.
    ///
    /// # Errors
    /// [`InvalidValue`] where the term is not finite, is out of range, or would take the sum out of
    /// range. The sum is then unchanged.
    #[inline]
    pub fn add(&mut self, x: f32) -> Result<(), InvalidValue> {
        self.merge(Self::from_f32(x)?)
    }

    /// Adds another sum.
    ///
    /// # Errors
    /// [`InvalidValue::OutOfRange`] where the result would reach ±2⁶³. The sum is then unchanged.
    #[inline]
    pub fn merge(&mut self, other: Self) -> Result<(), InvalidValue> {
        self.0 = self
            .0
            .checked_add(other.0)
            .ok_or(InvalidValue::OutOfRange)?;
        Ok(())
    }

    /// The sum, correctly rounded.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        self.0 as f64 * EPSILON
    }

    /// The sum divided by `count`, correctly rounded; NaN for a `count` of zero.
    #[must_use]
    pub fn mean(self, count: u64) -> f64 {
        if count == 0 {
            return f64::NAN;
        }
        // 128 further bits leave at least 64 in the quotient of anything but zero; what is left
        // after them only matters by being there.
        let (quotient, rest) =
            U256::from_words(self.0.unsigned_abs(), 0).divided_by(u128::from(count));
        let magnitude = quotient.to_f64_sticky(rest != 0) * (EPSILON * EPSILON * EPSILON);
        if self.0 < 0 { -magnitude } else { magnitude }
    }

    /// The sum divided by `count`, rounded to the nearest multiple of 2⁻⁶⁴, ties to even; zero
    /// for a `count` of zero.
    #[must_use]
    pub fn mean_fixed(self, count: u64) -> Self {
        if count == 0 {
            return Self::ZERO;
        }
        let magnitude = self.0.unsigned_abs();
        let (divisor, count) = (count, u128::from(count));
        let (quotient, rest) = match divisor.is_power_of_two() {
            // Without a division of 128 bits, which is slow.
            true => (
                magnitude >> divisor.trailing_zeros(),
                magnitude & (count - 1),
            ),
            false => (magnitude / count, magnitude % count),
        };
        let up = 2 * rest > count || (2 * rest == count && quotient & 1 == 1);
        let rounded = (quotient + u128::from(up)) as i128;
        Self(with_sign(rounded, self.0 < 0))
    }

    /// The integer behind the sum, in units of 2⁻⁶⁴.
    #[must_use]
    #[inline]
    pub const fn to_bits(self) -> i128 {
        self.0
    }

    /// The sum with this integer, in units of 2⁻⁶⁴.
    #[must_use]
    #[inline]
    pub const fn from_bits(bits: i128) -> Self {
        Self(bits)
    }
}

/// 2⁻⁶⁴, the unit of [`Fixed128`].
pub(crate) const EPSILON: f64 = 1.0 / 18_446_744_073_709_551_616.0;

/// ±`magnitude` without a branch.
#[inline]
fn with_sign(magnitude: i128, negative: bool) -> i128 {
    let mask = -i128::from(negative);
    (magnitude ^ mask) - mask
}

/// `mantissa` · 2^−`shift`, to the nearest integer, ties to even.
fn shift_right_to_nearest(mantissa: u64, shift: u32) -> u64 {
    // A mantissa has 53 bits: from here on it is below one half.
    if shift >= 54 {
        return 0;
    }
    let quotient = mantissa >> shift;
    let rest = mantissa & ((1 << shift) - 1);
    let half = 1 << (shift - 1);
    quotient + u64::from(rest > half || (rest == half && quotient & 1 == 1))
}
