//! The lowest nodes of the wide tree: up to 64 triangles, in blocks that are as full as can be.
//!
//! A binary tree over single triangles is cut where at most eight are left, which is five on average. So the triangles
//! below its lowest nodes are divided again, by the surface area heuristic over blocks (Wald, Benthin & Boulos 2008,
//! "Getting Rid of Packets", section 3.2): halves are whole blocks, and only the last is not full.

use super::Bounds;
use super::binary::{Binary, BinaryTree};
use super::block::LANES;
use super::node::WIDTH;
use glam::Vec3A;

/// Triangles of a bunch at most.
pub(super) const MOST: usize = WIDTH * LANES;

/// A triangle's number, and its box.
#[derive(Clone, Copy)]
struct Item {
    min: Vec3A,
    max: Vec3A,
    primitive: u32,
}

/// The triangles below a node of the binary tree.
pub(super) struct Bunch {
    items: [Item; MOST],
    count: usize,
}

impl Bunch {
    /// The triangles below `node`, at most [`MOST`].
    pub(super) fn below(tree: &BinaryTree, node: u32) -> Self {
        let nothing = Item {
            min: Vec3A::ZERO,
            max: Vec3A::ZERO,
            primitive: 0,
        };
        let mut bunch = Self {
            items: [nothing; MOST],
            count: 0,
        };
        // As deep as all triangles in a chain.
        let mut stack = [node; MOST];
        let mut top = 1;
        while top > 0 {
            top -= 1;
            match tree.node(stack[top]) {
                Binary::Inner(children) => {
                    stack[top..top + 2].copy_from_slice(&children);
                    top += 2;
                }
                Binary::Leaf(primitive) => {
                    let Bounds { min, max } = tree.bounds(stack[top]);
                    bunch.items[bunch.count] = Item {
                        min: min.into(),
                        max: max.into(),
                        primitive,
                    };
                    bunch.count += 1;
                }
                Binary::Gathered(_) => unreachable!("gathered primitives are a leaf of their own"),
            }
        }
        bunch
    }

    /// Divides them into blocks: calls `each` with the box and the primitives of every one.
    pub(super) fn blocks(&self, each: &mut impl FnMut(Bounds, &mut dyn Iterator<Item = u32>)) {
        let mut all: [u8; MOST] = core::array::from_fn(|place| place as u8);
        self.divide(&mut all[..self.count], each);
    }

    fn item(&self, place: u8) -> &Item {
        &self.items[usize::from(place) % MOST]
    }

    /// The box around items.
    #[inline]
    fn around(&self, places: impl Iterator<Item = u8>) -> Bounds {
        let [min, max] = places.fold(
            [Vec3A::INFINITY, Vec3A::NEG_INFINITY],
            |[min, max], place| {
                let item = self.item(place);
                [min.min(item.min), max.max(item.max)]
            },
        );
        Bounds {
            min: min.into(),
            max: max.into(),
        }
    }

    fn divide(
        &self,
        places: &mut [u8],
        each: &mut impl FnMut(Bounds, &mut dyn Iterator<Item = u32>),
    ) {
        let blocks = places.len().div_ceil(LANES);
        if blocks <= 1 {
            let bounds = self.around(places.iter().copied());
            let primitives = places.iter().map(|&place| self.item(place).primitive);
            return each(bounds, &mut { primitives });
        }
        let lower = blocks / 2;
        let middle = lower * LANES;
        let mut best = (f32::INFINITY, [0; MOST]);
        for axis in 0..3 {
            let mut keys = [0; MOST];
            let keys = &mut keys[..places.len()];
            for (key, &place) in keys.iter_mut().zip(places.iter()) {
                let item = self.item(place);
                *key = u64::from(ordered(item.min[axis] + item.max[axis])) << 8 | u64::from(place);
            }
            keys.select_nth_unstable(middle);
            let area = |keys: &[u64]| self.around(keys.iter().map(|&key| key as u8)).half_area();
            let (low, high) = keys.split_at(middle);
            let cost = area(low) * lower as f32 + area(high) * (blocks - lower) as f32;
            if cost < best.0 || axis == 0 {
                best.0 = cost;
                best.1[..keys.len()].copy_from_slice(keys);
            }
        }
        for (place, key) in places.iter_mut().zip(best.1) {
            *place = key as u8;
        }
        let (low, high) = places.split_at_mut(middle);
        self.divide(low, each);
        self.divide(high, each);
    }
}

/// A number that is ordered like a float.
#[inline]
fn ordered(x: f32) -> u32 {
    let bits = x.to_bits();
    bits ^ (((bits as i32 >> 31) as u32) | 1 << 31)
}
