//! What others may ask of shapes.

use crate::{ShapeId, Vertex};
use glam::{Vec2, Vec3};

/// A sampled point of a shape.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// The point with its differential geometry (`t` and `time` zero; `material` and `light`
    /// filled in by the scene).
    pub vertex: Vertex,
    /// Its density: per unit area (m⁻²) from [`Shapes::sample_area`], per unit solid angle
    /// (sr⁻¹) at the observer from [`Shapes::sample_toward`].
    pub density: f32,
}

/// Lookup of shapes that are not reached through instances.
pub trait Shapes {
    /// Surface area (m²).
    fn area(&self, shape: ShapeId) -> f32;

    /// A point chosen uniformly by area.
    fn sample_area(&self, shape: ShapeId, u: Vec2) -> SurfacePoint;

    /// A point of the shape chosen for an observer at `from`, by solid angle where a good method
    /// exists, by area otherwise (the density is per solid angle in any case). `None` if the
    /// method finds nothing to see. Both sides of a surface count as visible.
    fn sample_toward(&self, shape: ShapeId, from: Vec3, u: Vec2) -> Option<SurfacePoint>;

    /// The density (sr⁻¹) with which [`Shapes::sample_toward`] from `from` chooses `vertex`.
    fn density_toward(&self, shape: ShapeId, from: Vec3, vertex: &Vertex) -> f32;

    /// The value of a mesh attribute at a point of a primitive (three channels; one-channel
    /// attributes are repeated). `None` if the shape has no such attribute.
    fn attribute(
        &self,
        shape: ShapeId,
        name: &str,
        primitive: u32,
        parameters: Vec2,
    ) -> Option<Vec3>;
}
