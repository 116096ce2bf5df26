//! Which nodes of the binary tree become nodes of the wide one, and which become leaves: the
//! choice of least expected cost (Ylitie, Karras & Laine 2017, "Efficient Incoherent Ray
//! Traversal on GPUs Through Compressed Wide BVHs", section 3.2).
//!
//! With A(n) the surface area of n and C(n, i) the least cost of representing n's subtree as a
//! forest of at most i trees,
//!
//! ```text
//! C(n, 1) = min( leaf(n), A(n)·c_node + D(n, 8) )
//! C(n, i) = min( D(n, i), C(n, i − 1) )
//! D(n, i) = min over 0 < k < i of C(left, k) + C(right, i − k)
//! ```
//!
//! A leaf of up to eight triangles is one block and costs A(n)·c_block, full or not. The largest subtrees of up to 64
//! triangles may also become a node over rebuilt blocks, if that costs less: a [`Bunch`].

use super::Primitives;
use super::binary::{Binary, BinaryTree};
use super::block::LANES;
use super::bunch::{self, Bunch};
use super::node::WIDTH;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

/// Cost of intersecting a block, relative to that of a node.
const BLOCK_COST: f32 = 1.1;
/// Cost of anything but a triangle.
const OTHER_COST: f32 = 3.0;
/// Subtrees above this depth are worked on in parallel.
const PARALLEL_DEPTH: u32 = 8;
/// Counts more primitives than fit into a block, or something that is no triangle.
const TOO_MANY: u32 = u32::MAX;

/// The choices made for a binary tree.
pub(super) struct Choices {
    /// Per node: three bits for each number i = 2…8 of trees, the share of the left child (0: as
    /// for i − 1); and [`LEAF`].
    packed: Vec<AtomicU32>,
}

const LEAF: u32 = 1 << 31;
/// All below is a [`Bunch`]; its number of blocks less one is where the share for eight trees would be.
const BUNCH: u32 = 1 << 30;
const BLOCKS: usize = 3 * (WIDTH - 2);

/// No leaf of a binary tree may lie deeper: it is worked on recursively, and a wide tree of as
/// many levels must not overflow a ray's stack.
pub(super) const MAX_DEPTH: u32 = 200;

struct Visit<'a, P> {
    tree: &'a BinaryTree,
    primitives: &'a P,
    too_deep: AtomicBool,
}

#[derive(Clone, Copy)]
struct Cost {
    /// C(n, i) at index i.
    forest: [f32; WIDTH],
    triangles: u32,
}

impl Choices {
    /// The best choices; `None` if the tree is deeper than [`MAX_DEPTH`].
    pub(super) fn make(tree: &BinaryTree, primitives: &impl Primitives) -> Option<Self> {
        let choices = Self {
            packed: (0..tree.len()).map(|_| AtomicU32::new(0)).collect(),
        };
        let visit = Visit {
            tree,
            primitives,
            too_deep: AtomicBool::new(false),
        };
        if !tree.is_empty() {
            let root = choices.visit(&visit, 0, 0);
            choices.bunched(&visit, 0, root);
        }
        (!visit.too_deep.into_inner()).then_some(choices)
    }

    /// Whether a node that is one tree of the forest is a leaf.
    #[inline]
    pub(super) fn is_leaf(&self, node: u32) -> bool {
        self.packed[node as usize].load(Ordering::Relaxed) & LEAF != 0
    }

    /// The number of blocks of a node that is one tree of the forest and has blocks only, if it is such a node.
    #[inline]
    pub(super) fn bunch(&self, node: u32) -> Option<usize> {
        let packed = self.packed[node as usize].load(Ordering::Relaxed);
        (packed & BUNCH != 0).then_some((packed >> BLOCKS & 7) as usize + 1)
    }

    /// The cost of a subtree, with a [`Bunch`] in its place if that is cheaper; it is the largest that may be one.
    fn bunched(&self, at: &Visit<'_, impl Primitives>, node: u32, mut cost: Cost) -> Cost {
        if !(LANES + 1..=bunch::MOST).contains(&(cost.triangles as usize)) {
            return cost;
        }
        let mut areas = 0.0;
        let mut blocks = 0;
        Bunch::below(at.tree, node).blocks(&mut |bounds, _| {
            areas += bounds.half_area();
            blocks += 1;
        });
        let bunch = at.tree.half_area(node) + BLOCK_COST * areas;
        let mut packed = self.packed[node as usize].load(Ordering::Relaxed);
        for (trees, least) in cost.forest.iter_mut().enumerate().skip(1) {
            if bunch > *least {
                continue;
            }
            *least = bunch;
            packed = match trees {
                1 => packed & !(7 << BLOCKS) | BUNCH | (blocks - 1) << BLOCKS,
                // As for one tree less.
                _ => packed & !(7 << (3 * (trees - 2))),
            };
        }
        self.packed[node as usize].store(packed, Ordering::Relaxed);
        cost
    }

    #[inline]
    fn share(&self, node: u32, trees: usize) -> usize {
        let packed = self.packed[node as usize].load(Ordering::Relaxed);
        (packed >> (3 * (trees - 2)) & 7) as usize
    }

    /// Calls `child` for each child of the wide node that the inner binary node `node` becomes.
    pub(super) fn children(&self, tree: &BinaryTree, node: u32, child: &mut impl FnMut(u32)) {
        if let Binary::Inner([left, right]) = tree.node(node) {
            let share = self.share(node, WIDTH);
            self.forest(tree, left, share, child);
            self.forest(tree, right, WIDTH - share, child);
        }
    }

    fn forest(&self, tree: &BinaryTree, node: u32, trees: usize, child: &mut impl FnMut(u32)) {
        for trees in (2..=trees).rev() {
            let share = self.share(node, trees);
            if share != 0 {
                if let Binary::Inner([left, right]) = tree.node(node) {
                    self.forest(tree, left, share, child);
                    self.forest(tree, right, trees - share, child);
                }
                return;
            }
        }
        child(node);
    }

    fn visit(&self, at: &Visit<'_, impl Primitives>, node: u32, depth: u32) -> Cost {
        let tree = at.tree;
        let area = tree.half_area(node);
        let leaf = |triangles: u32, cost: f32| {
            self.packed[node as usize].store(LEAF, Ordering::Relaxed);
            Cost {
                forest: [cost * area; WIDTH],
                triangles,
            }
        };
        let [left, right] = match tree.node(node) {
            Binary::Leaf(primitive) if at.primitives.is_triangle(primitive) => {
                return leaf(1, BLOCK_COST);
            }
            Binary::Leaf(_) => return leaf(TOO_MANY, OTHER_COST),
            Binary::Gathered(all) => {
                return leaf(TOO_MANY, BLOCK_COST * all.len().div_ceil(LANES) as f32);
            }
            Binary::Inner(_) if depth >= MAX_DEPTH => {
                at.too_deep.store(true, Ordering::Relaxed);
                return leaf(TOO_MANY, 0.0);
            }
            Binary::Inner(children) => children,
        };
        let visit = |child| self.visit(at, child, depth + 1);
        let ends = [left, right];
        let (mut left, mut right) = if depth < PARALLEL_DEPTH {
            rayon::join(|| visit(left), || visit(right))
        } else {
            (visit(left), visit(right))
        };
        let triangles = left.triangles.saturating_add(right.triangles);
        if triangles as usize > bunch::MOST {
            left = self.bunched(at, ends[0], left);
            right = self.bunched(at, ends[1], right);
        }

        // D(n, i): the best share of the left child.
        let distribute = |trees: usize| -> (f32, usize) {
            let low = trees.saturating_sub(WIDTH - 1).max(1);
            (low..=(trees - 1).min(WIDTH - 1))
                .map(|share| (left.forest[share] + right.forest[trees - share], share))
                .fold((f32::INFINITY, 1), |a, b| if b.0 < a.0 { b } else { a })
        };
        let (below, share) = distribute(WIDTH);
        let mut packed = (share as u32) << (3 * (WIDTH - 2));
        let fits = triangles as usize <= LANES;
        let as_leaf = if fits {
            BLOCK_COST * area
        } else {
            f32::INFINITY
        };
        let as_node = area + below;
        // Boxes of more than 10¹⁹ m have infinite areas, so the costs alone do not decide.
        if fits && as_leaf <= as_node {
            packed |= LEAF;
        }
        let mut forest = [as_leaf.min(as_node); WIDTH];
        for trees in 2..WIDTH {
            let (cost, share) = distribute(trees);
            forest[trees] = forest[trees - 1];
            if cost < forest[trees] {
                forest[trees] = cost;
                packed |= (share as u32) << (3 * (trees - 2));
            }
        }
        self.packed[node as usize].store(packed, Ordering::Relaxed);
        Cost { forest, triangles }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accelerator::binary::tests::Row;

    /// All wide nodes' numbers of children, and the primitives of all leaves.
    fn walk(choices: &Choices, tree: &BinaryTree, node: u32, nodes: &mut Vec<usize>) -> u32 {
        if choices.is_leaf(node) {
            fn count(tree: &BinaryTree, node: u32) -> u32 {
                match tree.node(node) {
                    Binary::Inner([a, b]) => count(tree, a) + count(tree, b),
                    Binary::Leaf(_) => 1,
                    Binary::Gathered(all) => all.len() as u32,
                }
            }
            let triangles = count(tree, node);
            assert!(triangles as usize <= LANES);
            return triangles;
        }
        if let Some(blocks) = choices.bunch(node) {
            let (mut triangles, mut found) = (0, 0);
            Bunch::below(tree, node).blocks(&mut |_, list| {
                let count = list.count();
                assert!((1..=LANES).contains(&count));
                triangles += count as u32;
                found += 1;
            });
            assert_eq!(found, blocks);
            nodes.push(blocks);
            return triangles;
        }
        let mut children = Vec::new();
        choices.children(tree, node, &mut |child| children.push(child));
        assert!((2..=WIDTH).contains(&children.len()));
        nodes.push(children.len());
        let walked = children.into_iter().map(|c| walk(choices, tree, c, nodes));
        walked.sum()
    }

    #[test]
    fn every_primitive_is_in_one_leaf_and_nodes_are_full() {
        let row = Row(3000);
        let tree = BinaryTree::build(&row);
        let choices = Choices::make(&tree, &row).expect("shallow");
        let mut nodes = Vec::new();
        assert_eq!(walk(&choices, &tree, 0, &mut nodes), 3000);
        let children: usize = nodes.iter().sum();
        assert!(children as f64 > 5.0 * nodes.len() as f64, "{nodes:?}");
    }

    #[test]
    fn deep_trees_are_refused() {
        let row = Row(MAX_DEPTH + 2);
        let chain = BinaryTree::chain(&row);
        assert!(Choices::make(&chain, &row).is_none());
        assert!(Choices::make(&chain.balanced(), &row).is_some());
    }
}
