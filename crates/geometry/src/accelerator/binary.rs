//! A binary tree of boxes, built with `obvhs`: parallel locally-ordered clustering (Meister &
//! Bittner 2018) followed by reinsertion (Meister & Bittner 2017).
//!
//! This is the only file that names `obvhs`. Clustering is quadratic in the number of *equal*
//! boxes, so those are gathered into one leaf first; and should a tree still come out too deep to
//! be worked on recursively, [`BinaryTree::balanced`] makes another of the same leaves.

use super::{Bounds, Primitives, has_area};
use glam::{Vec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::{Bvh2, node::Bvh2Node, reinsertion::ReinsertionOptimizer};
use obvhs::ploc::{PlocBuilder, SortPrecision};
use rayon::prelude::*;

/// A binary tree over primitives.
#[derive(Default)]
pub(super) struct BinaryTree {
    nodes: Vec<Bvh2Node>,
    /// Primitives of leaves that have several.
    gathered: Vec<u32>,
}

/// A node of a [`BinaryTree`].
#[derive(Clone, Copy, Debug)]
pub(super) enum Binary<'a> {
    /// The indices of two children.
    Inner([u32; 2]),
    /// One primitive.
    Leaf(u32),
    /// Several primitives with the same box.
    Gathered(&'a [u32]),
}

/// PLOC's search radius and the number of passes before which it is 1; the share of nodes in each reinsertion pass. Wider
/// searches and more reinsertion take up to half as much time again without better trees, as the lowest levels are
/// rebuilt ([`Bunch`](super::bunch::Bunch)).
const SEARCH: usize = 4;
const NARROW_PASSES: usize = 3;
const REINSERTED: f32 = 0.02;
/// Equal boxes of at least this many primitives become one leaf.
const GATHER: usize = 32;
/// Boxes looked at to see whether any are equal; and how many of them must be.
const SAMPLED: usize = 1 << 14;
const SUSPICIOUS: usize = 8;

fn aabb(bounds: &Bounds) -> Aabb {
    Aabb {
        min: Vec3A::from(bounds.min),
        max: Vec3A::from(bounds.max),
    }
}

fn bounds(node: &Bvh2Node) -> Bounds {
    let aabb = node.aabb();
    Bounds {
        min: Vec3::from(aabb.min),
        max: Vec3::from(aabb.max),
    }
}

/// A key that is equal for equal boxes only.
fn key(node: &Bvh2Node) -> [u32; 6] {
    let Bounds { min, max } = bounds(node);
    // −0 and 0 are the same place.
    [min.x, min.y, min.z, max.x, max.y, max.z].map(|x| (x + 0.0).to_bits())
}

impl BinaryTree {
    /// The tree over all primitives but triangles without area, and what has no end.
    pub(super) fn build(primitives: &impl Primitives) -> Self {
        let mut leaves: Vec<Bvh2Node> = (0..primitives.len() as u32)
            .into_par_iter()
            .map(|primitive| {
                let (bounds, counts) = match primitives.triangle(primitive) {
                    Some(corners) => (Bounds::around(&corners), has_area(&corners)),
                    None => {
                        let bounds = primitives.bounds(primitive);
                        (bounds, !bounds.is_endless())
                    }
                };
                Bvh2Node::new(aabb(&bounds), u32::from(counts), primitive)
            })
            .collect();
        if leaves.par_iter().any(|leaf| leaf.prim_count == 0) {
            leaves.retain(|leaf| leaf.prim_count != 0);
        }
        let gathered = gather(&mut leaves);
        Self {
            nodes: cluster(leaves),
            gathered,
        }
    }

    /// The same leaves, halved by their centres again and again: ⌈log₂ n⌉ levels.
    pub(super) fn balanced(self) -> Self {
        let mut leaves: Vec<_> = self.nodes.into_iter().filter(Bvh2Node::is_leaf).collect();
        leaves.sort_unstable_by_key(|leaf| (leaf.first_index, leaf.prim_count));
        let mut nodes = vec![Bvh2Node::default()];
        halve_into(&mut nodes, 0, &mut leaves);
        Self {
            nodes,
            gathered: self.gathered,
        }
    }

    /// Whether there is nothing in it.
    pub(super) fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Number of nodes; the root is node 0.
    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// A node by its index.
    #[inline]
    pub(super) fn node(&self, index: u32) -> Binary<'_> {
        let node = &self.nodes[index as usize];
        let first = node.first_index;
        match node.prim_count {
            0 => Binary::Inner([first, first + 1]),
            1 => Binary::Leaf(first),
            count => Binary::Gathered(&self.gathered[first as usize..(first + count) as usize]),
        }
    }

    /// The box of a node.
    #[inline]
    pub(super) fn bounds(&self, index: u32) -> Bounds {
        bounds(&self.nodes[index as usize])
    }

    /// Half the surface area of a node's box.
    #[inline]
    pub(super) fn half_area(&self, index: u32) -> f32 {
        self.nodes[index as usize].aabb().half_area()
    }
}

/// Merges leaves with equal boxes, if there are suspiciously many, and returns their primitives.
fn gather(leaves: &mut Vec<Bvh2Node>) -> Vec<u32> {
    let stride = leaves.len() / SAMPLED + 1;
    let mut sample: Vec<_> = leaves.iter().step_by(stride).map(key).collect();
    sample.sort_unstable();
    if !sample
        .windows(SUSPICIOUS)
        .any(|w| w[0] == w[SUSPICIOUS - 1])
    {
        return Vec::new();
    }
    leaves.par_sort_unstable_by_key(|leaf| (key(leaf), leaf.first_index));
    let mut gathered = Vec::new();
    *leaves = leaves
        .chunk_by(|a, b| key(a) == key(b))
        .flat_map(|equal| {
            if equal.len() < GATHER {
                return equal.to_vec();
            }
            let first = gathered.len() as u32;
            gathered.extend(equal.iter().map(|leaf| leaf.first_index));
            vec![Bvh2Node::new(*equal[0].aabb(), equal.len() as u32, first)]
        })
        .collect();
    gathered
}

/// Clusters leaves into a tree and improves it.
fn cluster(leaves: Vec<Bvh2Node>) -> Vec<Bvh2Node> {
    let Some(first) = leaves.first() else {
        return leaves;
    };
    if leaves.len() == 1 {
        return leaves;
    }
    let total = leaves
        .par_iter()
        .map(|leaf| *leaf.aabb())
        .reduce(|| *first.aabb(), |a, b| a.union(&b));
    let mut builder = PlocBuilder::new();
    builder.current_nodes = leaves;
    let mut bvh = Bvh2::default();
    builder.build_ploc_from_leaves::<SEARCH, false>(
        &mut bvh,
        total,
        SortPrecision::U64,
        NARROW_PASSES,
    );
    drop(builder);
    ReinsertionOptimizer::default().run(&mut bvh, REINSERTED, None);
    bvh.nodes
}

/// Halves leaves by their centres along the longest axis, again and again.
fn halve_into(nodes: &mut Vec<Bvh2Node>, at: usize, leaves: &mut [Bvh2Node]) {
    if let [leaf] = leaves {
        nodes[at] = *leaf;
        return;
    }
    let center = |leaf: &Bvh2Node| leaf.aabb().center();
    let total = leaves
        .iter()
        .fold(*leaves[0].aabb(), |b, leaf| b.union(leaf.aabb()));
    let spread = leaves
        .iter()
        .fold(Aabb::empty(), |b, leaf| {
            let c = center(leaf);
            b.union(&Aabb { min: c, max: c })
        })
        .diagonal();
    let axis = Vec3::from(spread).max_position();
    let middle = leaves.len() / 2;
    leaves.select_nth_unstable_by(middle, |a, b| {
        center(a)[axis]
            .total_cmp(&center(b)[axis])
            .then(a.first_index.cmp(&b.first_index))
    });
    let first = nodes.len();
    nodes[at] = Bvh2Node::new(total, 0, first as u32);
    nodes.extend([Bvh2Node::default(); 2]);
    let (left, right) = leaves.split_at_mut(middle);
    halve_into(nodes, first, left);
    halve_into(nodes, first + 1, right);
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Triangles side by side.
    pub(crate) struct Row(pub(crate) u32);

    impl Primitives for Row {
        fn len(&self) -> usize {
            self.0 as usize
        }
        fn triangle(&self, primitive: u32) -> Option<[Vec3; 3]> {
            let at = Vec3::X * primitive as f32;
            Some([at, at + Vec3::Y, at + Vec3::Z])
        }
        fn is_triangle(&self, _: u32) -> bool {
            true
        }
        fn bounds(&self, primitive: u32) -> Bounds {
            Bounds::around(&self.triangle(primitive).expect("a triangle"))
        }
    }

    impl BinaryTree {
        /// The most lopsided tree over a row.
        pub(crate) fn chain(row: &Row) -> Self {
            let leaf = |i: u32| Bvh2Node::new(aabb(&row.bounds(i)), 1, i);
            let mut nodes = vec![leaf(0)];
            for i in 1..row.0 {
                // Node k of the chain is the left child, at an odd index.
                let at = 2 * (i as usize - 1);
                let here = if i == 1 { 0 } else { at - 1 };
                let rest = (i - 1..row.0).map(|j| row.bounds(j)).reduce(Bounds::union);
                let first = nodes.len() as u32;
                nodes[here] = Bvh2Node::new(aabb(&rest.expect("not empty")), 0, first);
                nodes.extend([leaf(i), leaf(i - 1)]);
            }
            Self {
                nodes,
                gathered: Vec::new(),
            }
        }

        /// All primitives, in order, and the depth of the deepest.
        pub(crate) fn leaves(&self) -> (Vec<u32>, u32) {
            let (mut leaves, mut depth) = (Vec::new(), 0);
            let mut stack = vec![(0, 0)];
            while let Some((index, at)) = stack.pop() {
                depth = depth.max(at);
                match self.node(index) {
                    Binary::Inner(children) => stack.extend(children.map(|c| (c, at + 1))),
                    Binary::Leaf(primitive) => leaves.push(primitive),
                    Binary::Gathered(all) => leaves.extend(all),
                }
            }
            leaves.sort_unstable();
            (leaves, depth)
        }
    }

    #[test]
    fn a_chain_is_balanced() {
        let chain = BinaryTree::chain(&Row(1000));
        let all: Vec<u32> = (0..1000).collect();
        assert_eq!(chain.leaves(), (all.clone(), 999));
        assert_eq!(chain.balanced().leaves(), (all, 10));
    }

    #[test]
    fn clustering_loses_nothing() {
        let tree = BinaryTree::build(&Row(5000));
        assert_eq!(tree.leaves().0, (0..5000).collect::<Vec<u32>>());
    }
}
