//! Which shapes nearly touch, so that single precision cannot tell their surfaces apart.

use crate::shapes::Shape;
use crate::shapes::solid::Solid;
use glam::Vec2;

/// Surfaces closer than this, relative to the largest coordinate, need double precision: some
/// fifty roundings of a position and of the distance to it.
const NEAR: f64 = 1e-5;

/// Looks at so many points of a shape, squared.
const SIDE: u32 = 8;

/// The shape as something that a line crosses twice at most.
fn smooth(shape: &Shape) -> Option<&dyn Solid> {
    match shape.mesh() {
        Some(mesh) if mesh.is_small_and_convex() => Some(mesh),
        Some(_) => None,
        None => shape.solid(),
    }
}

/// Whether a point of `a` is near the surface of `b`.
fn comes_near(a: &Shape, b: &dyn Solid, near: f64) -> bool {
    let mut points = (0..SIDE * SIDE).map(|i| {
        let u = Vec2::new((i % SIDE) as f32 + 0.5, (i / SIDE) as f32 + 0.5) / SIDE as f32;
        a.sample_area(u).point
    });
    points.any(|point| {
        let [origin, direction] = [point.position, point.normal].map(|v| v.as_dvec3());
        let crossings = b.crossings(origin, direction);
        crossings.into_iter().any(|t| t.abs() <= near)
    })
}

/// Of `shapes` among `all`, those that nearly touch another of them.
pub(crate) fn touching(all: &[Shape], shapes: &[usize]) -> Vec<usize> {
    let candidates: Vec<_> = shapes
        .iter()
        .filter_map(|&i| Some((i, &all[i], smooth(&all[i])?, all[i].bounds())))
        .collect();
    let mut found = vec![false; candidates.len()];
    for (i, (_, a, smooth_a, bounds_a)) in candidates.iter().enumerate() {
        for (j, (_, b, smooth_b, bounds_b)) in candidates.iter().enumerate().skip(i + 1) {
            let near = NEAR * f64::from(bounds_a.extent().max(bounds_b.extent()));
            let margin = near as f32;
            let apart = (bounds_a.min - margin).cmpgt(bounds_b.max + margin)
                | (bounds_b.min - margin).cmpgt(bounds_a.max + margin);
            if (found[i] && found[j]) || apart.any() {
                continue;
            }
            if comes_near(a, *smooth_b, near) || comes_near(b, *smooth_a, near) {
                (found[i], found[j]) = (true, true);
            }
        }
    }
    let touching = candidates.iter().zip(found).filter(|(_, found)| *found);
    touching.map(|((index, ..), _)| *index).collect()
}
