//! Plane triangles clipped against earlier ones, so that together they cover each point once: an overlapping light would
//! emit twice there.

use glam::DVec2;
use std::collections::HashMap;

/// A corner with its texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Corner {
    pub(super) position: DVec2,
    pub(super) uv: DVec2,
}

/// Areas below this part of the smaller one count as touching only.
const TOUCHING: f64 = 1e-7;

/// The triangles so far.
pub(super) struct Sheet {
    triangles: Vec<[Corner; 3]>,
    /// The triangles as they were added, against the clock, …
    covers: Vec<[DVec2; 3]>,
    /// … by the cells that their boxes meet.
    cells: HashMap<[i64; 2], Vec<usize>>,
    cell: f64,
}

fn area(polygon: &[Corner]) -> f64 {
    let first = polygon
        .first()
        .map_or(DVec2::ZERO, |corner| corner.position);
    let fan = polygon.windows(2);
    0.5 * fan
        .map(|pair| (pair[0].position - first).perp_dot(pair[1].position - first))
        .sum::<f64>()
}

/// The parts of a convex polygon to the left and to the right of the line from `a` to `b`.
fn split(polygon: &[Corner], [a, b]: [DVec2; 2]) -> [Vec<Corner>; 2] {
    let side = |corner: &Corner| (b - a).perp_dot(corner.position - a);
    let (mut left, mut right) = (Vec::new(), Vec::new());
    for (index, corner) in polygon.iter().enumerate() {
        let next = &polygon[(index + 1) % polygon.len()];
        let (here, there) = (side(corner), side(next));
        if here >= 0.0 {
            left.push(*corner);
        }
        if here <= 0.0 {
            right.push(*corner);
        }
        if here * there < 0.0 {
            let part = here / (here - there);
            let between = Corner {
                position: corner.position.lerp(next.position, part),
                uv: corner.uv.lerp(next.uv, part),
            };
            left.push(between);
            right.push(between);
        }
    }
    [left, right]
}

impl Sheet {
    /// Nothing covered yet; triangles will be about as large as `size`.
    pub(super) fn new(size: f64) -> Self {
        Self {
            triangles: Vec::new(),
            covers: Vec::new(),
            cells: HashMap::new(),
            cell: if size > 0.0 { size } else { 1.0 },
        }
    }

    /// The numbers of the cells that a box meets.
    fn cells_of(&self, corners: &[DVec2]) -> impl Iterator<Item = [i64; 2]> + use<> {
        let low = corners.iter().fold(DVec2::INFINITY, |low, p| low.min(*p)) / self.cell;
        let high = corners
            .iter()
            .fold(DVec2::NEG_INFINITY, |high, p| high.max(*p))
            / self.cell;
        let range = |axis: usize| low[axis].floor() as i64..=high[axis].floor() as i64;
        let rows = range(1);
        range(0).flat_map(move |x| rows.clone().map(move |y| [x, y]))
    }

    /// Covers what a triangle covers.
    pub(super) fn add(&mut self, triangle: [Corner; 3]) {
        let mut triangle = triangle;
        let mut whole = area(&triangle);
        if whole < 0.0 {
            triangle.swap(1, 2);
            whole = -whole;
        }
        if !(whole > 0.0) {
            return;
        }
        let corners = triangle.map(|corner| corner.position);
        let cells: Vec<[i64; 2]> = self.cells_of(&corners).collect();
        let mut near: Vec<usize> = cells
            .iter()
            .filter_map(|cell| self.cells.get(cell))
            .flatten()
            .copied()
            .collect();
        near.sort_unstable();
        near.dedup();
        let mut left = vec![triangle.to_vec()];
        for cover in near {
            let [a, b, c] = self.covers[cover];
            let covered = 0.5 * (b - a).perp_dot(c - a);
            left = left
                .into_iter()
                .flat_map(|polygon| uncovered(polygon, [a, b, c], covered))
                .collect();
        }
        for polygon in left {
            for pair in polygon[1..].windows(2) {
                self.triangles.push([polygon[0], pair[0], pair[1]]);
            }
        }
        for cell in cells {
            self.cells.entry(cell).or_default().push(self.covers.len());
        }
        self.covers.push(corners);
    }

    /// Triangles that cover each point once.
    pub(super) fn triangles(&self) -> &[[Corner; 3]] {
        &self.triangles
    }
}

/// The parts of a convex polygon that a triangle of an area leaves uncovered.
fn uncovered(polygon: Vec<Corner>, [a, b, c]: [DVec2; 3], covered: f64) -> Vec<Vec<Corner>> {
    let least = TOUCHING * area(&polygon).min(covered);
    let mut outside = Vec::new();
    let mut rest = polygon.clone();
    for edge in [[a, b], [b, c], [c, a]] {
        let [left, right] = split(&rest, edge);
        if area(&right) > least {
            outside.push(right);
        }
        rest = left;
        if area(&rest) <= least {
            return vec![polygon];
        }
    }
    outside
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers in [0, 1): multiples of the golden ratio.
    fn number(index: u32) -> f64 {
        (f64::from(index) * 0.618_033_988_749_894_9).fract()
    }

    /// The result covers exactly the union of random triangles, each point once.
    #[test]
    fn each_place_is_covered_once() {
        let corner = |index: u32| Corner {
            position: DVec2::new(number(2 * index + 1), number(index * index + 3 * index)),
            uv: DVec2::ZERO,
        };
        let given: Vec<[Corner; 3]> = (0..12)
            .map(|k| [0, 1, 2].map(|i| corner(3 * k + i)))
            .collect();
        let mut sheet = Sheet::new(0.3);
        given.iter().for_each(|triangle| sheet.add(*triangle));
        let within = |p: DVec2, [a, b, c]: [Corner; 3]| {
            let sides = [(a, b), (b, c), (c, a)]
                .map(|(a, b)| (b.position - a.position).perp_dot(p - a.position));
            sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0)
        };
        let mut seen = [0; 2];
        for (i, j) in (0..97).flat_map(|i| (0..97).map(move |j| (i, j))) {
            let p = DVec2::new(f64::from(i) + 0.31, f64::from(j) + 0.57) / 97.0;
            let covered = given.iter().any(|triangle| within(p, *triangle));
            let count = sheet
                .triangles()
                .iter()
                .filter(|triangle| within(p, **triangle))
                .count();
            assert_eq!(count, usize::from(covered), "{p}");
            seen[count] += 1;
        }
        assert!(seen[0] > 500 && seen[1] > 500, "{seen:?}");
    }
}
