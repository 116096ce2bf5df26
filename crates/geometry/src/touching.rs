//! Shapes that nearly touch, closer than single precision resolves.

use crate::shapes::Shape;
use crate::shapes::analytic::crossing::Line;
use glam::Vec2;

/// Surfaces closer than this, relative to the largest coordinate, need double precision: some
/// fifty roundings of a position and of the distance to it.
const NEAR: f64 = 1e-5;

/// Looks at so many points of a shape, squared.
const SIDE: u32 = 8;

/// Whether a line crosses it within `reach` of the line's origin.
fn comes_within(shape: &Shape, line: &Line, reach: f64) -> bool {
    let near = |t: f64| t.abs() <= reach;
    match shape.mesh() {
        Some(mesh) => mesh.crossings(line).into_iter().any(near),
        None => (0..shape.primitives()).any(|piece| {
            let next = shape.next_crossing(piece, line, -1.001 * reach, 2.0 * reach);
            next.is_some_and(|crossing| near(crossing.t))
        }),
    }
}

/// Whether a point of `a` is near the surface of `b`.
fn comes_near(a: &Shape, b: &Shape, near: f64) -> bool {
    let mut points = (0..SIDE * SIDE).map(|i| {
        let u = Vec2::new((i % SIDE) as f32 + 0.5, (i / SIDE) as f32 + 0.5) / SIDE as f32;
        a.sample_area(u).point
    });
    points.any(|point| {
        let [origin, direction] = [point.position, point.normal].map(|v| v.as_dvec3());
        comes_within(b, &Line { origin, direction }, near)
    })
}

/// Those of `shapes`, indices of `all`, that nearly touch another of them.
pub(crate) fn touching(all: &[Shape], shapes: &[usize]) -> Vec<usize> {
    let candidates: Vec<_> = shapes
        .iter()
        .filter(|&&i| all[i].is_convex() && all[i].can_emit())
        .map(|&i| (i, &all[i], all[i].bounds()))
        .collect();
    let mut found = vec![false; candidates.len()];
    for (i, (_, a, bounds_a)) in candidates.iter().enumerate() {
        for (j, (_, b, bounds_b)) in candidates.iter().enumerate().skip(i + 1) {
            let near = NEAR * f64::from(bounds_a.extent().max(bounds_b.extent()));
            let margin = near as f32;
            let apart = (bounds_a.min - margin).cmpgt(bounds_b.max + margin)
                | (bounds_b.min - margin).cmpgt(bounds_a.max + margin);
            if (found[i] && found[j]) || apart.any() {
                continue;
            }
            if comes_near(a, b, near) || comes_near(b, a, near) {
                (found[i], found[j]) = (true, true);
            }
        }
    }
    let touching = candidates.iter().zip(found).filter(|(_, found)| *found);
    touching.map(|((index, ..), _)| *index).collect()
}
