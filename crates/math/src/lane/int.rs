//! Lanes of integers: encodings of numbers, indices, hashes, random bits.

use super::Mask;
use core::fmt::Debug;
use core::ops::{BitAnd, BitOr, BitXor, Not, Shl, Shr};

/// One 32-bit integer or a vector of them. Arithmetic is modulo 2³², so it serves for signed integers in two's
/// complement too; shifts are by less than 32 bits and, unless they say otherwise, fill up with zeros.
pub trait Int:
    Copy
    + Debug
    + Not<Output = Self>
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + BitXor<Output = Self>
    + BitAnd<u32, Output = Self>
    + BitOr<u32, Output = Self>
    + BitXor<u32, Output = Self>
    + Shl<u32, Output = Self>
    + Shr<u32, Output = Self>
{
    /// What a comparison returns.
    type Mask: Mask;

    /// The same integer in every lane.
    fn splat(value: u32) -> Self;
    /// `value(i)` in lane i.
    fn from_fn(value: impl FnMut(usize) -> u32) -> Self;
    /// The integer in lane `index`.
    fn lane(self, index: usize) -> u32;
    /// As many integers as there are lanes, the first of `from`.
    fn load(from: &[u32]) -> Self;
    /// Writes the lanes over the first integers of `to`.
    fn store(self, to: &mut [u32]);

    /// The sum.
    fn wrapping_add(self, other: Self) -> Self;
    /// The difference.
    fn wrapping_sub(self, other: Self) -> Self;
    /// The product.
    fn wrapping_mul(self, other: Self) -> Self;
    /// Shifted to the right by less than 32 bits, filling up with the sign.
    fn shift_right_signed(self, bits: u32) -> Self;

    /// Whether `self` = `other`.
    fn eq(self, other: Self) -> Self::Mask;
    /// Whether `self` < `other`, as unsigned integers.
    fn lt(self, other: Self) -> Self::Mask;
}
