//! Every shape, and the one list through which a plugin's name finds its shape.

mod convex;
pub mod cube;
pub mod cylinder;
pub mod disk;
mod file_mesh;
pub mod mesh;
pub mod rectangle;
pub(crate) mod solid;
pub mod sphere;
mod vertex_normals;

use crate::accelerator::Bounds;
use crate::surface::Surface;
use cylinder::Cylinder;
use disk::Disk;
use etalon_math::DirectionCone;
use etalon_params::Params;
use etalon_sampling::warps::{SphericalTriangle, square_to_triangle};
use etalon_transport::{Build, Receiver, SampledPoint, SurfacePoint};
use glam::{DVec3, Vec2, Vec3};
use mesh::Mesh;
use rectangle::Rectangle;
use solid::Solid;
use sphere::Sphere;
use vertex_normals::vertex_normals;

/// A shape in the world (or in the space of the group it belongs to).
#[derive(Debug)]
#[allow(clippy::large_enum_variant)] // Shapes are few; a box would be one more place to look.
pub enum Shape {
    /// Triangles.
    Mesh(Mesh),
    /// A rectangle.
    Rectangle(Rectangle),
    /// A disk.
    Disk(Disk),
    /// A sphere.
    Sphere(Sphere),
    /// An open cylinder.
    Cylinder(Cylinder),
}

type FromParams = fn(&Params<'_>, &mut dyn Build) -> Option<Shape>;

/// The list of shape plugins.
const PLUGINS: [(&str, FromParams); 8] = [
    ("obj", |p, b| file_mesh::obj(p, b).map(Shape::Mesh)),
    ("ply", |p, b| file_mesh::ply(p, b).map(Shape::Mesh)),
    ("serialized", |p, b| {
        file_mesh::serialized(p, b).map(Shape::Mesh)
    }),
    ("cube", |p, _| cube::from_params(p).map(Shape::Mesh)),
    ("rectangle", |p, _| {
        Rectangle::from_params(p).map(Shape::Rectangle)
    }),
    ("disk", |p, _| Disk::from_params(p).map(Shape::Disk)),
    ("sphere", |p, _| Sphere::from_params(p).map(Shape::Sphere)),
    ("cylinder", |p, _| {
        Cylinder::from_params(p).map(Shape::Cylinder)
    }),
];

impl Shape {
    /// The names of the shape plugins.
    pub fn plugins() -> impl Iterator<Item = &'static str> {
        PLUGINS.iter().map(|(name, _)| *name)
    }

    /// Makes a shape from its description. Only the shape's own parameters are read; nested
    /// materials, lights and media are the caller's, as is [`Params::finish`]. After a mistake,
    /// which has been recorded, or if the plugin is not a shape of this list, `None`.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let name = params.node.plugin.value.as_str();
        let (_, from_params) = PLUGINS.iter().find(|(plugin, _)| *plugin == name)?;
        from_params(params, build)
    }

    /// The triangles, if it is made of triangles.
    #[inline]
    pub(crate) fn mesh(&self) -> Option<&Mesh> {
        match self {
            Self::Mesh(mesh) => Some(mesh),
            Self::Rectangle(rectangle) => Some(rectangle.mesh()),
            _ => None,
        }
    }

    /// The triangles that an accelerator intersects.
    #[inline]
    pub(crate) fn triangles(&self) -> Option<&Mesh> {
        self.mesh().filter(|mesh| !mesh.touches)
    }

    /// Says that it nearly touches another shape, so that single precision does not tell them apart.
    pub(crate) fn set_touching(&mut self) {
        match self {
            Self::Mesh(mesh) => mesh.touches = true,
            Self::Rectangle(rectangle) => rectangle.set_touching(),
            _ => {}
        }
    }

    /// The smooth shape, if it is one, or the mesh that is treated like one.
    #[inline]
    pub(crate) fn solid(&self) -> Option<&dyn Solid> {
        match self {
            Self::Mesh(mesh) if mesh.touches => Some(mesh),
            Self::Rectangle(rectangle) if rectangle.mesh().touches => Some(rectangle.mesh()),
            Self::Disk(disk) => Some(disk),
            Self::Sphere(sphere) => Some(sphere),
            Self::Cylinder(cylinder) => Some(cylinder),
            Self::Mesh(_) | Self::Rectangle(_) => None,
        }
    }

    /// The smallest box around it.
    pub fn bounds(&self) -> Bounds {
        match (self.mesh(), self.solid()) {
            (Some(mesh), _) => mesh.bounds(),
            (None, Some(solid)) => {
                // A box of rounded corners must still hold the shape.
                let [min, max] = solid.bounds();
                let slack = 1e-6 * min.abs().max(max.abs());
                Bounds {
                    min: (min - slack).as_vec3(),
                    max: (max + slack).as_vec3(),
                }
            }
            (None, None) => Bounds::EMPTY,
        }
    }

    /// A cone that holds its normals, outside.
    pub(crate) fn normals(&self) -> DirectionCone {
        match self {
            Self::Mesh(mesh) => mesh.cone_of_normals(),
            Self::Rectangle(rectangle) => DirectionCone::along(rectangle.normal().as_dvec3()),
            Self::Disk(disk) => DirectionCone::along(disk.normal()),
            Self::Sphere(_) | Self::Cylinder(_) => DirectionCone::ALL,
        }
    }

    /// Makes now what sampling would make when first asked.
    pub(crate) fn prepare_sampling(&self) {
        if let Self::Mesh(mesh) = self {
            mesh.by_area();
        }
    }

    /// Surface area (m²).
    pub fn area(&self) -> f64 {
        match self {
            Self::Mesh(mesh) => mesh.area(),
            Self::Rectangle(rectangle) => rectangle.area(),
            Self::Disk(disk) => disk.area(),
            Self::Sphere(sphere) => sphere.area(),
            Self::Cylinder(cylinder) => cylinder.area(),
        }
    }

    /// A point chosen uniformly by area, with its density per unit area. A mesh without area
    /// gives the origin, with density 0. Whose point it is, the caller knows.
    pub(crate) fn sample_area(&self, u: Vec2) -> SampledPoint {
        let smooth = |surface: Surface| surface.point(0, surface.uv);
        let point = match self {
            Self::Mesh(mesh) => {
                let Some(by_area) = mesh.by_area() else {
                    return SampledPoint {
                        point: smooth(Surface::exact(
                            DVec3::ZERO,
                            DVec3::Z,
                            Vec2::ZERO,
                            DVec3::X,
                            DVec3::Y,
                        )),
                        density: 0.0,
                    };
                };
                let choice = by_area.sample_fine(u);
                let parameters = square_to_triangle(Vec2::new(choice.rest, u.y));
                let primitive = choice.index as u32;
                mesh.surface(primitive, parameters)
                    .point(primitive, parameters)
            }
            Self::Rectangle(rectangle) => rectangle.at(u),
            Self::Disk(disk) => smooth(disk.sample_area(u)),
            Self::Sphere(sphere) => smooth(sphere.sample_area(u)),
            Self::Cylinder(cylinder) => smooth(cylinder.sample_area(u)),
        };
        SampledPoint {
            point,
            density: (1.0 / self.area()) as f32,
        }
    }

    /// A point chosen for a receiver, with its density per unit solid angle there. `None` if the
    /// chosen point is seen edge-on or the shape has no area.
    #[inline]
    pub(crate) fn sample_toward(&self, from: &Receiver, u: Vec2) -> Option<SampledPoint> {
        let sampled = match self {
            Self::Rectangle(rectangle) => rectangle.sample_toward(from, u),
            Self::Sphere(sphere) => {
                let (surface, density) = sphere.sample_toward(from.position, u);
                SampledPoint {
                    point: surface.point(0, surface.uv),
                    density,
                }
            }
            Self::Mesh(mesh) => {
                let choice = mesh.by_area()?.sample_fine(u);
                let primitive = choice.index as u32;
                let u = Vec2::new(choice.rest, u.y);
                let seen = seen_triangle(mesh, primitive, from.position);
                let parameters = match &seen {
                    Some(seen) => seen.barycentric(seen.sample(u)),
                    None => square_to_triangle(u),
                };
                let point = mesh
                    .surface(primitive, parameters)
                    .point(primitive, parameters);
                SampledPoint {
                    point,
                    density: match seen {
                        Some(seen) => choice.probability * seen.density(),
                        None => self.area_density_toward(from.position, &point),
                    },
                }
            }
            Self::Disk(_) | Self::Cylinder(_) => {
                let SampledPoint { point, .. } = self.sample_area(u);
                SampledPoint {
                    point,
                    density: self.area_density_toward(from.position, &point),
                }
            }
        };
        (sampled.density > 0.0 && sampled.density < f32::INFINITY).then_some(sampled)
    }

    /// The density per unit solid angle with which [`Shape::sample_toward`] from `from` chooses
    /// `at`, a point of this shape.
    pub(crate) fn density_toward(&self, from: &Receiver, at: &SurfacePoint) -> f32 {
        let density = match self {
            Self::Rectangle(rectangle) => rectangle.density_toward(from, at),
            Self::Sphere(sphere) => sphere.density_toward(from.position, at.position, at.normal),
            Self::Mesh(mesh) => {
                let primitive = at.texture.primitive;
                match (
                    mesh.by_area(),
                    seen_triangle(mesh, primitive, from.position),
                ) {
                    (Some(by_area), Some(seen)) => {
                        by_area.probability(primitive as usize) * seen.density()
                    }
                    _ => self.area_density_toward(from.position, at),
                }
            }
            Self::Disk(_) | Self::Cylinder(_) => self.area_density_toward(from.position, at),
        };
        if density.is_finite() { density } else { 0.0 }
    }

    fn area_density_toward(&self, from: Vec3, at: &SurfacePoint) -> f32 {
        area_density_toward(self.area(), from, at.position, at.normal)
    }
}

fn seen_triangle(mesh: &Mesh, primitive: u32, from: Vec3) -> Option<SphericalTriangle> {
    // Single precision would round the edges of a triangle that is small and far.
    let seen = |p: Vec3| p.as_dvec3() - from.as_dvec3();
    SphericalTriangle::new(mesh.corners(primitive).map(seen))
}

/// Uniform density by area as seen from a point: r² / (A |cos θ|), infinite edge-on.
pub(crate) fn area_density_toward(area: f64, from: Vec3, position: Vec3, normal: Vec3) -> f32 {
    let to = position - from;
    let distance_squared = to.length_squared();
    let cos_times_distance = normal.dot(to).abs();
    distance_squared * distance_squared.sqrt() / (area as f32 * cos_times_distance)
}
