//! From triples of indices to vertices.
//!
//! Vertices of one position hang in a chain, which is short in every honest file; where it is not,
//! a hash map takes over, so that no file can make reading quadratic.

use std::collections::HashMap;

/// What one corner of a face refers to; [`Corner::NONE`] where it refers to nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Corner {
    pub(super) position: u32,
    pub(super) uv: u32,
    pub(super) normal: u32,
}

impl Corner {
    /// The index for "not given".
    pub(super) const NONE: u32 = u32::MAX;
}

const END: u32 = u32::MAX;
const LONGEST_CHAIN: usize = 16;

/// The different corners, each of which is a vertex.
#[derive(Default)]
pub(super) struct Corners {
    /// The vertices.
    pub(super) list: Vec<Corner>,
    /// For each vertex the next one of the same position.
    next: Vec<u32>,
    /// For each position its latest vertex.
    heads: Vec<u32>,
    /// Vertices that stand too far back in their chain.
    far: HashMap<Corner, u32>,
}

impl Corners {
    /// The vertex of a corner.
    pub(super) fn vertex(&mut self, corner: Corner) -> u32 {
        let position = corner.position as usize;
        if self.heads.len() <= position {
            self.heads.resize(position + 1, END);
        }
        let mut vertex = self.heads[position];
        let mut length = 0;
        while vertex != END {
            if self.list[vertex as usize] == corner {
                return vertex;
            }
            length += 1;
            if length == LONGEST_CHAIN {
                return self.far_vertex(corner);
            }
            vertex = self.next[vertex as usize];
        }
        let new = self.list.len() as u32;
        self.list.push(corner);
        self.next.push(self.heads[position]);
        self.heads[position] = new;
        new
    }

    fn far_vertex(&mut self, corner: Corner) -> u32 {
        let new = self.list.len() as u32;
        let vertex = *self.far.entry(corner).or_insert(new);
        if vertex == new {
            self.list.push(corner);
            self.next.push(END);
        }
        vertex
    }
}
