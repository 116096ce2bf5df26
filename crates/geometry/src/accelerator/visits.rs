//! Counts of visited nodes and primitives, for comparing accelerators.

use core::cell::Cell;

/// The visits of a ray, in the accelerators of all groups that it entered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Visits {
    /// Nodes.
    pub nodes: u64,
    /// Triangles and other primitives; instances among them.
    pub primitives: u64,
}

/// Counts the nodes and primitives that a ray visits.
pub(crate) trait Counter {
    /// A node.
    fn node(&self);
    /// Counts primitives; their number is evaluated only by counters that need it.
    fn primitives(&self, how_many: impl FnOnce() -> usize);
}

/// Does not count, at no cost.
pub(crate) struct Uncounted;

impl Counter for Uncounted {
    #[inline(always)]
    fn node(&self) {}
    #[inline(always)]
    fn primitives(&self, _: impl FnOnce() -> usize) {}
}

impl Counter for Cell<Visits> {
    fn node(&self) {
        let before = self.get();
        self.set(Visits {
            nodes: before.nodes + 1,
            ..before
        });
    }

    fn primitives(&self, how_many: impl FnOnce() -> usize) {
        let before = self.get();
        self.set(Visits {
            primitives: before.primitives + how_many() as u64,
            ..before
        });
    }
}
