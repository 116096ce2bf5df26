//! The contract of shapes as lights use them.

use crate::lanes::{LanePoint, LaneReceiver};
use crate::{LightSampleContext, ShapeId, SurfaceInteraction, TexturePoint};
use etalon_math::lane::Lane;
use etalon_math::{DirectionCone, offset_origin};
use glam::{Vec2, Vec3};

/// A point of a shape: as much of a [`SurfaceInteraction`] as light that starts or ends there needs.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// Position (m, world).
    pub position: Vec3,
    /// Bound on the absolute error of each coordinate of `position`.
    pub error: Vec3,
    /// Unit geometric normal, on the side that the shape calls outside.
    pub normal: Vec3,
    /// The point for texture look-up.
    pub texture: TexturePoint,
}

impl SurfacePoint {
    /// The origin of a ray that leaves the point along `direction`.
    #[inline]
    pub fn origin_along(&self, direction: Vec3) -> Vec3 {
        offset_origin(self.position, self.error, self.normal, direction)
    }

    /// The origin of a ray that leaves the point toward `target`.
    #[inline]
    pub fn origin_toward(&self, target: Vec3) -> Vec3 {
        self.origin_along(target - self.position)
    }
}

impl From<&SurfaceInteraction> for SurfacePoint {
    #[inline]
    fn from(vertex: &SurfaceInteraction) -> Self {
        Self {
            position: vertex.position,
            error: vertex.error,
            normal: vertex.normal,
            texture: TexturePoint::from(vertex),
        }
    }
}

/// A sampled point of a shape.
#[derive(Clone, Copy, Debug)]
pub struct SampledPoint {
    /// The point.
    pub point: SurfacePoint,
    /// Its density: per unit area (m⁻²) from [`Shapes::sample_area`], per unit solid angle
    /// (sr⁻¹) at the receiver from [`Shapes::sample_toward`].
    pub density: f32,
}

/// Lookup of shapes that are lights.
pub trait Shapes {
    /// Surface area (m²) at the moment `time` of the shutter interval.
    fn area(&self, shape: ShapeId, time: f32) -> f32;

    /// The lower and upper corner of its bounding box over the shutter interval (m, world).
    fn bounds(&self, shape: ShapeId) -> [Vec3; 2];

    /// A cone that holds its normals, on the side that the shape calls outside.
    fn normals(&self, shape: ShapeId) -> DirectionCone;

    /// A point chosen uniformly by area, at the moment `time` of the shutter interval.
    fn sample_area(&self, shape: ShapeId, u: Vec2, time: f32) -> SampledPoint;

    /// A point chosen for the light that the shape sends to `from`, by the shape's best method; the
    /// density is per solid angle. `None` if the method finds no visible point. Both sides of a surface
    /// count as visible.
    fn sample_toward(
        &self,
        shape: ShapeId,
        from: &LightSampleContext,
        u: Vec2,
    ) -> Option<SampledPoint>;

    /// Whether points of both shapes can be chosen in lanes together; of a shape and itself, whether in lanes at all.
    fn are_alike(&self, shapes: [ShapeId; 2]) -> bool;

    /// Points of `shape(i)` in lane i, which are all alike, each chosen for a receiver.
    fn points_toward<F: Lane>(
        &self,
        shape: impl Fn(usize) -> ShapeId,
        from: &LaneReceiver<F>,
        u: [F; 2],
    ) -> LanePoint<F>;

    /// The density (sr⁻¹) with which [`Shapes::sample_toward`] from `from` chooses `at`.
    fn density_toward(&self, shape: ShapeId, from: &LightSampleContext, at: &SurfacePoint) -> f32;

    /// The value of a mesh attribute at a point of a primitive (three channels; one-channel
    /// attributes are repeated). Each stored number counts as the nearest in `range`, before
    /// they are interpolated. `None` if the shape has no such attribute.
    fn attribute(
        &self,
        shape: ShapeId,
        name: &str,
        primitive: u32,
        parameters: Vec2,
        range: [f32; 2],
    ) -> Option<Vec3>;
}
