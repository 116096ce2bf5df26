//! The nearest hit so far, and the order of hits at the same distance.
//!
//! Two smooth shapes may be closer than single precision resolves, as water in a glass. Their order is
//! decided in double precision.

use glam::Vec2;

/// The nearest hit so far.
///
/// Of two hits at equal t the one with the lower primitive wins; primitives are numbered in the
/// order in which shapes, then instances, were added, and within a mesh in the order of its
/// triangles. Within an instance the order of the group's shapes decides. This is a total order,
/// so the winner does not depend on the order in which an accelerator visits primitives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClosestHit {
    /// Distance in units of the direction's length, not below 0.
    pub(crate) t: f32,
    /// The same of a smooth shape to double precision; NaN of anything else.
    pub(crate) exact: f64,
    /// Primitive of the accelerator.
    pub(crate) primitive: u32,
    /// Primitive of the innermost group's accelerator, if `primitive` is an instance.
    pub(crate) inner: u32,
    /// Which of the accelerator's placements of groups it lies in, if `primitive` is an instance, see
    /// [`Group`](crate::geometry::Group).
    pub(crate) path: u32,
    /// Index of the triangle in the accelerator: its block times their size, plus its lane.
    pub(crate) slot: u32,
    /// Barycentric coordinates on a triangle.
    pub(crate) parameters: Vec2,
    /// Whether anything was hit.
    pub(crate) found: bool,
}

/// A distance in single precision; 0 for what lies just behind the origin, see
/// [`Departure`](etalon_transport::Departure).
#[inline]
fn single(t: f64) -> f32 {
    (t as f32).max(0.0)
}

impl ClosestHit {
    /// Nothing yet, and nothing at or beyond `t_max` will count.
    #[inline]
    pub(crate) fn within(t_max: f32) -> Self {
        Self {
            t: t_max,
            exact: f64::NAN,
            primitive: 0,
            inner: 0,
            path: 0,
            slot: 0,
            parameters: Vec2::ZERO,
            found: false,
        }
    }

    /// The nearest hit as a bound for the inside of the instance that is primitive `instance`.
    #[inline]
    pub(crate) fn inside(&self, instance: u32) -> Self {
        let ties_win = self.found && instance < self.primitive;
        Self {
            primitive: if ties_win { u32::MAX } else { 0 },
            found: false,
            ..*self
        }
    }

    /// Notes what was found inside of the instance `instance`, whose group's placements are numbered from `first`.
    #[inline]
    pub(crate) fn set_inside(&mut self, instance: u32, first: u32, inside: &Self) {
        if inside.found {
            // The group's own placement is number 0.
            let nested = inside.path > 0;
            *self = Self {
                primitive: instance,
                inner: if nested {
                    inside.inner
                } else {
                    inside.primitive
                },
                path: first + inside.path,
                ..*inside
            };
        }
    }

    /// Whether a hit at `t` would win.
    #[inline]
    pub(crate) fn loses_to(&self, t: f32, primitive: u32) -> bool {
        t < self.t || (t == self.t && primitive < self.primitive)
    }

    /// Whether a hit of a smooth shape would win. Two smooth shapes are compared in double precision;
    /// within `tolerance` they coincide, and `precedes` decides whether the new one is before the
    /// nearest so far.
    #[inline]
    pub(crate) fn loses_to_smooth(
        &self,
        t: f64,
        primitive: u32,
        tolerance: f64,
        precedes: impl FnOnce(u32) -> bool,
    ) -> bool {
        if !self.found || self.exact.is_nan() {
            return self.loses_to(single(t), primitive);
        }
        let ahead = self.exact - t;
        if ahead.abs() <= tolerance {
            precedes(self.primitive)
        } else {
            ahead > 0.0
        }
    }

    /// Notes a hit of a smooth shape that wins.
    #[inline]
    pub(crate) fn set_smooth(&mut self, t: f64, primitive: u32) {
        self.set(single(t), primitive, 0, Vec2::ZERO);
        self.exact = t;
    }

    /// Notes a hit that wins.
    #[inline]
    pub(crate) fn set(&mut self, t: f32, primitive: u32, slot: u32, parameters: Vec2) {
        *self = Self {
            t,
            exact: f64::NAN,
            primitive,
            inner: 0,
            path: 0,
            slot,
            parameters,
            found: true,
        };
    }
}
