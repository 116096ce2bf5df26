//! A node of the wide tree: eight boxes, tested at once.

use super::Bounds;
use super::packet::RayPacket;
use crate::traversal_ray::TraversalRay;
use wide::f32x8;

/// Children of a wide node.
pub(super) const WIDTH: usize = 8;

/// The link to a child, in 32 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Link(pub(super) u32);

/// A [`Link`], unpacked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Target {
    /// A node.
    Node(usize),
    /// A block of triangles.
    Block(usize),
    /// A primitive that is not a triangle.
    Other(u32),
}

const KIND: u32 = 3 << 30;
const BLOCK: u32 = 1 << 30;
const OTHER: u32 = 2 << 30;
/// The largest index a link can hold.
pub(super) const MAX_INDEX: u32 = (1 << 30) - 1;

impl Link {
    pub(super) fn node(index: u32) -> Self {
        Self(index)
    }
    pub(super) fn block(index: u32) -> Self {
        Self(index | BLOCK)
    }
    pub(super) fn other(index: u32) -> Self {
        Self(index | OTHER)
    }

    #[inline(always)]
    pub(super) fn target(self) -> Target {
        let index = self.0 & !KIND;
        match self.0 & KIND {
            0 => Target::Node(index as usize),
            BLOCK => Target::Block(index as usize),
            _ => Target::Other(index),
        }
    }
}

/// Covers the relative rounding of 1/d and of t itself.
const OUTWARD: f32 = 1.0 + 4.0 * f32::EPSILON;

/// Up to eight children with their boxes; unused lanes have boxes that nothing enters.
///
/// It is 224 bytes, so that it takes four cache lines wherever it lies; aligned to one it would take as many, and be 256.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Axis, lower or upper, lane.
    planes: [[f32x8; 2]; 3],
    links: [u32; WIDTH],
}

impl Node {
    pub(super) fn new(children: &[(Bounds, Link)]) -> Self {
        // Not infinite: a ray that must hit nothing has infinite numbers itself, and their difference would be entered.
        let mut planes = [[[f32::MAX; WIDTH], [f32::MIN; WIDTH]]; 3];
        let mut links = [0; WIDTH];
        for (lane, (bounds, link)) in children.iter().enumerate() {
            let (min, max) = (bounds.min.to_array(), bounds.max.to_array());
            for (axis, [lower, upper]) in planes.iter_mut().enumerate() {
                lower[lane] = min[axis];
                upper[lane] = max[axis];
            }
            links[lane] = link.0;
        }
        Self {
            planes: planes.map(|axis| axis.map(f32x8::new)),
            links,
        }
    }

    #[inline(always)]
    pub(super) fn link(&self, lane: usize) -> Link {
        Link(self.links[lane & (WIDTH - 1)])
    }

    /// Number of children: their lanes come first. The root, number 0, is nobody's child.
    #[inline(always)]
    pub(super) fn children(&self) -> usize {
        let unused = self.links.iter().position(|&link| link == 0);
        unused.unwrap_or(WIDTH)
    }

    /// The lanes whose boxes the ray enters before `t_max`, and where. Conservative, see
    /// [`TraversalRay::new`].
    #[inline(always)]
    pub(super) fn entered(&self, probe: &TraversalRay, t_max: f32) -> (u32, f32x8) {
        let enter = |axis: usize| {
            self.planes[axis][probe.sign[axis] & 1].mul_sub(
                f32x8::splat(probe.inverse[axis]),
                f32x8::splat(probe.entered[axis]),
            )
        };
        let leave = |axis: usize| {
            self.planes[axis][(probe.sign[axis] & 1) ^ 1].mul_sub(
                f32x8::splat(probe.inverse[axis]),
                f32x8::splat(probe.left[axis]),
            )
        };
        let near = enter(0)
            .fast_max(enter(1))
            .fast_max(enter(2).fast_max(f32x8::ZERO));
        let far = leave(0)
            .fast_min(leave(1))
            .fast_min(leave(2).fast_min(f32x8::splat(t_max)));
        let inside = near.simd_le(far * f32x8::splat(OUTWARD));
        (inside.to_bitmask(), near)
    }

    /// Where rays enter the box of one child before `t_max`, and which do; the same as [`Node::entered`].
    #[inline(always)]
    pub(super) fn entered_by(
        &self,
        child: usize,
        rays: &RayPacket<'_>,
        t_max: f32x8,
    ) -> (f32x8, f32x8) {
        let plane = |axis: usize, upper: usize| {
            f32x8::splat(self.planes[axis][upper].as_array()[child & (WIDTH - 1)])
                .mul_sub(rays.inverse[axis], rays.scaled[axis][upper])
        };
        let (x0, x1) = (plane(0, 0), plane(0, 1));
        let (y0, y1) = (plane(1, 0), plane(1, 1));
        let (z0, z1) = (plane(2, 0), plane(2, 1));
        let near = (x0.fast_min(x1))
            .fast_max(y0.fast_min(y1))
            .fast_max(z0.fast_min(z1).fast_max(f32x8::ZERO));
        let far = (x0.fast_max(x1))
            .fast_min(y0.fast_max(y1))
            .fast_min(z0.fast_max(z1).fast_min(t_max));
        (near, near.simd_le(far * f32x8::splat(OUTWARD)))
    }
}
