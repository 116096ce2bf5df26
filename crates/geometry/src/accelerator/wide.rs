//! A bounding volume hierarchy with eight children per node and up to eight triangles per leaf.
//!
//! A binary tree ([`BinaryTree`]) is collapsed by dynamic programming ([`Choices`]) and packed
//! into [`Node`]s and [`Block`]s. Rays visit children near first.

use super::binary::BinaryTree;
use super::block::Block;
use super::choices::{self, Choices};
use super::node::{Link, Target, WIDTH};
use super::observer::Observer;
use super::pack::{Packed, pack};
use super::{CustomPrimitives, Primitives, block_bytes};
use crate::closest_hit::ClosestHit;
use crate::traversal_ray::TraversalRay;
use core::hint::black_box;

/// The tree.
#[derive(Debug)]
pub(crate) struct Wide(pub(super) Packed);

/// Room on a ray's stack: a node takes one entry off and puts up to eight on it.
pub(super) const fn stack_for(depth: usize) -> usize {
    (WIDTH - 1) * depth + 1
}
/// Runs a search with a stack for the depth of the tree. A stack is cleared for every ray, so it should not be larger
/// than it must: that of the deepest trees costs as much as the search itself.
macro_rules! with_stack {
    ($self:ident.$search:ident($($argument:expr),*)) => {
        match $self.0.depth {
            0..=2 => $self.$search::<{ stack_for(2) }>($($argument),*),
            3..=9 => $self.$search::<{ stack_for(9) }>($($argument),*),
            10..=14 => $self.$search::<{ stack_for(14) }>($($argument),*),
            15..=24 => $self.$search::<{ stack_for(24) }>($($argument),*),
            _ => $self.$search::<{ stack_for(MAX_DEPTH) }>($($argument),*),
        }
    };
}

pub(super) use with_stack;

/// A wide tree is not deeper than the binary one, except below primitives with equal boxes, of which
/// there are fewer than 8¹¹.
pub(super) const MAX_DEPTH: usize = choices::MAX_DEPTH as usize + 12;

impl Wide {
    pub(crate) fn build(primitives: &impl Primitives) -> Self {
        let mut tree = BinaryTree::build(primitives);
        let choices = Choices::make(&tree, primitives).unwrap_or_else(|| {
            tree = core::mem::take(&mut tree).balanced();
            Choices::make(&tree, primitives).expect("a balanced tree is shallow")
        });
        let packed = pack(&tree, &choices, primitives);
        assert!(
            packed.depth <= MAX_DEPTH,
            "a tree of {} levels overflows the stack",
            packed.depth
        );
        Self(packed)
    }

    /// Updates the nearest hit.
    #[inline]
    pub(crate) fn intersect(
        &self,
        probe: &TraversalRay,
        others: &impl CustomPrimitives,
        nearest: &mut ClosestHit,
    ) {
        with_stack!(self.find_nearest(probe, others, nearest))
    }

    /// Whether anything is hit before `t_max`.
    #[inline]
    pub(crate) fn occluded(
        &self,
        probe: &TraversalRay,
        others: &impl CustomPrimitives,
        t_max: f32,
    ) -> bool {
        with_stack!(self.find_any(probe, others, t_max))
    }

    #[inline]
    fn find_nearest<const STACK: usize>(
        &self,
        probe: &TraversalRay,
        others: &impl CustomPrimitives,
        nearest: &mut ClosestHit,
    ) {
        let Some(root) = self.0.root else { return };
        self.find_nearest_below::<STACK>(root, probe, others, nearest);
    }

    #[inline(always)]
    pub(super) fn find_nearest_below<const STACK: usize>(
        &self,
        root: Link,
        probe: &TraversalRay,
        others: &impl CustomPrimitives,
        nearest: &mut ClosestHit,
    ) {
        let observer = others.observer();
        // The black boxes below keep the compiler from spreading every number of the probe over
        // a vector before the first node: there are more of them than registers, and what would
        // be saved and restored is as quickly spread where it is used (a tenth of a render).
        // Entries are (t, link) in one number, so that comparing entries compares distances: t
        // is not negative, and such floats are ordered like their bits.
        let mut stack = [0u64; STACK];
        let mut top = 0;
        let mut link = root;
        loop {
            match link.target() {
                Target::Node(index) => {
                    observer.node();
                    let node = &self.0.nodes[index];
                    let (mut lanes, near) = node.entered(black_box(probe), nearest.t);
                    if lanes != 0 {
                        let near = near.to_array();
                        let entry = |lane: usize| {
                            u64::from(near[lane & (WIDTH - 1)].to_bits()) << 32
                                | u64::from(node.link(lane).0)
                        };
                        let lane = lanes.trailing_zeros() as usize;
                        lanes &= lanes - 1;
                        if lanes == 0 {
                            link = node.link(lane);
                            continue;
                        }
                        let mut first = entry(lane);
                        let lane = lanes.trailing_zeros() as usize;
                        lanes &= lanes - 1;
                        let second = entry(lane);
                        let far = first.max(second);
                        first = first.min(second);
                        if lanes == 0 {
                            stack[top] = far;
                            top += 1;
                            link = Link(first as u32);
                            continue;
                        }
                        // Keep the nearest at hand and the rest in order on the stack.
                        let base = top;
                        stack[top] = far;
                        top += 1;
                        while lanes != 0 {
                            let lane = lanes.trailing_zeros() as usize;
                            lanes &= lanes - 1;
                            let mut next = entry(lane);
                            if next < first {
                                core::mem::swap(&mut next, &mut first);
                            }
                            let mut slot = top;
                            while slot > base && stack[slot - 1] < next {
                                stack[slot] = stack[slot - 1];
                                slot -= 1;
                            }
                            stack[slot] = next;
                            top += 1;
                        }
                        link = Link(first as u32);
                        continue;
                    }
                }
                Target::Block(index) => {
                    observer.primitives(|| self.0.blocks[index].len());
                    self.0.blocks[index].intersect(index, black_box(probe), nearest)
                }
                Target::Other(primitive) => {
                    observer.primitives(|| 1);
                    others.intersect(primitive, probe, nearest)
                }
            }
            loop {
                if top == 0 {
                    return;
                }
                top -= 1;
                let entry = stack[top];
                if f32::from_bits((entry >> 32) as u32) <= nearest.t {
                    link = Link(entry as u32);
                    break;
                }
            }
        }
    }

    #[inline]
    fn find_any<const STACK: usize>(
        &self,
        probe: &TraversalRay,
        others: &impl CustomPrimitives,
        t_max: f32,
    ) -> bool {
        let Some(root) = self.0.root else {
            return false;
        };
        self.find_any_below::<STACK>(root, probe, others, t_max)
    }

    #[inline(always)]
    pub(super) fn find_any_below<const STACK: usize>(
        &self,
        root: Link,
        probe: &TraversalRay,
        others: &impl CustomPrimitives,
        t_max: f32,
    ) -> bool {
        let observer = others.observer();
        let mut stack = [0u32; STACK];
        let mut top = 0;
        let mut link = root;
        loop {
            match link.target() {
                Target::Node(index) => {
                    observer.node();
                    let node = &self.0.nodes[index];
                    let (mut lanes, _) = node.entered(black_box(probe), t_max);
                    if lanes != 0 {
                        // The largest box (the first lane) is looked into first.
                        let first = lanes.trailing_zeros() as usize;
                        lanes &= lanes - 1;
                        while lanes != 0 {
                            let lane = 31 - lanes.leading_zeros() as usize;
                            lanes ^= 1 << lane;
                            stack[top] = node.link(lane).0;
                            top += 1;
                        }
                        link = node.link(first);
                        continue;
                    }
                }
                Target::Block(index) => {
                    observer.primitives(|| self.0.blocks[index].len());
                    let stops = |primitive| others.stops(primitive);
                    if self.0.blocks[index].occludes(black_box(probe), t_max, stops) {
                        return true;
                    }
                }
                Target::Other(primitive) => {
                    observer.primitives(|| 1);
                    if others.occludes(primitive, probe, t_max) {
                        return true;
                    }
                }
            }
            if top == 0 {
                return false;
            }
            top -= 1;
            link = Link(stack[top]);
        }
    }

    /// Whether it is a single node, or less, over triangles.
    #[inline]
    pub(crate) fn is_small(&self) -> bool {
        match self.0.nodes.as_slice() {
            [] => !matches!(self.0.root.map(Link::target), Some(Target::Other(_))),
            [node] => {
                let mut links = (0..node.children()).map(|child| node.link(child));
                links.all(|link| matches!(link.target(), Target::Block(_)))
            }
            _ => false,
        }
    }

    pub(crate) fn blocks(&self) -> &[Block] {
        &self.0.blocks
    }

    /// Number of nodes.
    pub(crate) fn nodes(&self) -> usize {
        self.0.nodes.len()
    }

    /// Memory held (bytes).
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.0.nodes.as_slice()) + block_bytes(&self.0.blocks)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Bounds;
    use super::*;
    use glam::Vec3;

    /// Small triangles all over a cube, some of them copies.
    struct Scattered(u32);

    impl Primitives for Scattered {
        fn len(&self) -> usize {
            self.0 as usize
        }
        fn triangle(&self, primitive: u32) -> Option<[Vec3; 3]> {
            let key = u64::from(primitive - primitive % 9 % 2) + 1;
            let number = |i: u64| {
                let bits = (key * 8 + i).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                ((bits ^ (bits >> 29)) % (1 << 20)) as f32 / 1024.0
            };
            let at = Vec3::new(number(0), number(1), number(2));
            Some([at, at + Vec3::new(number(3), 1.0, 9.0) * 1e-3, at + Vec3::X])
        }
        fn is_triangle(&self, _: u32) -> bool {
            true
        }
        fn bounds(&self, _: u32) -> Bounds {
            Bounds::EMPTY
        }
    }

    #[test]
    fn the_tree_does_not_depend_on_threads() {
        // As many as it takes for every step of the build to go parallel.
        let build = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let wide = pool
                .expect("threads")
                .install(|| Wide::build(&Scattered(510_000)));
            // Every plane and link of every node.
            (format!("{:?}", wide.0.nodes), wide.0.blocks.len())
        };
        let one = build(1);
        assert!(one == build(2) && one == build(7));
    }
}
