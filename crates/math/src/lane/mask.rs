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

impl<M: Mask + Select<A> + Select<B>, A, B> Select<(A, B)> for M {
    #[inline(always)]
    fn select(self, yes: (A, B), no: (A, B)) -> (A, B) {
        (self.select(yes.0, no.0), self.select(yes.1, no.1))
    }
}

impl<M: Mask + Select<A> + Select<B> + Select<C>, A, B, C> Select<(A, B, C)> for M {
    #[inline(always)]
    fn select(self, yes: (A, B, C), no: (A, B, C)) -> (A, B, C) {
        let (a, b) = self.select((yes.0, yes.1), (no.0, no.1));
        (a, b, self.select(yes.2, no.2))
    }
}

impl<M: Mask + Select<T>, T> Select<[T; 2]> for M {
    #[inline(always)]
    fn select(self, [a, b]: [T; 2], [c, d]: [T; 2]) -> [T; 2] {
        [self.select(a, c), self.select(b, d)]
    }
}

/// `$yes` in the lanes where `$mask` says yes, `$no` in the others; a side that no lane takes is not evaluated.
///
/// A macro, since the bodies of closures are not certain to be inlined.
#[macro_export]
macro_rules! branch {
    ($mask:expr, $yes:expr, $no:expr $(,)?) => {{
        let mask = $mask;
        let yes = if $crate::lane::Mask::any(mask) {
            Some($yes)
        } else {
            None
        };
        let no = if $crate::lane::Mask::all(mask) {
            None
        } else {
            Some($no)
        };
        match (yes, no) {
            (Some(yes), Some(no)) => $crate::lane::Select::select(mask, yes, no),
            (Some(only), None) | (None, Some(only)) => only,
            (None, None) => unreachable!("a lane says yes or no"),
        }
    }};
}
