//! Packing the chosen nodes of a binary tree into wide [`Node`]s and [`Block`]s of triangles.

use super::binary::{Binary, BinaryTree};
use super::block::{Block, LANES};
use super::bunch::Bunch;
use super::choices::Choices;
use super::node::{Link, MAX_INDEX, Node, WIDTH};
use super::{Bounds, Primitives};
use rayon::prelude::*;

/// A packed tree.
#[derive(Debug)]
pub(super) struct Packed {
    pub(super) nodes: Vec<Node>,
    pub(super) blocks: Vec<Block>,
    pub(super) root: Option<Link>,
    /// Levels of nodes.
    pub(super) depth: usize,
}

/// Packs a tree as `choices` say.
pub(super) fn pack(tree: &BinaryTree, choices: &Choices, primitives: &impl Primitives) -> Packed {
    let mut packer = Packer {
        tree,
        choices,
        primitives,
        nodes: Vec::new(),
        leaves: Vec::new(),
        blocks: 0,
        depth: 0,
    };
    let root = (!tree.is_empty()).then(|| packer.pack(0, 0));
    let Packer {
        mut nodes,
        leaves,
        blocks: count,
        depth,
        ..
    } = packer;
    assert!(count <= MAX_INDEX / 2 && nodes.len() <= MAX_INDEX as usize);
    let parts: Vec<_> = (leaves.par_chunks(CHUNK))
        .map(|leaves| {
            let mut part = Part::default();
            for leaf in leaves {
                part.add(tree, primitives, leaf);
            }
            part
        })
        .collect();
    let mut blocks = Vec::with_capacity(count as usize);
    for part in parts {
        for (index, node) in part.nodes {
            nodes[index as usize] = node;
        }
        blocks.extend_from_slice(&part.blocks);
    }
    Packed {
        nodes,
        blocks,
        root,
        depth,
    }
}

/// The source of a leaf's triangles.
enum Leaf {
    /// All below a node of the binary tree.
    Below(u32),
    /// These.
    Listed(Vec<u32>),
    /// All below a node of the binary tree, in several blocks from `first` on, below the wide node of that index.
    Bunch { below: u32, node: u32, first: u32 },
}

/// Leaves packed at once.
const CHUNK: usize = 512;

struct Packer<'a, P> {
    tree: &'a BinaryTree,
    choices: &'a Choices,
    primitives: &'a P,
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    /// Number of their blocks.
    blocks: u32,
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
        if let Some(blocks) = self.choices.bunch(node) {
            self.leaves.push(Leaf::Bunch {
                below: node,
                node: index,
                first: self.blocks,
            });
            self.blocks += blocks as u32;
            return Link::node(index);
        }
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
        self.blocks += 1;
        Link::block(self.blocks - 1)
    }
}

/// The result of packing some leaves.
#[derive(Default)]
struct Part {
    nodes: Vec<(u32, Node)>,
    blocks: Vec<Block>,
}

impl Part {
    fn add(&mut self, tree: &BinaryTree, primitives: &impl Primitives, leaf: &Leaf) {
        let corners = |primitive: u32| Some((primitives.triangle(primitive)?, primitive));
        match leaf {
            Leaf::Listed(list) => {
                let triangles = list.iter().filter_map(|&primitive| corners(primitive));
                self.blocks.push(Block::new(triangles));
            }
            &Leaf::Below(node) => Bunch::below(tree, node).blocks(&mut |_, list| {
                self.blocks.push(Block::new(list.filter_map(corners)));
            }),
            &Leaf::Bunch { below, node, first } => {
                let mut linked = Vec::with_capacity(WIDTH);
                Bunch::below(tree, below).blocks(&mut |bounds, list| {
                    linked.push((bounds, Link::block(first + linked.len() as u32)));
                    self.blocks.push(Block::new(list.filter_map(corners)));
                });
                self.nodes.push((node, Node::new(&linked)));
            }
        }
    }
}
