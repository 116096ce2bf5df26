//! Vertices of paths: points of surfaces, and scattering points in media.

use crate::{InstanceId, Leaving, LeftSurface, LightId, MaterialId, MediumInterface, Ray, ShapeId};
use etalon_math::{Frame, offset_origin};
use glam::{Vec2, Vec3};

/// The result of intersection, from which the vertex is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray (m).
    pub t: f32,
    /// Parameters of the point on its primitive: barycentric coordinates (b₁, b₂) of a
    /// triangle's second and third corner, or what the shape defines.
    pub parameters: Vec2,
    /// The shape that was hit.
    pub shape: ShapeId,
    /// The primitive within the shape (a triangle's index; 0 for a single-piece shape).
    pub primitive: u32,
    /// The instance through which the shape was reached.
    pub instance: InstanceId,
    /// Index of the primitive in the accelerator's own storage; meaningful to it only.
    pub slot: u32,
}

/// A point of a surface with its differential geometry.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceInteraction {
    /// Position (m, world).
    pub position: Vec3,
    /// Bound on the absolute error of each coordinate of `position`.
    pub error: Vec3,
    /// How far along `normal` from `position` the surface is (m), to about 10⁻¹³ of the
    /// coordinates; NaN if that is not known.
    pub depth: f32,
    /// Unit geometric normal, on the side that the shape calls outside.
    pub normal: Vec3,
    /// Shading frame: `n` the interpolated normal (flipped with the shape), `s` along ∂p/∂u.
    pub shading: Frame,
    /// Texture coordinates.
    pub uv: Vec2,
    /// ∂p/∂u.
    pub dp_du: Vec3,
    /// ∂p/∂v.
    pub dp_dv: Vec3,
    /// Distance from the ray's origin (m).
    pub t: f32,
    /// The ray's time.
    pub time: f32,
    /// Parameters on the primitive, as in [`Hit`].
    pub parameters: Vec2,
    /// The shape.
    pub shape: ShapeId,
    /// The primitive within the shape.
    pub primitive: u32,
    /// The instance through which the shape was reached.
    pub instance: InstanceId,
    /// The material.
    pub material: MaterialId,
    /// The light this surface is, or [`LightId::NONE`].
    pub light: LightId,
    /// The media on both sides.
    pub media: MediumInterface,
}

impl SurfaceInteraction {
    /// A point of a medium as a vertex: it has no normal and no shape, and the ray's medium on all sides.
    #[inline]
    pub fn in_space(ray: &Ray, t: f32) -> Self {
        let none = Frame {
            s: Vec3::ZERO,
            t: Vec3::ZERO,
            n: Vec3::ZERO,
        };
        Self {
            position: ray.at(t),
            error: Vec3::ZERO,
            depth: f32::NAN,
            normal: Vec3::ZERO,
            shading: none,
            uv: Vec2::ZERO,
            dp_du: Vec3::ZERO,
            dp_dv: Vec3::ZERO,
            t,
            time: ray.time,
            parameters: Vec2::ZERO,
            shape: ShapeId::NONE,
            primitive: 0,
            instance: InstanceId::NONE,
            material: MaterialId::NONE,
            light: LightId::NONE,
            media: MediumInterface::within(ray.medium),
        }
    }

    /// |cos θ| between the surface's normal and the unit vector `direction`; 1 at a point of a medium.
    #[inline]
    pub fn area_cos(&self, direction: Vec3) -> f32 {
        if self.normal == Vec3::ZERO {
            1.0
        } else {
            self.normal.dot(direction).abs()
        }
    }

    /// The point as rays leave it.
    #[inline]
    fn leaving(&self) -> Leaving<f32> {
        Leaving {
            position: self.position,
            error: self.error,
            depth: self.depth,
            normal: self.normal,
        }
    }

    /// What a ray takes along that leaves it.
    #[inline]
    pub(crate) fn left(&self) -> LeftSurface {
        LeftSurface {
            shape: self.shape,
            primitive: self.primitive,
            time: self.time,
            media: self.media,
        }
    }

    /// A half-line that leaves this surface.
    #[inline]
    pub fn spawn(&self, direction: Vec3) -> Ray {
        self.leaving().spawn(direction).lanes()(0, self.left())
    }

    /// The remainder of `segment` beyond this surface, which it crosses here; `None` if it ends here.
    #[inline]
    pub fn rest_of(&self, segment: &Ray) -> Option<Ray> {
        let next = self.spawn(segment.direction);
        let t_max = segment.t_max - (next.origin - segment.origin).dot(segment.direction);
        (t_max > 0.0).then_some(Ray { t_max, ..next })
    }

    /// The origin of a ray that leaves this surface toward `target`.
    #[inline]
    pub fn origin_toward(&self, target: Vec3) -> Vec3 {
        offset_origin(
            self.position,
            self.error,
            self.normal,
            target - self.position,
        )
    }

    /// The shadow ray toward a light's `target`, or toward infinity in `direction` if it is `None`.
    /// `None` if the target is closer than rounding resolves.
    #[inline]
    pub fn shadow_ray(&self, direction: Vec3, target: Option<Vec3>) -> Option<Ray> {
        let Some(target) = target else {
            return Some(self.spawn(direction));
        };
        let (rays, exists) = self.leaving().toward(target);
        exists.then(|| rays.lanes()(0, self.left()))
    }
}
