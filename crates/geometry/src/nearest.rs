//! The nearest hit so far, and which of two hits at the same distance wins.

use glam::Vec2;

/// The nearest hit so far.
///
/// Of two hits at equal t the one with the lower primitive wins; primitives are numbered in the
/// order in which shapes, then instances, were added, and within a mesh in the order of its
/// triangles. Within an instance the order of the group's shapes decides. This is a total order,
/// so the winner does not depend on the order in which an accelerator visits primitives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    /// Distance in units of the direction's length.
    pub(crate) t: f32,
    /// Primitive of the accelerator.
    pub(crate) primitive: u32,
    /// Primitive of the group's accelerator, if `primitive` is an instance.
    pub(crate) inner: u32,
    /// Where the accelerator keeps the triangle: its block times their size, plus its lane.
    pub(crate) slot: u32,
    /// Barycentric coordinates on a triangle.
    pub(crate) parameters: Vec2,
    /// Whether anything was hit.
    pub(crate) found: bool,
}

impl Nearest {
    /// Nothing yet, and nothing at or beyond `t_max` will count.
    #[inline]
    pub(crate) fn within(t_max: f32) -> Self {
        Self {
            t: t_max,
            primitive: 0,
            inner: 0,
            slot: 0,
            parameters: Vec2::ZERO,
            found: false,
        }
    }

    /// What may still win inside of an instance that is primitive `instance`.
    #[inline]
    pub(crate) fn inside(&self, instance: u32) -> Self {
        let ties_win = self.found && instance < self.primitive;
        Self {
            primitive: if ties_win { u32::MAX } else { 0 },
            found: false,
            ..*self
        }
    }

    /// Whether a hit at `t` would win.
    #[inline]
    pub(crate) fn loses_to(&self, t: f32, primitive: u32) -> bool {
        t < self.t || (t == self.t && primitive < self.primitive)
    }

    /// Notes a hit that wins.
    #[inline]
    pub(crate) fn set(&mut self, t: f32, primitive: u32, slot: u32, parameters: Vec2) {
        *self = Self {
            t,
            primitive,
            inner: 0,
            slot,
            parameters,
            found: true,
        };
    }
}
