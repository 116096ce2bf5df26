//! The things that one accelerator knows: the world's, or those of a group.

use crate::accelerator::{Accelerator, AcceleratorKind, Bounds, Primitives};
use crate::shapes::Shape;
use crate::traversal_ray::TraversalRay;
use core::hint::select_unpredictable;
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
    /// From this primitive on, and this member, each member has one: instances, and smooth shapes at the end.
    single: (u32, usize),
    /// Before that: the member of every primitive whose number is a multiple of 2^`shift`, and the last one; see
    /// [`PrimitiveIndex::finish`].
    known: Vec<u32>,
    shift: u32,
    /// Box of everything that has an end.
    pub(crate) bounds: Bounds,
    /// Whether anything has none.
    pub(crate) is_endless: bool,
    /// The largest magnitude of a coordinate.
    extent: f32,
}

/// With so many steps, there is rarely more than one member between two.
const STEPS_PER_MEMBER: usize = 8;

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
        if primitives > 1 {
            self.single = (self.count, self.members.len());
        }
        if bounds.is_endless() {
            self.is_endless = true;
            return;
        }
        self.bounds = self.bounds.union(bounds);
        self.extent = self.bounds.extent();
    }

    /// Prepares [`PrimitiveIndex::locate`], when everything has been added.
    pub(crate) fn finish(&mut self) {
        let (count, members) = self.single;
        let steps = members.saturating_mul(STEPS_PER_MEMBER);
        self.shift = 0;
        while (count >> self.shift) as usize > steps {
            self.shift += 1;
        }
        let member = |primitive: u32| {
            let after = self
                .members
                .partition_point(|member| member.first <= primitive);
            after.saturating_sub(1) as u32
        };
        let steps = (0..count).step_by(1 << self.shift);
        self.known = steps.chain(count.checked_sub(1)).map(member).collect();
    }

    /// Number of primitives.
    pub(crate) fn count(&self) -> u32 {
        self.count
    }

    /// The largest magnitude of a coordinate of anything that has an end.
    #[inline]
    pub(crate) fn extent(&self) -> f32 {
        self.extent
    }

    /// Whose primitive it is, and its number there.
    #[inline]
    pub(crate) fn locate(&self, primitive: u32) -> (PrimitiveOwner, u32) {
        let members = self.members.as_slice();
        let (first, member) = self.single;
        if primitive >= first {
            return (members[member + (primitive - first) as usize].thing, 0);
        }
        let step = (primitive >> self.shift) as usize;
        let (mut at, last) = (self.known[step] as usize, self.known[step + 1] as usize);
        // The last one that does not begin after it, which branches could not predict.
        let mut count = last - at + 1;
        while count > 1 {
            let half = count / 2;
            let is_beyond = members[at + half].first <= primitive;
            at = select_unpredictable(is_beyond, at + half, at);
            count -= half;
        }
        let member = members[at];
        (member.thing, primitive - member.first)
    }

    /// The shape that a triangle belongs to.
    #[inline]
    pub(crate) fn shape_of(&self, triangle: u32) -> ShapeId {
        match self.locate(triangle).0 {
            PrimitiveOwner::Shape(shape) => shape,
            PrimitiveOwner::Instance(_) => unreachable!("an instance is no triangle"),
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::with_cases(256) })]

        /// Mutants rejected: a step too short or too long, the last member left out, members between two steps not searched.
        #[test]
        fn every_primitive_has_its_owner(sizes in prop::collection::vec(prop_oneof![0..3_u32, 1..2_u32, 1..3000_u32], 1..40)) {
            let mut index = PrimitiveIndex::default();
            let mut expected = Vec::new();
            for (i, size) in (0..).zip(sizes) {
                index.add(PrimitiveOwner::Shape(ShapeId(i)), size, Bounds::EMPTY);
                expected.extend((0..size).map(|primitive| (i, primitive)));
            }
            index.finish();
            for (primitive, expected) in (0..).zip(expected) {
                let (owner, own) = index.locate(primitive);
                prop_assert!(matches!(owner, PrimitiveOwner::Shape(shape) if shape.0 == expected.0));
                prop_assert_eq!(own, expected.1);
            }
        }
    }
}
