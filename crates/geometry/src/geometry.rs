//! All surfaces of a scene: intersection, and the vertex at a hit.

use crate::accelerator::observer::{Observer, Obstruction, Passing, Unobserved, Visits};
use crate::accelerator::{Accelerator, Bounds};
use crate::closest_hit::ClosestHit;
use crate::instance::{Group, Instance};
use crate::local_interaction::{LocalInteraction, Owner};
use crate::primitive_index::PrimitiveOwner;
use crate::shapes::Shape;
use crate::shapes::analytic::crossing::Line;
use crate::traversal_ray::TraversalRay;
use crate::world_others::WorldOthers;
use core::cell::Cell;
use etalon_transport::{Hit, InstanceId, LightId, MaterialId, Ray, ShapeId, SurfaceInteraction};
use glam::Vec2;

/// Properties of a shape other than its geometry.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShapeBinding {
    pub(crate) material: MaterialId,
    pub(crate) light: LightId,
    /// The placement of the world that carries it, if it moves and emits.
    pub(crate) carrier: InstanceId,
    /// Whether light is refracted into it.
    pub(crate) refractive: bool,
    /// Index of the first of its faces' materials in [`Geometry::face_materials`], if they have their own.
    pub(crate) faces: Option<u32>,
}

/// All surfaces of a scene, immutable; made by a [`GeometryBuilder`](crate::GeometryBuilder).
#[derive(Debug)]
pub struct Geometry {
    pub(crate) shapes: Vec<Shape>,
    pub(crate) attachments: Vec<ShapeBinding>,
    pub(crate) face_materials: Vec<MaterialId>,
    pub(crate) groups: Vec<Group>,
    pub(crate) instances: Vec<Instance>,
    pub(crate) world: Group,
    /// Whether groups place groups; if not, the world's placements are its instances.
    pub(crate) is_nested: bool,
}

/// A surface that was hit, with the primitive and its parameters.
struct Found {
    surface: LocalInteraction,
    primitive: u32,
    parameters: Vec2,
}

/// Counts of the geometry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GeometryStatistics {
    /// Triangles stored.
    pub triangles: usize,
    /// Triangles seen, those of instances counted each time.
    pub instanced_triangles: usize,
    /// Shapes stored.
    pub shapes: usize,
    /// Instances.
    pub instances: usize,
    /// Nodes of all accelerators.
    pub nodes: usize,
    /// Memory of meshes and accelerators (bytes).
    pub bytes: usize,
    /// Memory of accelerators, which hold copies of all triangles' corners (bytes).
    pub accelerator_bytes: usize,
}

impl Geometry {
    #[inline(always)]
    fn probe(&self, ray: &Ray) -> TraversalRay {
        // Changed in place: a struct update would copy it.
        let mut probe = self.world.scope.probe(ray.origin, ray.direction);
        probe.departure = ray.departure;
        probe.time = ray.time;
        probe
    }

    /// The primitives of the world that are not triangles, for accelerators.
    #[inline(always)]
    pub(crate) fn others<'a, C>(&'a self, observer: &'a C) -> WorldOthers<'a, C> {
        WorldOthers {
            geometry: self,
            observer,
        }
    }

    /// The nearest surface along a ray, strictly between its ends.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.find(ray, &Unobserved)
    }

    /// The nearest surface along a ray, and what had to be looked at to find it.
    pub fn intersect_counted(&self, ray: &Ray) -> (Option<Hit>, Visits) {
        let visits = Cell::new(Visits::default());
        (self.find(ray, &visits), visits.get())
    }

    #[inline(always)]
    fn find(&self, ray: &Ray, observer: &impl Observer) -> Option<Hit> {
        let probe = self.probe(ray);
        let mut nearest = ClosestHit::within(ray.t_max);
        (self.world.accelerator).intersect(&probe, &self.others(observer), &mut nearest);
        nearest.found.then(|| self.hit(&nearest))
    }

    #[inline(always)]
    pub(crate) fn hit(&self, nearest: &ClosestHit) -> Hit {
        let (shape, primitive, instance) = match self.world.scope.locate(nearest.primitive) {
            (PrimitiveOwner::Shape(shape), primitive) => (shape, primitive, InstanceId::NONE),
            (PrimitiveOwner::Instance(_), _) => self.placed(nearest.path, nearest.inner),
        };
        Hit {
            t: nearest.t,
            parameters: nearest.parameters,
            shape,
            primitive,
            instance,
            slot: nearest.slot,
        }
    }

    /// The shape of a primitive of the innermost group of a placement, and the primitive's number there.
    fn placed(&self, path: u32, inner: u32) -> (ShapeId, u32, InstanceId) {
        let path = InstanceId(path);
        match self.innermost(path).scope.locate(inner) {
            (PrimitiveOwner::Shape(shape), primitive) => (shape, primitive, path),
            (PrimitiveOwner::Instance(_), _) => unreachable!("a placement ends with shapes"),
        }
    }

    /// Whether anything lies strictly between the ends of a ray.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.is_blocked(ray, &Unobserved)
    }

    /// What lies strictly between the ends of a ray, where some shapes are opaque.
    #[inline]
    pub fn obstruction(&self, ray: &Ray, is_opaque: impl Fn(ShapeId) -> bool) -> Obstruction {
        let passing = Passing {
            is_opaque,
            passed: Cell::new(false),
        };
        match self.is_blocked(ray, &passing) {
            true => Obstruction::Opaque,
            false if passing.passed.get() => Obstruction::Passable,
            false => Obstruction::Nothing,
        }
    }

    /// Whether anything lies strictly between the ends of a ray, and what had to be looked at to know.
    pub fn occluded_counted(&self, ray: &Ray) -> (bool, Visits) {
        let visits = Cell::new(Visits::default());
        (self.is_blocked(ray, &visits), visits.get())
    }

    #[inline(always)]
    fn is_blocked(&self, ray: &Ray, observer: &impl Observer) -> bool {
        let probe = self.probe(ray);
        let others = self.others(observer);
        (self.world.accelerator).occluded(&probe, &others, ray.t_max)
    }

    #[inline]
    fn owner(&self, shape: ShapeId, face: u32, instance: InstanceId) -> Owner {
        let ShapeBinding {
            mut material,
            light,
            faces,
            ..
        } = self.attachments[shape.0 as usize];
        if let Some(first) = faces {
            material = self.face_materials[(first + face) as usize];
        }
        Owner {
            shape,
            instance,
            material,
            light,
        }
    }

    /// The light that the hit shape is, or [`LightId::NONE`].
    #[inline]
    pub fn light(&self, hit: &Hit) -> LightId {
        self.attachments[hit.shape.0 as usize].light
    }

    /// The material of a shape; `None` if its faces have their own.
    #[inline]
    pub fn material_of(&self, shape: ShapeId) -> Option<MaterialId> {
        let binding = &self.attachments[shape.0 as usize];
        binding.faces.is_none().then_some(binding.material)
    }

    /// The differential geometry of a hit.
    #[inline]
    pub fn vertex(&self, ray: &Ray, hit: &Hit) -> SurfaceInteraction {
        if hit.instance.is_some() {
            let found = self.surface_in(&self.world, hit.instance.0, ray, hit);
            return self.vertex_of(ray, hit, found);
        }
        self.surface(&self.world, ray, hit, |found| {
            self.vertex_of(ray, hit, found)
        })
    }

    #[inline(always)]
    fn vertex_of(&self, ray: &Ray, hit: &Hit, found: Found) -> SurfaceInteraction {
        let owner = self.owner(hit.shape, found.surface.face, hit.instance);
        let mut vertex = (found.surface).vertex(&owner, found.primitive, found.parameters);
        vertex.t = hit.t;
        vertex.time = ray.time;
        vertex
    }

    /// The surface where a ray in a group's space hits something of its placement number `path`.
    fn surface_in(&self, group: &Group, path: u32, ray: &Ray, hit: &Hit) -> Found {
        let (instance, rest) = self.enter(group, path);
        let inner = &self.groups[instance.group.0 as usize];
        instance.placement.at(ray.time, |placement| {
            // Triangles need only the time and the hit.
            let mut local = *ray;
            if rest > 0 || self.shapes[hit.shape.0 as usize].is_analytic() {
                (local.origin, local.direction) = placement.local_ray(ray.origin, ray.direction);
            }
            let found = if rest == 0 {
                self.surface(inner, &local, hit, |found| found)
            } else {
                self.surface_in(inner, rest, &local, hit)
            };
            Found {
                surface: found.surface.placed(placement),
                ..found
            }
        })
    }

    /// The surface where a ray in a group's space hits a shape of it, as `take` takes it.
    #[inline(always)]
    fn surface<R>(&self, group: &Group, ray: &Ray, hit: &Hit, take: impl Fn(Found) -> R) -> R {
        let shape = &self.shapes[hit.shape.0 as usize];
        if shape.is_analytic() {
            return take(Self::crossed(shape, ray, hit));
        }
        // Tracing the ray has brought the accelerator's copy of the corners close.
        let corners = || group.accelerator.corners(hit.slot);
        shape.at_triangle(hit.primitive, hit.parameters, corners, |surface| {
            take(Found {
                surface,
                primitive: hit.primitive,
                parameters: hit.parameters,
            })
        })
    }

    /// The same of a shape that is intersected by a formula.
    #[inline(never)] // So that what triangles need is not spread over memory.
    fn crossed(shape: &Shape, ray: &Ray, hit: &Hit) -> Found {
        // Again, as it was found: rounding t would move the point of a small shape far
        // away to anywhere on it.
        let line = Line::of_ray(ray.origin, ray.direction);
        let crossing = shape.crossing_near(hit.primitive, &line, hit.t.into());
        let point = line.at(crossing.t);
        if let Some(mesh) = shape.mesh() {
            let (primitive, parameters) = mesh.place_near(point);
            let corners = || mesh.corners(primitive);
            let surface = shape.triangle(primitive, parameters, corners);
            return Found {
                surface: mesh.with_depth(primitive, surface.expect("it has triangles")),
                primitive,
                parameters,
            };
        }
        let surface = shape.surface_at(hit.primitive, point, &crossing);
        let surface = surface.expect("it has no triangles");
        Found {
            parameters: surface.uv,
            primitive: hit.primitive,
            surface,
        }
    }

    /// Whether something has no end.
    pub fn is_endless(&self) -> bool {
        self.world.scope.is_endless
    }

    /// The box around everything that has an end; empty if there is nothing.
    pub fn bounds(&self) -> Bounds {
        self.world.scope.bounds
    }

    /// All shapes, those of groups included.
    pub fn shapes(&self) -> impl Iterator<Item = ShapeId> {
        (0..self.shapes.len() as u32).map(ShapeId)
    }

    /// A shape.
    pub fn shape(&self, shape: ShapeId) -> &Shape {
        &self.shapes[shape.0 as usize]
    }

    /// Counts of the geometry.
    pub fn statistics(&self) -> GeometryStatistics {
        let triangles = |shape: &Shape| shape.mesh().map_or(0, |m| m.triangle_count());
        let accelerators = || {
            let groups = self.groups.iter().map(|g| &g.accelerator);
            groups.chain([&self.world.accelerator])
        };
        let group_of = |id: &InstanceId| self.instances[id.0 as usize].group.0 as usize;
        let own = |group: &Group| {
            let placed = group.instances.iter();
            let placed = placed.filter(|id| !self.groups[group_of(id)].scope.bounds.is_empty());
            group.scope.count() as usize - placed.count()
        };
        // Groups place only groups that were added before them.
        let mut seen: Vec<usize> = Vec::with_capacity(self.groups.len());
        let placed = |group: &Group, seen: &[usize]| -> usize {
            let instances = group.instances.iter();
            instances
                .map(|id| seen[group_of(id)])
                .fold(0, usize::saturating_add)
        };
        for group in &self.groups {
            seen.push(own(group).saturating_add(placed(group, &seen)));
        }
        let instanced = placed(&self.world, &seen);
        let meshes: usize = self
            .shapes
            .iter()
            .filter_map(Shape::mesh)
            .map(|m| m.bytes())
            .sum();
        let accelerator_bytes = accelerators().map(Accelerator::bytes).sum();
        GeometryStatistics {
            triangles: self.shapes.iter().map(triangles).sum(),
            instanced_triangles: instanced,
            shapes: self.shapes.len(),
            instances: self.instances.len(),
            nodes: accelerators().map(Accelerator::nodes).sum(),
            bytes: meshes + accelerator_bytes,
            accelerator_bytes,
        }
    }
}
