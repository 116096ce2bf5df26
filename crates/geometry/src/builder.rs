//! Putting a geometry together.

use crate::accelerator::{AcceleratorKind, Bounds};
use crate::geometry::{Geometry, ShapeBinding};
use crate::instance::{Group, GroupId, Instance};
use crate::placement::Placement;
use crate::primitive_index::{Contents, PrimitiveIndex, PrimitiveOwner};
use crate::shapes::Shape;
use crate::touching::touching;
use etalon_math::Animated;
use etalon_transport::{InstanceId, LightId, MaterialId, ShapeId};
use glam::DVec3;
use rayon::prelude::*;

/// Collects shapes, groups and instances.
///
/// Hits at equal distance are decided by the order in which things were added: shapes first,
/// then instances.
#[derive(Debug, Default)]
pub struct GeometryBuilder {
    shapes: Vec<Shape>,
    attachments: Vec<ShapeBinding>,
    face_materials: Vec<MaterialId>,
    world: Vec<ShapeId>,
    world_instances: Vec<InstanceId>,
    groups: Vec<Members>,
    instances: Vec<Instance>,
    /// Placements of the world.
    placements: u32,
}

/// The members of a group.
#[derive(Debug, Default)]
struct Members {
    shapes: Vec<ShapeId>,
    instances: Vec<InstanceId>,
    /// All its placements, see [`Group`].
    placements: u32,
}

/// The most placements of a group: what a hit can name.
const MOST_PLACEMENTS: u32 = (1 << 31) - 1;

impl GeometryBuilder {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    fn push(&mut self, shape: Shape, material: MaterialId, light: LightId) -> ShapeId {
        let id = ShapeId(self.shapes.len() as u32);
        self.shapes.push(shape);
        self.attachments.push(ShapeBinding {
            material,
            light,
            carrier: InstanceId::NONE,
            refractive: false,
            faces: None,
        });
        id
    }

    /// Adds a shape to the world.
    pub fn add_shape(&mut self, shape: Shape, material: MaterialId, light: LightId) -> ShapeId {
        let id = self.push(shape, material, light);
        self.world.push(id);
        id
    }

    /// Sets the light that a shape is, where lights are numbered after shapes.
    pub fn set_light(&mut self, shape: ShapeId, light: LightId) {
        self.attachments[shape.0 as usize].light = light;
    }

    /// Declares that a member of a group may be a light, carried by the only placement of that group: `depth` nested
    /// instances within an instance of the world, all of which preserve angles.
    pub fn set_carrier(&mut self, shape: ShapeId, outermost: InstanceId, depth: u32) {
        let placement = self.instances[outermost.0 as usize].first + depth;
        self.attachments[shape.0 as usize].carrier = InstanceId(placement);
    }

    /// Gives each face of a shape, see [`Shape::faces`], a material of its own.
    pub fn set_face_materials(&mut self, shape: ShapeId, materials: &[MaterialId]) {
        self.attachments[shape.0 as usize].faces = Some(self.face_materials.len() as u32);
        self.face_materials.extend_from_slice(materials);
    }

    /// Says that light is refracted into a shape of the world, so that surfaces next to its own matter
    /// however near they are.
    pub fn set_refractive(&mut self, shape: ShapeId) {
        self.attachments[shape.0 as usize].refractive = true;
    }

    /// A shape that was added.
    pub fn shape(&self, shape: ShapeId) -> &Shape {
        &self.shapes[shape.0 as usize]
    }

    /// Adds a group of shapes, which is only seen through instances. Its shapes are no lights.
    pub fn add_group(&mut self, shapes: impl IntoIterator<Item = (Shape, MaterialId)>) -> GroupId {
        let members: Vec<_> = shapes
            .into_iter()
            .map(|(shape, material)| self.push(shape, material, LightId::NONE))
            .collect();
        self.add_members(members, Vec::new())
    }

    /// Adds a shape that is only seen as a member of a group.
    pub fn add_member(&mut self, shape: Shape, material: MaterialId) -> ShapeId {
        self.push(shape, material, LightId::NONE)
    }

    /// Makes a group of members and of instances of other groups.
    pub fn add_members(&mut self, shapes: Vec<ShapeId>, instances: Vec<InstanceId>) -> GroupId {
        let mut placements = 1_u32;
        for id in &instances {
            let instance = &mut self.instances[id.0 as usize];
            instance.first = placements;
            let more = self.groups[instance.group.0 as usize].placements;
            placements = placements.saturating_add(more).min(MOST_PLACEMENTS + 1);
        }
        self.groups.push(Members {
            shapes,
            instances,
            placements,
        });
        GroupId(self.groups.len() as u32 - 1)
    }

    /// Places a group in the group that is to be made of this instance.
    pub fn add_nested_instance(
        &mut self,
        group: GroupId,
        placement: impl Into<Animated<Placement>>,
    ) -> InstanceId {
        self.instances.push(Instance {
            group,
            placement: placement.into(),
            first: 0,
        });
        InstanceId(self.instances.len() as u32 - 1)
    }

    /// Places a group in the world. `None` if with that the world holds more than 2³¹ placements of groups.
    pub fn add_instance(
        &mut self,
        group: GroupId,
        placement: impl Into<Animated<Placement>>,
    ) -> Option<InstanceId> {
        let more = self.groups[group.0 as usize].placements;
        let placements = self.placements.saturating_add(more);
        if placements > MOST_PLACEMENTS {
            return None;
        }
        let id = self.add_nested_instance(group, placement);
        self.instances[id.0 as usize].first = self.placements;
        self.world_instances.push(id);
        self.placements = placements;
        Some(id)
    }

    /// Builds the accelerators.
    pub fn build(self) -> Geometry {
        self.build_with(AcceleratorKind::default())
    }

    /// Builds accelerators of a certain kind.
    pub fn build_with(self, kind: AcceleratorKind) -> Geometry {
        let Self {
            mut shapes,
            attachments,
            face_materials,
            world,
            world_instances,
            groups,
            instances,
            placements: _,
        } = self;
        let refractive = attachments.iter().enumerate().filter(|(_, a)| a.refractive);
        let refractive: Vec<usize> = refractive.map(|(index, _)| index).collect();
        for index in touching(&shapes, &refractive) {
            shapes[index].set_touching();
        }
        let group_of = |members: Members, built: &[Group]| -> Group {
            let mut scope = PrimitiveIndex::default();
            for id in members.shapes {
                let shape = &shapes[id.0 as usize];
                let owner = PrimitiveOwner::Shape(id);
                scope.add(owner, shape.primitives(), shape.bounds());
            }
            let mut boxes = Vec::with_capacity(members.instances.len());
            for &id in &members.instances {
                let Instance {
                    group, placement, ..
                } = &instances[id.0 as usize];
                let placed = &built[group.0 as usize].scope;
                let bounds = match placed.is_endless {
                    true => Bounds::ENDLESS,
                    false => placed_bounds(placed.bounds, placement),
                };
                boxes.push(bounds);
                if !bounds.is_empty() {
                    scope.add(PrimitiveOwner::Instance(id), 1, bounds);
                }
            }
            scope.finish();
            let contents = Contents {
                scope: &scope,
                shapes: &shapes,
                instances: &members.instances,
                boxes: &boxes,
            };
            Group {
                accelerator: contents.build(kind),
                scope,
                instances: members.instances,
            }
        };
        let is_nested = groups.iter().any(|group| !group.instances.is_empty());
        let groups: Vec<Group> = if is_nested {
            // A group places only groups that were added before it.
            groups.into_iter().fold(Vec::new(), |mut built, members| {
                built.push(group_of(members, &built));
                built
            })
        } else {
            (groups.into_par_iter())
                .map(|members| group_of(members, &[]))
                .collect()
        };
        let world = Members {
            shapes: world,
            instances: world_instances,
            placements: 0,
        };
        let world = group_of(world, &groups);
        for (shape, attachment) in shapes.iter().zip(&attachments) {
            if attachment.light.is_some() {
                shape.prepare_sampling();
            }
        }
        Geometry {
            shapes,
            attachments,
            face_materials,
            groups,
            instances,
            world,
            is_nested,
        }
    }
}

/// The box around the image of a box, widened for the rounding of rays taken into the instance.
pub(crate) fn placed_bounds(bounds: Bounds, placement: &Animated<Placement>) -> Bounds {
    if bounds.is_empty() {
        return Bounds::EMPTY;
    }
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let half = (max - min) * 0.5 + 1e-6 * min.abs().max(max.abs());
    let middle = (min + max) * 0.5;
    let [low, high] = match placement.motion() {
        None => placement.start().bounds([middle - half, middle + half]),
        Some(motion) => motion.swept(middle - half, middle + half),
    };
    let outward = |v: DVec3, up: bool| {
        let round = |x: f64| {
            let y = x as f32;
            match (up, f64::from(y)) {
                (true, z) if z < x => y.next_up(),
                (false, z) if z > x => y.next_down(),
                _ => y,
            }
        };
        glam::Vec3::new(round(v.x), round(v.y), round(v.z))
    };
    Bounds {
        min: outward(low, false),
        max: outward(high, true),
    }
}
