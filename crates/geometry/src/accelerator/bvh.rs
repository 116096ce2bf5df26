//! Binary trees of boxes: by the mean, or by the surface area heuristic.
//!
//! **Mean**: what lies along the widest axis below the mean of the centres goes left, the rest right, until a leaf
//! fits a block.
//!
//! **Surface area** (J. Goldsmith, J. Salmon 1987; bins of I. Wald 2007): of the planes between sixteen bins on each axis
//! the one with the least expected cost,
//!
//! ```text
//! C = 1 + (A(left) ⌈n(left)/8⌉ + A(right) ⌈n(right)/8⌉) / A(all)
//! ```
//!
//! a block of eight triangles costing as much as a node; or a leaf, if that costs less.

use super::block::LANES;
use super::box_tree::{BoxTree, Part};
use super::{Bounds, Primitives};

/// Bins of an axis.
const BINS: usize = 16;

/// Builds by the mean.
pub(super) fn by_mean(primitives: &impl Primitives) -> BoxTree {
    BoxTree::build(primitives, |boxes, part, _| {
        if part.items.len() <= LANES {
            return Vec::new();
        }
        let size = part.bounds.max - part.bounds.min;
        let axis = size.max_position();
        let center = |item: u32| f64::from(boxes[item as usize].center()[axis]);
        let sum: f64 = part.items.iter().map(|&item| center(item)).sum();
        let mean = sum / part.items.len() as f64;
        parts(boxes, part, |item| center(item) < mean)
    })
}

/// Builds by the surface area heuristic.
pub(super) fn by_area(primitives: &impl Primitives) -> BoxTree {
    BoxTree::build(primitives, |boxes, part, _| {
        let blocks = |count: usize| count.div_ceil(LANES) as f32;
        let all = part.items.len();
        let centers = (part.items.iter()).fold(Bounds::EMPTY, |b, &item| {
            b.union(Bounds::around(&[boxes[item as usize].center()]))
        });
        let mut best: Option<(f32, usize, usize)> = None;
        for axis in 0..3 {
            let mut bins = [(0_usize, Bounds::EMPTY); BINS];
            if centers.max[axis] <= centers.min[axis] {
                continue;
            }
            for &item in &part.items {
                let bounds = boxes[item as usize];
                let (count, all) = &mut bins[bin(&centers, axis, &bounds)];
                (*count, *all) = (*count + 1, all.union(bounds));
            }
            for plane in 1..BINS {
                let [left, right] = [&bins[..plane], &bins[plane..]].map(|bins| {
                    bins.iter()
                        .fold((0, Bounds::EMPTY), |(n, b), (count, bounds)| {
                            (n + count, b.union(*bounds))
                        })
                });
                if left.0 == 0 || right.0 == 0 {
                    continue;
                }
                let cost = [left, right].map(|(n, b)| b.half_area() * blocks(n));
                let cost =
                    1.0 + (cost[0] + cost[1]) / part.bounds.half_area().max(f32::MIN_POSITIVE);
                if best.is_none_or(|(least, ..)| cost < least) {
                    best = Some((cost, axis, plane));
                }
            }
        }
        match best {
            Some((cost, ..)) if all <= LANES && cost >= blocks(all) => Vec::new(),
            Some((_, axis, plane)) => parts(boxes, part, |item| {
                bin(&centers, axis, &boxes[item as usize]) < plane
            }),
            // All centres are one.
            None => Vec::new(),
        }
    })
}

/// The bin of a box's centre.
fn bin(centers: &Bounds, axis: usize, bounds: &Bounds) -> usize {
    let [low, high] = [centers.min, centers.max].map(|corner| corner[axis]);
    let place = (bounds.center()[axis] - low) / (high - low);
    ((place * BINS as f32) as usize).min(BINS - 1)
}

/// The two parts by `left`; none, for a leaf, if one of them is empty.
fn parts(boxes: &[Bounds], part: &Part, left: impl Fn(u32) -> bool) -> Vec<Part> {
    let (a, b): (Vec<u32>, Vec<u32>) = part.items.iter().partition(|&&item| left(item));
    if a.is_empty() || b.is_empty() {
        return Vec::new();
    }
    let around = |items: Vec<u32>| {
        let bounds = (items.iter()).fold(Bounds::EMPTY, |b, &i| b.union(boxes[i as usize]));
        Part {
            bounds,
            items,
            credit: 0.0,
        }
    };
    vec![around(a), around(b)]
}
