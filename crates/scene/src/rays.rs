//! Counting rays without a shared counter in the hot path.

use std::cell::Cell;

thread_local! {
    static RAYS: Cell<u64> = const { Cell::new(0) };
}

/// Counts one ray of the calling thread.
#[inline]
pub(crate) fn count() {
    count_many(1);
}

/// Counts rays of the calling thread.
#[inline]
pub(crate) fn count_many(how_many: usize) {
    RAYS.with(|rays| rays.set(rays.get() + how_many as u64));
}

/// The calling thread's count since it was last taken.
pub(crate) fn take() -> u64 {
    RAYS.with(Cell::take)
}
