//! A bounding volume hierarchy with eight children per node and up to eight triangles per leaf.
//!
//! A binary tree ([`BinaryTree`]) is collapsed by dynamic programming ([`Choices`]) and packed
//! into [`Node`]s and [`Block`]s. Rays visit children near first.

use super::binary::{Binary, BinaryTree};
use super::block::{Block, LANES};
use super::collapse::{self, Choices, WIDTH};
use super::node::{Link, MAX_INDEX, Node, Target};
use super::{Bounds, CustomPrimitives, Primitives, block_bytes};
use crate::closest_hit::ClosestHit;
use crate::traversal_ray::TraversalRay;
use core::hint::black_box;
use rayon::prelude::*;

/// The tree.
#[derive(Debug)]
pub(crate) struct Wide {
    nodes: Vec<Node>,
    blocks: Vec<Block>,
    root: Option<Link>,
    /// Levels of nodes.
    depth: usize,
}

/// Room on a ray's stack: a node takes one entry off and puts up to eight on it.
const fn stack_for(depth: usize) -> usize {
    (WIDTH - 1) * depth + 1
}
/// A stack is cleared for every ray, so it should not be larger than it must.
const SMALL_STACK: usize = stack_for(SMALL_DEPTH);
const SMALL_DEPTH: usize = 2;
const MEDIUM_STACK: usize = stack_for(MEDIUM_DEPTH);
const MEDIUM_DEPTH: usize = 9;
const LARGE_STACK: usize = stack_for(MAX_DEPTH);
/// A wide tree is not deeper than the binary one, but for primitives with equal boxes, of which
/// there are fewer than 8¹¹.
const MAX_DEPTH: usize = collapse::MAX_DEPTH as usize + 12;

/// Where a leaf's triangles come from.
enum Leaf {
    /// All below a node of the binary tree.
    Below(u32),
    /// These.
    Listed(Vec<u32>),
}

struct Packer<'a, P> {
    tree: &'a BinaryTree,
    choices: &'a Choices,
    primitives: &'a P,
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    depth: usize,
}

impl<P: Primitives> Packer<'_, P> {
    fn pack(&mut self, node: u32, depth: usize) -> Link {
        if self.choices.is_leaf(node) {
            return match self.tree.node(node) {
                Binary::Leaf(primitive) if !self.primitives.is_triangle(primitive) => {
                    assert!(primitive <= MAX_INDEX, "fewer than 2³⁰ primitives");
                    Link::other(primitive)
                }
                Binary::Gathered(all) => self.pack_list(self.tree.bounds(node), all, depth),
                Binary::Leaf(_) | Binary::Inner(_) => self.leaf(Leaf::Below(node)),
            };
        }
        let index = self.reserve(depth);
        let mut children = Vec::with_capacity(WIDTH);
        self.choices
            .children(self.tree, node, &mut |child| children.push(child));
        let area = |&child: &u32| self.tree.half_area(child);
        // Large boxes first: they are the likeliest to be entered.
        children.sort_by(|a, b| area(b).total_cmp(&area(a)));
        let linked: Vec<_> = children
            .into_iter()
            .map(|child| (self.tree.bounds(child), self.pack(child, depth + 1)))
            .collect();
        self.nodes[index as usize] = Node::new(&linked);
        Link::node(index)
    }

    /// Primitives with the same box, which no tree can tell apart: eighths of eighths.
    fn pack_list(&mut self, bounds: Bounds, list: &[u32], depth: usize) -> Link {
        if let [primitive] = list
            && !self.primitives.is_triangle(*primitive)
        {
            return Link::other(*primitive);
        }
        let all_triangles = || list.iter().all(|&p| self.primitives.is_triangle(p));
        if list.len() <= LANES && all_triangles() {
            return self.leaf(Leaf::Listed(list.to_vec()));
        }
        let index = self.reserve(depth);
        let linked: Vec<_> = list
            .chunks(list.len().div_ceil(WIDTH))
            .map(|part| (bounds, self.pack_list(bounds, part, depth + 1)))
            .collect();
        self.nodes[index as usize] = Node::new(&linked);
        Link::node(index)
    }

    fn reserve(&mut self, depth: usize) -> u32 {
        self.depth = self.depth.max(depth + 1);
        self.nodes.push(Node::new(&[]));
        self.nodes.len() as u32 - 1
    }

    fn leaf(&mut self, leaf: Leaf) -> Link {
        self.leaves.push(leaf);
        Link::block(self.leaves.len() as u32 - 1)
    }
}

/// The triangles of a leaf as a block.
fn block(tree: &BinaryTree, primitives: &impl Primitives, leaf: &Leaf) -> Block {
    let mut list = [0; LANES];
    let list = match leaf {
        Leaf::Listed(list) => list,
        Leaf::Below(node) => {
            let mut count = 0;
            let mut stack = [0; LANES];
            stack[0] = *node;
            let mut top = 1;
            while top > 0 {
                top -= 1;
                match tree.node(stack[top]) {
                    Binary::Inner(children) => {
                        stack[top..top + 2].copy_from_slice(&children);
                        top += 2;
                    }
                    Binary::Leaf(primitive) => {
                        list[count] = primitive;
                        count += 1;
                    }
                    Binary::Gathered(_) => {
                        unreachable!("gathered primitives are a leaf of their own")
                    }
                }
            }
            &list[..count]
        }
    };
    Block::new(
        list.iter()
            .filter_map(|&p| Some((primitives.triangle(p)?, p))),
    )
}

impl Wide {
    pub(crate) fn build(primitives: &impl Primitives) -> Self {
        let mut tree = BinaryTree::build(primitives);
        let choices = Choices::make(&tree, primitives).unwrap_or_else(|| {
            tree = core::mem::take(&mut tree).balanced();
            Choices::make(&tree, primitives).expect("a balanced tree is shallow")
        });
        let mut packer = Packer {
            tree: &tree,
            choices: &choices,
            primitives,
            nodes: Vec::new(),
            leaves: Vec::new(),
            depth: 0,
        };
        let root = (!tree.is_empty()).then(|| packer.pack(0, 0));
        let Packer {
            nodes,
            leaves,
            depth,
            ..
        } = packer;
        assert!(
            depth <= MAX_DEPTH,
            "a tree of {depth} levels overflows the stack"
        );
        assert!(leaves.len() <= MAX_INDEX as usize / 2 && nodes.len() <= MAX_INDEX as usize);
        let blocks = leaves
            .par_iter()
            .map(|leaf| block(&tree, primitives, leaf))
            .collect();
        Self {
            nodes,
            blocks,
            root,
            depth,
        }
    }

    /// Notes the nearest hit, if it wins over what is known.
    #[inline]
    pub(crate) fn intersect(
        &self,
        probe: &TraversalRay,
        others: &impl CustomPrimitives,
        nearest: &mut ClosestHit,
    ) {
        match self.depth {
            depth if depth <= SMALL_DEPTH => {
                self.find_nearest::<SMALL_STACK>(probe, others, nearest)
            }
            depth if depth <= MEDIUM_DEPTH => {
                self.find_nearest::<MEDIUM_STACK>(probe, others, nearest)
            }
            _ => self.find_nearest::<LARGE_STACK>(probe, others, nearest),
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
        match self.depth {
            depth if depth <= SMALL_DEPTH => self.find_any::<SMALL_STACK>(probe, others, t_max),
            depth if depth <= MEDIUM_DEPTH => self.find_any::<MEDIUM_STACK>(probe, others, t_max),
            _ => self.find_any::<LARGE_STACK>(probe, others, t_max),
        }
    }

    #[inline]
    fn find_nearest<const STACK: usize>(
        &self,
        probe: &TraversalRay,
        others: &impl CustomPrimitives,
        nearest: &mut ClosestHit,
    ) {
        let Some(root) = self.root else { return };
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
                    let node = &self.nodes[index];
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
                    self.blocks[index].intersect(index, black_box(probe), nearest)
                }
                Target::Other(primitive) => others.intersect(primitive, probe, nearest),
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
        let Some(root) = self.root else { return false };
        let mut stack = [0u32; STACK];
        let mut top = 0;
        let mut link = root;
        loop {
            match link.target() {
                Target::Node(index) => {
                    let node = &self.nodes[index];
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
                    if self.blocks[index].occludes(black_box(probe), t_max) {
                        return true;
                    }
                }
                Target::Other(primitive) => {
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

    pub(crate) fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// Number of nodes.
    pub(crate) fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Memory held (bytes).
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + block_bytes(&self.blocks)
    }
}

#[cfg(test)]
mod tests {
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
            (format!("{:?}", wide.nodes), wide.blocks.len())
        };
        let one = build(1);
        assert!(one == build(2) && one == build(7));
    }
}
