//! The octree: a cube, divided into eight again and again (A. Glassner 1984, *Space subdivision for fast ray tracing*).
//!
//! A cell keeps all whose boxes reach into it, so that a triangle may be in several. It is divided until its triangles
//! fit a block, or division would only repeat them.

use super::block::LANES;
use super::box_tree::{BoxTree, DEEPEST, Part};
use super::{Bounds, Primitives};
use glam::Vec3;

/// Levels below the root at most.
const LEVELS: usize = if DEEPEST / 2 < 16 { DEEPEST / 2 } else { 16 };

/// How often an item may be repeated, on the average. Boxes that overlap everywhere would else be divided, and repeated,
/// until nothing is left but the repetition.
const REPEATED: f32 = 8.0;

/// Builds an octree.
pub(super) fn build(primitives: &impl Primitives) -> BoxTree {
    BoxTree::build(primitives, |boxes, part, depth| {
        let count = part.items.len();
        if count <= LANES || depth >= LEVELS {
            return Vec::new();
        }
        let (cell, credit) = match depth {
            0 => (cube(&part.bounds), REPEATED),
            _ => (part.bounds, part.credit),
        };
        let mut parts: Vec<Part> = (0..8)
            .map(|octant| {
                let bounds = octant_of(&cell, octant);
                let inside = |item: &&u32| {
                    let item = &boxes[**item as usize];
                    item.min.cmple(bounds.max).all() && item.max.cmpge(bounds.min).all()
                };
                Part {
                    bounds,
                    items: part.items.iter().filter(inside).copied().collect(),
                    credit: 0.0,
                }
            })
            .filter(|part| !part.items.is_empty())
            .collect();
        let repeated: usize = parts.iter().map(|part| part.items.len()).sum();
        let left = credit * count as f32 - (repeated - count) as f32;
        if left < 0.0 {
            return Vec::new();
        }
        for part in &mut parts {
            part.credit = left / repeated as f32;
        }
        parts
    })
}

/// The cube around a box.
fn cube(bounds: &Bounds) -> Bounds {
    let half = (bounds.max - bounds.min).max_element() * 0.5;
    let center = bounds.center();
    // Rounded, it must still hold the box.
    Bounds {
        min: (center - half).min(bounds.min),
        max: (center + half).max(bounds.max),
    }
}

fn octant_of(cell: &Bounds, octant: usize) -> Bounds {
    let middle = cell.center();
    let upper = |axis: usize| octant >> axis & 1 == 1;
    let pick =
        |of: [Vec3; 2]| Vec3::from_array([0, 1, 2].map(|axis| of[usize::from(upper(axis))][axis]));
    Bounds {
        min: pick([cell.min, middle]),
        max: pick([middle, cell.max]),
    }
}
