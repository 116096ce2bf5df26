//! Who watches a search for what a ray meets: nobody, a count for comparing accelerators, or one who lets the ray pass some shapes.

use core::cell::Cell;
use etalon_transport::ShapeId;

/// Watches a search.
pub(crate) trait Observer {
    /// A node is visited.
    fn node(&self);
    /// Primitives are; their number is evaluated only by observers that need it.
    fn primitives(&self, how_many: impl FnOnce() -> usize);
    /// A search for anything met a shape: whether it ends there.
    fn stops(&self, shape: impl FnOnce() -> ShapeId) -> bool;
}

/// Does not watch, at no cost. Any shape stops a ray.
pub(crate) struct Unobserved;

impl Observer for Unobserved {
    #[inline(always)]
    fn node(&self) {}
    #[inline(always)]
    fn primitives(&self, _: impl FnOnce() -> usize) {}
    #[inline(always)]
    fn stops(&self, _: impl FnOnce() -> ShapeId) -> bool {
        true
    }
}

/// The visits of a ray, in the accelerators of all groups that it entered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Visits {
    /// Nodes.
    pub nodes: u64,
    /// Triangles and other primitives; instances among them.
    pub primitives: u64,
}

impl Observer for Cell<Visits> {
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

    fn stops(&self, _: impl FnOnce() -> ShapeId) -> bool {
        true
    }
}

/// What lies strictly between the ends of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Obstruction {
    /// Nothing.
    Nothing,
    /// Shapes that are not opaque.
    Passable,
    /// An opaque shape, and perhaps others.
    Opaque,
}

/// Lets a ray pass shapes that are not opaque.
pub(crate) struct Passing<Q> {
    /// Whether a shape is opaque.
    pub(crate) is_opaque: Q,
    /// Whether the ray has passed any.
    pub(crate) passed: Cell<bool>,
}

impl<Q: Fn(ShapeId) -> bool> Observer for Passing<Q> {
    #[inline(always)]
    fn node(&self) {}
    #[inline(always)]
    fn primitives(&self, _: impl FnOnce() -> usize) {}
    #[inline]
    fn stops(&self, shape: impl FnOnce() -> ShapeId) -> bool {
        let stops = (self.is_opaque)(shape());
        self.passed.set(self.passed.get() | !stops);
        stops
    }
}
