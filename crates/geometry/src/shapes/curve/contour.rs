//! Where a function of the plane vanishes: lines through the cells of a grid (*marching squares*).
//!
//! A line crosses an edge of the grid where the function's sign changes along it, at a place found by halving. Of a cell
//! crossed on all four sides, the value in its middle says which crossings belong together. Loops that lie within a
//! cell are not found.

use glam::DVec2;
use std::collections::HashMap;

/// An edge of the grid: its first corner, and whether it goes along y.
type Edge = ([usize; 2], bool);

/// Points of one line, in order, and whether it returns to the first.
pub(super) type Line = (Vec<DVec2>, bool);

/// The lines on which `f` vanishes in a box of `n` × `n` cells.
pub(super) fn lines(f: &impl Fn(DVec2) -> f64, [low, high]: [DVec2; 2], n: usize) -> Vec<Line> {
    let corner =
        |[i, j]: [usize; 2]| low + (high - low) * DVec2::new(i as f64, j as f64) / n as f64;
    let values: Vec<bool> = (0..=n)
        .flat_map(|j| (0..=n).map(move |i| [i, j]))
        .map(|at| f(corner(at)) < 0.0)
        .collect();
    let inside = |[i, j]: [usize; 2]| values[j * (n + 1) + i];
    // The edges that follow an edge, at most two.
    let mut links: HashMap<Edge, Vec<Edge>> = HashMap::new();
    let mut order: Vec<Edge> = Vec::new();
    for (i, j) in (0..n).flat_map(|j| (0..n).map(move |i| (i, j))) {
        let around = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
        let edges: [Edge; 4] = [
            ([i, j], false),
            ([i + 1, j], true),
            ([i, j + 1], false),
            ([i, j], true),
        ];
        let crossed: Vec<usize> = (0..4)
            .filter(|&k| inside(around[k]) != inside(around[(k + 1) % 4]))
            .collect();
        let pairs: &[[usize; 2]] = match crossed.len() {
            2 => &[[crossed[0], crossed[1]]],
            4 => {
                let middle = f(0.5 * (corner(around[0]) + corner(around[2]))) < 0.0;
                // The middle belongs to the first corner's side: the others are cut off.
                if middle == inside(around[0]) {
                    &[[0, 1], [2, 3]]
                } else {
                    &[[3, 0], [1, 2]]
                }
            }
            _ => &[],
        };
        for [a, b] in pairs.iter().map(|pair| pair.map(|k| edges[k])) {
            links.entry(a).or_default().push(b);
            links.entry(b).or_default().push(a);
            order.extend([a, b]);
        }
    }
    let place = |([i, j], upright): Edge| {
        let other = if upright { [i, j + 1] } else { [i + 1, j] };
        let (mut a, mut b) = (corner([i, j]), corner(other));
        if !inside([i, j]) {
            core::mem::swap(&mut a, &mut b);
        }
        // a is inside, b is not.
        for _ in 0..52 {
            let middle = 0.5 * (a + b);
            if f(middle) < 0.0 {
                a = middle;
            } else {
                b = middle;
            }
        }
        0.5 * (a + b)
    };
    // Lines with ends are followed from there; the others are closed.
    let is_end = |edge: &Edge| links[edge].len() == 1;
    let mut starts: Vec<Edge> = order.iter().copied().filter(is_end).collect();
    starts.extend(&order);
    let mut seen: HashMap<Edge, ()> = HashMap::new();
    let mut lines = Vec::new();
    for start in starts {
        if seen.contains_key(&start) {
            continue;
        }
        let mut line = Vec::new();
        let mut at = Some(start);
        while let Some(edge) = at {
            seen.insert(edge, ());
            line.push(place(edge));
            at = links[&edge]
                .iter()
                .copied()
                .find(|next| !seen.contains_key(next));
        }
        let closed = !is_end(&start);
        lines.push((line, closed));
    }
    lines
}
