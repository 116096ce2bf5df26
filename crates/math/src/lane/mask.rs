//! What comparisons of lanes return, and what chooses by it.

use core::fmt::Debug;
use core::ops::{BitAnd, BitOr, BitXor, Not};

/// Yes or no in every lane.
pub trait Mask:
    Copy
    + Debug
    + Not<Output = Self>
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + BitXor<Output = Self>
{
    /// The same in every lane.
    fn splat(value: bool) -> Self;
    /// `value(i)` in lane i.
    fn from_fn(value: impl FnMut(usize) -> bool) -> Self;
    /// Lane i as bit i.
    fn bits(self) -> u32;
    /// Whether any lane says yes.
    fn any(self) -> bool;
    /// Whether all lanes say yes.
    fn all(self) -> bool;
    /// What lane `index` says.
    #[inline(always)]
    fn lane(self, index: usize) -> bool {
        self.bits() >> index & 1 != 0
    }
}

/// A choice between two values, lane by lane.
pub trait Select<T> {
    /// `yes` in the lanes that say yes, `no` in the others.
    fn select(self, yes: T, no: T) -> T;
}
