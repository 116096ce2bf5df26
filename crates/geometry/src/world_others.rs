//! Primitives of the world that are not triangles: smooth shapes, also touching ones, and instances.

use crate::accelerator::CustomPrimitives;
use crate::accelerator::observer::Observer;
use crate::closest_hit::ClosestHit;
use crate::geometry::Geometry;
use crate::piece::{Order, Piece, is_in_front, tolerance};
use crate::primitive_index::PrimitiveOwner;
use crate::shapes::analytic::crossing::Line;
use crate::traversal_ray::TraversalRay;
use etalon_transport::ShapeId;

/// Intersects the smooth shapes and instances of the world.
pub(crate) struct WorldOthers<'a, C> {
    pub(crate) geometry: &'a Geometry,
    pub(crate) observer: &'a C,
}

impl<C> WorldOthers<'_, C> {
    #[inline]
    fn piece(&self, shape: ShapeId, piece: u32, primitive: u32) -> Piece<'_> {
        Piece {
            shape: &self.geometry.shapes[shape.0 as usize],
            piece,
            primitive,
        }
    }

    /// Whether the crossing at `t` of a primitive, about where the ray starts, is after the surface
    /// that the ray leaves.
    #[cold]
    fn is_after_start(&self, primitive: u32, probe: &TraversalRay, t: f64) -> bool {
        let left = probe.departure.shape;
        let PrimitiveOwner::Shape(shape) = self.geometry.world.scope.locate(primitive).0 else {
            return is_in_front(t);
        };
        let from = &self.geometry.shapes[left.0 as usize];
        if !from.is_analytic() {
            return is_in_front(t);
        }
        let line = Line::of_ray(probe.origin, probe.direction);
        let departed = f64::from(probe.departure.t);
        let crossing = from.crossing_near(probe.departure.primitive, &line, departed);
        let apart = t - crossing.t;
        if shape == left {
            // Within rounding it is the crossing that the ray leaves.
            return is_in_front(t) && apart > tolerance(probe, t);
        }
        if apart.abs() > tolerance(probe, t) {
            return apart > 0.0;
        }
        let both = self.refractive(primitive).is_some()
            && self.geometry.attachments[left.0 as usize].refractive;
        both && self.is_outer(left, shape, probe, t)
    }
}

impl<C> WorldOthers<'_, C> {
    /// Whether the ray crosses `a` before `b` at the distance `t` that both have. Media that touch do
    /// not overlap, so it leaves one before it enters the other. Of two that it enters the shape
    /// added first is the outer one, and so the last that it leaves.
    fn is_outer(&self, a: ShapeId, b: ShapeId, probe: &TraversalRay, t: f64) -> bool {
        let place = probe.origin.as_dvec3() + probe.direction.as_dvec3() * t;
        let leaves = |shape: ShapeId| {
            let shape = &self.geometry.shapes[shape.0 as usize];
            let line = Line::of_ray(probe.origin, probe.direction);
            (0..shape.primitives()).any(|piece| {
                let crossing = shape.crossing_near(piece, &line, t);
                let surface = shape.surface_at(piece, place, &crossing);
                surface.is_some_and(|surface| surface.normal.dot(probe.direction) > 0.0)
            })
        };
        match (leaves(a), leaves(b)) {
            (true, true) => a.0 > b.0,
            (false, false) => a.0 < b.0,
            (leaves_a, _) => leaves_a,
        }
    }

    /// The shape, if light is refracted into it.
    fn refractive(&self, primitive: u32) -> Option<ShapeId> {
        match self.geometry.world.scope.locate(primitive).0 {
            PrimitiveOwner::Shape(shape) => {
                let refractive = self.geometry.attachments[shape.0 as usize].refractive;
                refractive.then_some(shape)
            }
            PrimitiveOwner::Instance(_) => None,
        }
    }
}

impl<C> Order for WorldOthers<'_, C> {
    #[inline]
    fn earliest(&self, probe: &TraversalRay) -> f64 {
        if !probe.departure.shape.is_some() {
            return 0.0;
        }
        let t = 4.0 * f64::from(probe.departure.t);
        t - 2.0 * tolerance(probe, t)
    }

    #[inline]
    fn is_ahead(&self, primitive: u32, probe: &TraversalRay, t: f64) -> bool {
        // First what holds for nearly all that comes here; false for NaN.
        let margin = tolerance(probe, t);
        if t > margin || !probe.departure.shape.is_some() {
            return is_in_front(t);
        }
        t > 4.0 * f64::from(probe.departure.t) - margin && self.is_after_start(primitive, probe, t)
    }

    fn precedes(&self, a: u32, b: u32, probe: &TraversalRay, t: f64) -> bool {
        match (self.refractive(a), self.refractive(b)) {
            (Some(first), Some(second)) => self.is_outer(first, second, probe, t),
            _ => a < b,
        }
    }
}

impl<C: Observer> CustomPrimitives for WorldOthers<'_, C> {
    #[inline(always)]
    fn stops(&self, primitive: u32) -> bool {
        self.observer
            .stops(|| self.geometry.world.scope.shape_of(primitive))
    }

    #[inline(always)]
    fn observer(&self) -> &impl Observer {
        self.observer
    }

    #[inline]
    fn intersect(&self, primitive: u32, probe: &TraversalRay, nearest: &mut ClosestHit) {
        match self.geometry.world.scope.locate(primitive) {
            (PrimitiveOwner::Shape(shape), piece) => {
                self.piece(shape, piece, primitive)
                    .intersect(probe, nearest, self);
            }
            (PrimitiveOwner::Instance(instance), _) => {
                (self.geometry).intersect_instance(
                    instance,
                    primitive,
                    probe,
                    nearest,
                    self.observer,
                );
            }
        }
    }

    #[inline]
    fn occludes(&self, primitive: u32, probe: &TraversalRay, t_max: f32) -> bool {
        match self.geometry.world.scope.locate(primitive) {
            (PrimitiveOwner::Shape(shape), piece) => {
                (self.piece(shape, piece, primitive)).occludes(probe, t_max, self)
                    && self.observer.stops(|| shape)
            }
            (PrimitiveOwner::Instance(instance), _) => {
                self.geometry
                    .occluded_instance(instance, probe, t_max, self.observer)
            }
        }
    }
}
