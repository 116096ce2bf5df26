//! The things that one accelerator knows: the world's, or those of a group.

use crate::accelerator::visits::Counter;
use crate::accelerator::{Accelerator, AcceleratorKind, Bounds, CustomPrimitives, Primitives};
use crate::closest_hit::ClosestHit;
use crate::geometry::Geometry;
use crate::instance::Group;
use crate::shapes::Shape;
use crate::shapes::analytic::crossing::Line;
use crate::traversal_ray::TraversalRay;
use etalon_transport::{InstanceId, ShapeId};
use glam::Vec3;

/// A run of consecutive primitives that belong together.
#[derive(Clone, Copy, Debug)]
struct PrimitiveRange {
    first: u32,
    thing: PrimitiveOwner,
}

/// The owner of a range of primitives.
#[derive(Clone, Copy, Debug)]
pub(crate) enum PrimitiveOwner {
    /// A shape: its triangles, or one primitive if it is in one piece.
    Shape(ShapeId),
    /// An instance: one primitive.
    Instance(InstanceId),
}

/// Numbers the primitives of shapes and instances, in the order in which they were added.
#[derive(Debug, Default)]
pub(crate) struct PrimitiveIndex {
    members: Vec<PrimitiveRange>,
    count: u32,
    /// Box of everything that has an end.
    pub(crate) bounds: Bounds,
    /// Whether anything has none.
    pub(crate) is_endless: bool,
    /// The largest magnitude of a coordinate.
    extent: f32,
}

impl Default for Bounds {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl PrimitiveIndex {
    /// Adds an owner of so many primitives.
    pub(crate) fn add(&mut self, thing: PrimitiveOwner, primitives: u32, bounds: Bounds) {
        if primitives == 0 {
            return;
        }
        self.members.push(PrimitiveRange {
            first: self.count,
            thing,
        });
        self.count = self
            .count
            .checked_add(primitives)
            .expect("fewer than 2³² primitives");
        if bounds.is_endless() {
            self.is_endless = true;
            return;
        }
        self.bounds = self.bounds.union(bounds);
        self.extent = self.bounds.extent();
    }

    /// Number of primitives.
    pub(crate) fn count(&self) -> u32 {
        self.count
    }

    /// Whose primitive it is, and its number there.
    #[inline]
    pub(crate) fn locate(&self, primitive: u32) -> (PrimitiveOwner, u32) {
        let member = match self.members.as_slice() {
            [only] => *only,
            members => members[members.partition_point(|m| m.first <= primitive) - 1],
        };
        (member.thing, primitive - member.first)
    }

    /// A ray ready for this scope's accelerator.
    #[inline(always)]
    pub(crate) fn probe(&self, origin: Vec3, direction: Vec3) -> TraversalRay {
        TraversalRay::new(origin, direction, self.extent)
    }
}

/// A scope with the boxes of its instances, as an accelerator wants to see it.
pub(crate) struct Contents<'a> {
    pub(crate) scope: &'a PrimitiveIndex,
    pub(crate) shapes: &'a [Shape],
    /// Its instances in ascending order, …
    pub(crate) instances: &'a [InstanceId],
    /// … and their boxes.
    pub(crate) boxes: &'a [Bounds],
}

impl Contents<'_> {
    pub(crate) fn build(&self, kind: AcceleratorKind) -> Accelerator {
        Accelerator::build(kind, self)
    }
}

impl Primitives for Contents<'_> {
    fn any_endless(&self) -> bool {
        self.scope.is_endless
    }

    fn len(&self) -> usize {
        self.scope.count as usize
    }

    fn triangle(&self, primitive: u32) -> Option<[Vec3; 3]> {
        match self.scope.locate(primitive) {
            (PrimitiveOwner::Shape(shape), index) => {
                let mesh = self.shapes[shape.0 as usize].triangles()?;
                Some(mesh.corners(index))
            }
            (PrimitiveOwner::Instance(_), _) => None,
        }
    }

    fn is_triangle(&self, primitive: u32) -> bool {
        match self.scope.locate(primitive).0 {
            PrimitiveOwner::Shape(shape) => self.shapes[shape.0 as usize].triangles().is_some(),
            PrimitiveOwner::Instance(_) => false,
        }
    }

    fn bounds(&self, primitive: u32) -> Bounds {
        match self.scope.locate(primitive) {
            (PrimitiveOwner::Shape(shape), index) => {
                let shape = &self.shapes[shape.0 as usize];
                match shape.triangles() {
                    Some(mesh) => Bounds::around(&mesh.corners(index)),
                    None => shape.piece_bounds(index),
                }
            }
            (PrimitiveOwner::Instance(instance), _) => {
                let found = self.instances.binary_search_by_key(&instance.0, |id| id.0);
                found.map_or(Bounds::EMPTY, |index| self.boxes[index])
            }
        }
    }
}

/// Intersects the smooth shapes and instances of a group.
pub(crate) struct GroupOthers<'a, C> {
    pub(crate) geometry: &'a Geometry,
    pub(crate) group: &'a Group,
    pub(crate) counter: &'a C,
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

impl<C: Counter> CustomPrimitives for GroupOthers<'_, C> {
    #[inline(always)]
    fn counter(&self) -> &impl Counter {
        self.counter
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
                    self.counter,
                );
            }
        }
    }

    #[inline]
    fn occludes(&self, primitive: u32, probe: &TraversalRay, t_max: f32) -> bool {
        match self.group.scope.locate(primitive) {
            (PrimitiveOwner::Shape(shape), piece) => {
                (self.piece(shape, piece, primitive)).occludes(probe, t_max, self)
            }
            (PrimitiveOwner::Instance(instance), _) => {
                self.geometry
                    .occluded_instance(instance, probe, t_max, self.counter)
            }
        }
    }
}

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
        let line = Line {
            origin: probe.origin.as_dvec3(),
            direction: probe.direction.as_dvec3(),
        };
        let mut after = order.earliest(probe);
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
