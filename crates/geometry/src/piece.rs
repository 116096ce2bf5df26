//! Pieces of smooth shapes along a ray, and which of two comes first.

use crate::closest_hit::ClosestHit;
use crate::shapes::Shape;
use crate::shapes::analytic::crossing::Line;
use crate::traversal_ray::TraversalRay;

/// Distances along a ray of two smooth shapes that differ by no more than this are the same.
#[inline]
pub(crate) fn tolerance(probe: &TraversalRay, t: f64) -> f64 {
    // 2⁻⁴³: some thousand roundings.
    const RELATIVE: f64 = 1.0 / (1_u64 << 43) as f64;
    (f64::from(probe.origin.abs().max_element()) + t.abs()) * RELATIVE
}

/// Whether a crossing is in front of a ray's origin.
#[inline]
pub(crate) fn is_in_front(t: f64) -> bool {
    (t as f32) > 0.0
}

/// The order in which a ray crosses two smooth shapes whose distances are too close.
pub(crate) trait Order {
    /// A parameter below that of every crossing that is ahead of the ray.
    fn earliest(&self, probe: &TraversalRay) -> f64;
    /// Whether the crossing at `t` of a primitive is ahead of the ray: in front of its origin, or
    /// behind it but after the surface that the ray leaves, whose distance from the origin has
    /// jumped over it. False for NaN.
    fn is_ahead(&self, primitive: u32, probe: &TraversalRay, t: f64) -> bool;
    /// Whether primitive `a` comes before primitive `b` at the same place.
    fn precedes(&self, a: u32, b: u32, probe: &TraversalRay, t: f64) -> bool;
}

/// A piece of a shape that is intersected by a formula of its own, as an accelerator knows it.
pub(crate) struct Piece<'a> {
    pub(crate) shape: &'a Shape,
    pub(crate) piece: u32,
    /// Its number among all primitives.
    pub(crate) primitive: u32,
}

impl Piece<'_> {
    /// The parameter of the first crossing ahead of a ray and before `before`.
    #[inline]
    fn first(&self, probe: &TraversalRay, before: f64, order: &impl Order) -> Option<f64> {
        let line = Line::of_ray(probe.origin, probe.direction);
        let mut after = order.earliest(probe);
        if let Some(both) = self.shape.both_crossings(&line) {
            let is_ahead = |t: &f64| *t > after && order.is_ahead(self.primitive, probe, *t);
            return both.into_iter().find(is_ahead);
        }
        loop {
            let crossing = self.shape.next_crossing(self.piece, &line, after, before)?;
            if order.is_ahead(self.primitive, probe, crossing.t) {
                return Some(crossing.t);
            }
            after = crossing.t;
        }
    }

    /// Notes the nearest crossing, if it wins.
    #[inline]
    pub(crate) fn intersect(
        &self,
        probe: &TraversalRay,
        nearest: &mut ClosestHit,
        order: &impl Order,
    ) {
        // A crossing that is not nearer may still win a tie.
        let limit = f64::from(nearest.t);
        let before = limit + limit.abs() * 1e-6;
        if let Some(t) = self.first(probe, before, order) {
            let precedes = |other| order.precedes(self.primitive, other, probe, t);
            if nearest.loses_to_smooth(t, self.primitive, tolerance(probe, t), precedes) {
                nearest.set_smooth(t, self.primitive);
            }
        }
    }

    /// Whether it is crossed before `t_max`.
    #[inline]
    pub(crate) fn occludes(&self, probe: &TraversalRay, t_max: f32, order: &impl Order) -> bool {
        let first = self.first(probe, t_max.into(), order);
        first.is_some_and(|t| (t as f32) < t_max)
    }
}
