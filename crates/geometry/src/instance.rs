//! Groups of shapes, placed any number of times, also in one another.

use crate::accelerator::Accelerator;
use crate::accelerator::observer::Observer;
use crate::closest_hit::ClosestHit;
use crate::geometry::Geometry;
use crate::group_others::GroupOthers;
use crate::placement::Placement;
use crate::primitive_index::PrimitiveIndex;
use crate::traversal_ray::TraversalRay;
use etalon_math::Animated;
use etalon_transport::InstanceId;

/// A group of shapes that instances place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct GroupId(pub u32);

/// Shapes and placed groups with an accelerator of their own.
///
/// A group's *placements* are all ways down to shapes: the group itself, number 0, and those of the groups that it
/// places, in the order of its instances. The world's are numbered so that the first instance begins with 0.
#[derive(Debug)]
pub(crate) struct Group {
    pub(crate) scope: PrimitiveIndex,
    pub(crate) accelerator: Accelerator,
    /// Its instances, by ascending [`Instance::first`].
    pub(crate) instances: Vec<InstanceId>,
}

/// A placed group.
#[derive(Debug)]
pub(crate) struct Instance {
    pub(crate) group: GroupId,
    pub(crate) placement: Animated<Placement>,
    /// The first of its placements, among those of the group it belongs to or of the world.
    pub(crate) first: u32,
}

impl Geometry {
    /// The instance of a group (or of the world) in which its placement number `path` lies, and the number in there.
    #[inline]
    pub(crate) fn enter(&self, group: &Group, path: u32) -> (&Instance, u32) {
        let id = if self.is_nested {
            let first = |id: &InstanceId| self.instances[id.0 as usize].first;
            group.instances[group.instances.partition_point(|id| first(id) <= path) - 1]
        } else {
            InstanceId(path)
        };
        let instance = &self.instances[id.0 as usize];
        (instance, path - instance.first)
    }

    /// The group in which a placement of the world ends.
    #[inline]
    pub(crate) fn innermost(&self, placement: InstanceId) -> &Group {
        let mut group = &self.world;
        let mut path = placement.0;
        loop {
            let (instance, rest) = self.enter(group, path);
            group = &self.groups[instance.group.0 as usize];
            if rest == 0 {
                return group;
            }
            path = rest;
        }
    }

    /// An instance's group and the ray in its space.
    #[inline]
    fn inside(&self, instance: &Instance, probe: &TraversalRay) -> (&Group, TraversalRay) {
        let group = &self.groups[instance.group.0 as usize];
        let (origin, direction) = (instance.placement).at(probe.time, |placement| {
            placement.local_ray(probe.origin, probe.direction)
        });
        let mut local = group.scope.probe(origin, direction);
        local.time = probe.time;
        (group, local)
    }

    /// Notes the nearest hit in an instance, which is `primitive` of its accelerator, if it wins.
    pub(crate) fn intersect_instance(
        &self,
        instance: InstanceId,
        primitive: u32,
        probe: &TraversalRay,
        nearest: &mut ClosestHit,
        observer: &impl Observer,
    ) {
        let instance = &self.instances[instance.0 as usize];
        let (group, local) = self.inside(instance, probe);
        let mut inside = nearest.inside(primitive);
        let others = GroupOthers {
            geometry: self,
            group,
            observer,
        };
        (group.accelerator).intersect(&local, &others, &mut inside);
        nearest.set_inside(primitive, instance.first, &inside);
    }

    /// Whether anything of an instance is hit before `t_max`.
    pub(crate) fn occluded_instance(
        &self,
        instance: InstanceId,
        probe: &TraversalRay,
        t_max: f32,
        observer: &impl Observer,
    ) -> bool {
        let (group, local) = self.inside(&self.instances[instance.0 as usize], probe);
        let others = GroupOthers {
            geometry: self,
            group,
            observer,
        };
        group.accelerator.occluded(&local, &others, t_max)
    }
}
