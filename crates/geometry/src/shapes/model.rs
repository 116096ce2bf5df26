//! What a shape is asked, with the answers that most of them share.

use crate::local_interaction::LocalInteraction;
use crate::shapes::mesh::Mesh;
use crate::shapes::solid::Solid;
use etalon_math::DirectionCone;
use etalon_transport::{LightSampleContext, SampledPoint, SurfacePoint};
use glam::{Vec2, Vec3};

/// A shape: triangles ([`ShapeModel::mesh`]) or one smooth piece ([`ShapeModel::solid`]).
pub(crate) trait ShapeModel {
    /// Its triangles, if it is made of triangles.
    #[inline]
    fn mesh(&self) -> Option<&Mesh> {
        None
    }

    /// The same, to be changed.
    fn mesh_mut(&mut self) -> Option<&mut Mesh> {
        None
    }

    /// What intersects rays by a formula of its own: a smooth shape, or a mesh that nearly touches
    /// another shape.
    #[inline]
    fn solid(&self) -> Option<&dyn Solid> {
        let mesh = self.mesh()?;
        mesh.touches.then_some(mesh as &dyn Solid)
    }

    /// The surface at a point of a triangle, `b` being the barycentric coordinates of its second and
    /// third corner; `corners` gives its corners. `None` if it has no triangles.
    #[inline]
    fn triangle(
        &self,
        primitive: u32,
        b: Vec2,
        corners: impl FnOnce() -> [Vec3; 3],
    ) -> Option<LocalInteraction> {
        Some(self.mesh()?.surface_between(corners(), primitive, b))
    }

    /// A cone that holds its normals, outside.
    fn normals(&self) -> DirectionCone {
        DirectionCone::ALL
    }

    /// Makes now what sampling would make when first asked.
    fn prepare_sampling(&self) {}

    /// Surface area (m²).
    fn area(&self) -> f64;

    /// A point chosen uniformly by area; `None` if there is no area.
    fn sample_area(&self, u: Vec2) -> Option<SurfacePoint>;

    /// A point chosen for a receiver, with its density per unit solid angle there, which is not finite
    /// or 0 where it is seen edge-on.
    #[inline]
    fn sample_toward(&self, from: &LightSampleContext, u: Vec2) -> Option<SampledPoint> {
        let point = self.sample_area(u)?;
        let density = self.area_density_toward(from.position, &point);
        Some(SampledPoint { point, density })
    }

    /// The density of [`ShapeModel::sample_toward`] at a point of this shape.
    #[inline]
    fn density_toward(&self, from: &LightSampleContext, at: &SurfacePoint) -> f32 {
        self.area_density_toward(from.position, at)
    }

    /// The density per unit solid angle, seen from a point, of points chosen uniformly by area.
    #[inline]
    fn area_density_toward(&self, from: Vec3, at: &SurfacePoint) -> f32 {
        area_density_toward(self.area(), from, at.position, at.normal)
    }
}

/// Uniform density by area as seen from a point: r² / (A |cos θ|), infinite edge-on.
pub(crate) fn area_density_toward(area: f64, from: Vec3, position: Vec3, normal: Vec3) -> f32 {
    let to = position - from;
    let distance_squared = to.length_squared();
    let cos_times_distance = normal.dot(to).abs();
    distance_squared * distance_squared.sqrt() / (area as f32 * cos_times_distance)
}
