//! Trees of boxes that are tested one at a time, for the binary BVH and the octree.
//!
//! A builder decides how a region with its primitives is divided; a leaf stores its triangles in blocks. Nodes are
//! visited from the nearest box to the farthest, and not beyond the nearest hit.

use super::block::{Block, LANES};
use super::observer::Observer;
use super::{Bounds, CustomPrimitives, Primitives, block_bytes, has_area};
use crate::closest_hit::ClosestHit;
use crate::traversal_ray::TraversalRay;

/// A part of space.
pub(super) struct Part {
    pub(super) bounds: Bounds,
    /// Its primitives.
    pub(super) items: Vec<u32>,
    /// How often each may still be duplicated in parts of this one, on average; for builders that duplicate.
    pub(super) credit: f32,
}

/// Levels below the root at most, so that the stack below is enough.
pub(super) const DEEPEST: usize = 60;

/// Boxes that wait: seven for each of at most [`DEEPEST`]/2 levels of an octree, or one for each of a binary tree.
const STACK: usize = 256;

/// A box with its children, or with its triangles and other primitives.
#[derive(Clone, Copy, Debug)]
struct BoxNode {
    bounds: Bounds,
    /// First, and how many.
    children: [u32; 2],
    blocks: [u32; 2],
    others: [u32; 2],
}

impl BoxNode {
    /// A box with nothing in it yet.
    fn around(bounds: Bounds) -> Self {
        Self {
            bounds,
            children: [0; 2],
            blocks: [0; 2],
            others: [0; 2],
        }
    }
}

/// A tree of boxes.
#[derive(Debug, Default)]
pub(crate) struct BoxTree {
    nodes: Vec<BoxNode>,
    blocks: Vec<Block>,
    others: Vec<u32>,
}

/// The primitives while a tree is built.
struct Items<'a, P> {
    primitives: &'a P,
    /// The box of each item, …
    boxes: Vec<Bounds>,
    /// … and which primitive it is.
    of: Vec<u32>,
}

impl BoxTree {
    /// The tree of all primitives except degenerate triangles and unbounded shapes. `divide` maps all boxes, a part and
    /// its level to the parts that it is divided into: none for a leaf.
    pub(super) fn build(
        primitives: &impl Primitives,
        divide: impl Fn(&[Bounds], &Part, usize) -> Vec<Part>,
    ) -> Self {
        let mut items = Items {
            primitives,
            boxes: Vec::new(),
            of: Vec::new(),
        };
        for primitive in 0..primitives.len() as u32 {
            let (bounds, counts) = match primitives.triangle(primitive) {
                Some(corners) => (Bounds::around(&corners), has_area(&corners)),
                None => {
                    let bounds = primitives.bounds(primitive);
                    (bounds, !bounds.is_endless())
                }
            };
            if counts {
                items.boxes.push(bounds);
                items.of.push(primitive);
            }
        }
        let mut tree = Self::default();
        if items.boxes.is_empty() {
            return tree;
        }
        let all = (items.boxes.iter()).fold(Bounds::EMPTY, |all, bounds| all.union(*bounds));
        let whole = Part {
            bounds: all,
            items: (0..items.boxes.len() as u32).collect(),
            credit: 0.0,
        };
        tree.nodes.push(BoxNode::around(all));
        tree.fill(0, whole, 0, &items, &divide);
        tree
    }

    fn fill(
        &mut self,
        index: usize,
        part: Part,
        depth: usize,
        items: &Items<'_, impl Primitives>,
        divide: &impl Fn(&[Bounds], &Part, usize) -> Vec<Part>,
    ) {
        let tight = (part.items.iter()).fold(Bounds::EMPTY, |all, &item| {
            all.union(items.boxes[item as usize])
        });
        let mut node = BoxNode::around(Bounds {
            min: tight.min.max(part.bounds.min),
            max: tight.max.min(part.bounds.max),
        });
        let parts = match depth < DEEPEST {
            true => divide(&items.boxes, &part, depth),
            false => Vec::new(),
        };
        if parts.is_empty() {
            self.fill_leaf(&mut node, &part.items, items);
            self.nodes[index] = node;
            return;
        }
        let first = self.nodes.len();
        node.children = [first as u32, parts.len() as u32];
        self.nodes[index] = node;
        self.nodes.resize(first + parts.len(), node);
        for (child, part) in parts.into_iter().enumerate() {
            self.fill(first + child, part, depth + 1, items, divide);
        }
    }

    fn fill_leaf(&mut self, node: &mut BoxNode, list: &[u32], items: &Items<'_, impl Primitives>) {
        let (first_block, first_other) = (self.blocks.len(), self.others.len());
        let mut triangles = Vec::new();
        for &item in list {
            let primitive = items.of[item as usize];
            match items.primitives.triangle(primitive) {
                Some(corners) => triangles.push((corners, primitive)),
                None => self.others.push(primitive),
            }
        }
        let blocks = triangles
            .chunks(LANES)
            .map(|chunk| Block::new(chunk.iter().copied()));
        self.blocks.extend(blocks);
        let span = |first: usize, end: usize| [first as u32, (end - first) as u32];
        node.blocks = span(first_block, self.blocks.len());
        node.others = span(first_other, self.others.len());
    }

    /// Updates the nearest hit.
    #[inline]
    pub(crate) fn intersect(
        &self,
        probe: &TraversalRay,
        others: &impl CustomPrimitives,
        nearest: &mut ClosestHit,
    ) {
        let observer = others.observer();
        let mut asked = Asked::default();
        let mut stack = [(0.0_f32, 0_u32); STACK];
        let mut top = usize::from(!self.nodes.is_empty());
        while top > 0 {
            top -= 1;
            let (near, index) = stack[top];
            if near > nearest.t {
                continue;
            }
            let node = &self.nodes[index as usize];
            observer.node();
            for block in span(node.blocks) {
                observer.primitives(|| self.blocks[block].len());
                self.blocks[block].intersect(block, probe, nearest);
            }
            for other in span(node.others) {
                if asked.is_new(self.others[other]) {
                    observer.primitives(|| 1);
                    others.intersect(self.others[other], probe, nearest);
                }
            }
            let base = top;
            for child in span(node.children) {
                let Some(near) = entered(&self.nodes[child].bounds, probe, nearest.t) else {
                    continue;
                };
                // The nearest on top.
                let mut slot = top;
                while slot > base && stack[slot - 1].0 < near {
                    stack[slot] = stack[slot - 1];
                    slot -= 1;
                }
                stack[slot] = (near, child as u32);
                top += 1;
            }
        }
    }

    /// Whether anything is hit before `t_max`.
    #[inline]
    pub(crate) fn occluded(
        &self,
        probe: &TraversalRay,
        others: &impl CustomPrimitives,
        t_max: f32,
    ) -> bool {
        let observer = others.observer();
        let mut asked = Asked::default();
        let mut stack = [0_u32; STACK];
        let mut top = usize::from(!self.nodes.is_empty());
        while top > 0 {
            top -= 1;
            let node = &self.nodes[stack[top] as usize];
            observer.node();
            let hits_block = |block: usize| {
                observer.primitives(|| self.blocks[block].len());
                let stops = |primitive| others.stops(primitive);
                self.blocks[block].occludes(probe, t_max, stops)
            };
            let mut hits_other = |other: usize| {
                asked.is_new(self.others[other]) && {
                    observer.primitives(|| 1);
                    others.occludes(self.others[other], probe, t_max)
                }
            };
            if span(node.blocks).any(hits_block) || span(node.others).any(&mut hits_other) {
                return true;
            }
            for child in span(node.children) {
                if entered(&self.nodes[child].bounds, probe, t_max).is_some() {
                    stack[top] = child as u32;
                    top += 1;
                }
            }
        }
        false
    }

    pub(crate) fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    pub(crate) fn nodes(&self) -> usize {
        self.nodes.len()
    }

    pub(crate) fn bytes(&self) -> usize {
        block_bytes(&self.blocks)
            + size_of_val(self.nodes.as_slice())
            + size_of_val(self.others.as_slice())
    }
}

/// What a ray was tested against last, as an octree's neighbouring cells repeat it: a mailbox (Amanatides & Woo 1987, "A
/// Fast Voxel Traversal Algorithm for Ray Tracing", section 3) that belongs to the ray.
struct Asked {
    last: [u32; Self::ROOM],
    next: usize,
}

impl Asked {
    const ROOM: usize = 16;

    /// Whether it is not among the last, which it now is.
    #[inline]
    fn is_new(&mut self, primitive: u32) -> bool {
        let new = !self.last.contains(&primitive);
        if new {
            self.last[self.next] = primitive;
            self.next = (self.next + 1) % Self::ROOM;
        }
        new
    }
}

impl Default for Asked {
    fn default() -> Self {
        Self {
            last: [u32::MAX; Self::ROOM],
            next: 0,
        }
    }
}

#[inline]
fn span([first, count]: [u32; 2]) -> core::ops::Range<usize> {
    first as usize..(first + count) as usize
}

/// The entry of a ray into a box, if before `t_max`; conservative, as in the wide tree.
#[inline]
fn entered(bounds: &Bounds, probe: &TraversalRay, t_max: f32) -> Option<f32> {
    const OUTWARD: f32 = 1.0 + 4.0 * f32::EPSILON;
    let planes = [bounds.min, bounds.max];
    let (mut near, mut far) = (0.0_f32, t_max);
    for (axis, inverse) in probe.inverse.into_iter().enumerate() {
        let side = probe.sign[axis] & 1;
        let enter = planes[side][axis].mul_add(inverse, -probe.entered[axis]);
        let leave = planes[side ^ 1][axis].mul_add(inverse, -probe.left[axis]);
        near = near.max(enter);
        far = far.min(leave);
    }
    (near <= far * OUTWARD).then_some(near)
}
