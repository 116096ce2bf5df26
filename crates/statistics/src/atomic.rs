//! [`Fixed128`] for many writers at once: two atomic words, no lock.
//!
//! A term is split into its low and its high 64 bits. The low half is added to the low word with
//! one `fetch_add`, which returns the word's previous value and so tells this very addition
//! whether it carried; the high half and that carry are then added to the high word.
//!
//! **Why any interleaving gives the exact sum.** Each word is a sum modulo 2⁶⁴ of what was added
//! to it, and such sums do not depend on order. The low word's additions happen in *some* total
//! order (all modifications of one atomic do, for any memory ordering); along it the word
//! wraps exactly ⌊Σ low / 2⁶⁴⌋ times, and each wrap is seen by exactly one writer, who delivers
//! it to the high word. Once all writers are done, the two words therefore hold Σ modulo 2¹²⁸,
//! and the range check keeps Σ itself within ±2⁶³. Between the two additions the words do not
//! belong together; that is why [`AtomicFixed128::into_fixed`] takes the accumulator by value
//! and [`AtomicFixed128::load`] by unique reference: the borrow checker proves that no writer is
//! left, and joining the writers' threads makes their relaxed additions visible.

use crate::fault::InvalidValue;
use crate::fixed128::Fixed128;
use std::sync::atomic::{AtomicU64, Ordering};

/// A sum to which any number of threads may add at once.
///
/// Range and resolution are those of [`Fixed128`], except that the sum must stay within ±2⁶²: every
/// addition that leaves it beyond is reported as [`InvalidValue::OutOfRange`] (and kept, since the
/// other word is already written; 2¹⁴ further additions could still not wrap it).
#[derive(Debug, Default)]
pub struct AtomicFixed128 {
    low: AtomicU64,
    high: AtomicU64,
}

impl AtomicFixed128 {
    /// The empty sum.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            low: AtomicU64::new(0),
            high: AtomicU64::new(0),
        }
    }

    /// A sum that starts from `value`.
    #[must_use]
    pub const fn from_fixed(value: Fixed128) -> Self {
        let (low, high) = words(value);
        Self {
            low: AtomicU64::new(low),
            high: AtomicU64::new(high),
        }
    }

    /// Adds one term.
    ///
    /// # Errors
    /// [`InvalidValue`] where the term is not finite or out of range (it is then not added), or where
    /// the sum is beyond ±2⁶² (it is then added all the same).
    #[inline]
    pub fn add(&self, x: f32) -> Result<(), InvalidValue> {
        self.merge(Fixed128::from_f32(x)?)
    }

    /// Adds a sum of terms, which must be within ±2⁶² itself.
    ///
    /// # Errors
    /// [`InvalidValue::OutOfRange`] where `value` is beyond ±2⁶² (it is then not added), or the sum is
    /// (it is then added all the same).
    #[inline]
    pub fn merge(&self, value: Fixed128) -> Result<(), InvalidValue> {
        let (low, high) = words(value);
        if beyond(high) {
            return Err(InvalidValue::OutOfRange);
        }
        let carried = if low == 0 {
            false
        } else {
            let before = self.low.fetch_add(low, Ordering::Relaxed);
            before.checked_add(low).is_none()
        };
        let change = high.wrapping_add(u64::from(carried));
        if change == 0 {
            return Ok(());
        }
        let before = self.high.fetch_add(change, Ordering::Relaxed);
        if beyond(before.wrapping_add(change)) {
            Err(InvalidValue::OutOfRange)
        } else {
            Ok(())
        }
    }

    /// [`AtomicFixed128::merge`] without concurrent writers to this sum: plain reads and writes instead
    /// of atomic additions, which cost a multiple. (With concurrent writers, terms would be lost,
    /// nothing worse.)
    ///
    /// # Errors
    /// As [`AtomicFixed128::merge`].
    #[inline]
    pub fn merge_alone(&self, value: Fixed128) -> Result<(), InvalidValue> {
        let (low, high) = words(value);
        if beyond(high) {
            return Err(InvalidValue::OutOfRange);
        }
        let (low, carried) = self.low.load(Ordering::Relaxed).overflowing_add(low);
        let before = self.high.load(Ordering::Relaxed);
        let high = before.wrapping_add(high).wrapping_add(u64::from(carried));
        self.low.store(low, Ordering::Relaxed);
        self.high.store(high, Ordering::Relaxed);
        if beyond(high) {
            Err(InvalidValue::OutOfRange)
        } else {
            Ok(())
        }
    }

    /// The sum. No writer can be at work while the reference is unique.
    #[must_use]
    pub fn load(&mut self) -> Fixed128 {
        value(*self.low.get_mut(), *self.high.get_mut())
    }

    /// The sum, and the end of the accumulator.
    #[must_use]
    pub fn into_fixed(self) -> Fixed128 {
        value(self.low.into_inner(), self.high.into_inner())
    }

    /// Returns the sum so far and resets it to zero.
    #[must_use]
    pub fn take(&mut self) -> Fixed128 {
        let sum = self.load();
        *self = Self::new();
        sum
    }
}

/// The low and high words of a sum.
#[inline]
const fn words(value: Fixed128) -> (u64, u64) {
    let bits = value.to_bits();
    (bits as u64, (bits >> 64) as u64)
}

/// The sum of these words.
const fn value(low: u64, high: u64) -> Fixed128 {
    Fixed128::from_bits(((high as i64 as i128) << 64) | low as i128)
}

/// Whether a high word belongs to a number outside ±2⁶².
#[inline]
const fn beyond(high: u64) -> bool {
    let high = high as i64;
    high >= 1 << 62 || high < -(1 << 62)
}
