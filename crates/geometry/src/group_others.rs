//! Primitives of a group that are not triangles: smooth shapes and instances.

use crate::accelerator::CustomPrimitives;
use crate::accelerator::observer::Observer;
use crate::closest_hit::ClosestHit;
use crate::geometry::Geometry;
use crate::instance::Group;
use crate::piece::{Order, Piece, is_in_front};
use crate::primitive_index::PrimitiveOwner;
use crate::traversal_ray::TraversalRay;
use etalon_transport::ShapeId;

/// Intersects the smooth shapes and instances of a group.
pub(crate) struct GroupOthers<'a, C> {
    pub(crate) geometry: &'a Geometry,
    pub(crate) group: &'a Group,
    pub(crate) observer: &'a C,
}

impl<C> GroupOthers<'_, C> {
    #[inline]
    fn piece(&self, shape: ShapeId, piece: u32, primitive: u32) -> Piece<'_> {
        Piece {
            shape: &self.geometry.shapes[shape.0 as usize],
            piece,
            primitive,
        }
    }
}

/// Shapes of instances are known in single precision only.
impl<C> Order for GroupOthers<'_, C> {
    #[inline]
    fn earliest(&self, _: &TraversalRay) -> f64 {
        0.0
    }

    #[inline]
    fn is_ahead(&self, _: u32, _: &TraversalRay, t: f64) -> bool {
        is_in_front(t)
    }

    #[inline]
    fn precedes(&self, a: u32, b: u32, _: &TraversalRay, _: f64) -> bool {
        a < b
    }
}

impl<C: Observer> CustomPrimitives for GroupOthers<'_, C> {
    #[inline(always)]
    fn stops(&self, primitive: u32) -> bool {
        self.observer.stops(|| self.group.scope.shape_of(primitive))
    }

    #[inline(always)]
    fn observer(&self) -> &impl Observer {
        self.observer
    }

    #[inline]
    fn intersect(&self, primitive: u32, probe: &TraversalRay, nearest: &mut ClosestHit) {
        match self.group.scope.locate(primitive) {
            (PrimitiveOwner::Shape(shape), piece) => {
                (self.piece(shape, piece, primitive)).intersect(probe, nearest, self);
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
        match self.group.scope.locate(primitive) {
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
