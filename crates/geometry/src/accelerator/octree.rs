//! The octree: a cube, divided into eight again and again (A. Glassner 1984, *Space subdivision for fast ray tracing*).
//!
//! A cell keeps all whose boxes reach into it, so that a triangle may be in several. It is divided until its triangles
//! fit a block, or division would only repeat them.

use super::block::LANES;
use super::boxes::{BoxTree, DEEPEST, Part};
use super::{Bounds, Primitives};
use glam::Vec3;

/// Levels below the root at most.
const LEVELS: usize = if DEEPEST / 2 < 16 { DEEPEST / 2 } else { 16 };

/// Children may hold so many times what their parent holds, together.
const REPEATED: usize = 3;

/// Builds an octree.
pub(super) fn build(primitives: &impl Primitives) -> BoxTree {
    BoxTree::build(primitives, |boxes, part, depth| {
        if part.1.len() <= LANES || depth >= LEVELS {
            return Vec::new();
        }
        let cell = if depth == 0 { cube(&part.0) } else { part.0 };
        let parts: Vec<Part> = (0..8)
            .map(|octant| {
                let cell = octant_of(&cell, octant);
                let inside = |item: &&u32| {
                    let bounds = &boxes[**item as usize];
                    bounds.min.cmple(cell.max).all() && bounds.max.cmpge(cell.min).all()
                };
                (cell, part.1.iter().filter(inside).copied().collect())
            })
            .filter(|(_, items): &Part| !items.is_empty())
            .collect();
        let repeated: usize = parts.iter().map(|(_, items)| items.len()).sum();
        let smaller = parts.iter().all(|(_, items)| items.len() < part.1.len());
        if smaller && repeated <= REPEATED * part.1.len() || parts.len() == 1 {
            parts
        } else {
            Vec::new()
        }
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
