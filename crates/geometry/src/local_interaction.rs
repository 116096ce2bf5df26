//! The differential geometry of a surface point, before it is known whose point it is.

use crate::Placement;
use etalon_math::{Frame, gamma};
use etalon_transport::{
    InstanceId, LightId, MaterialId, MediumInterface, ShadedPoint, ShapeId, SurfaceInteraction,
    SurfacePoint, TexturePoint,
};
use glam::{DVec3, Vec2, Vec3};

/// A point of a surface, in the space of its shape or of the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalInteraction {
    /// Position (m).
    pub(crate) position: Vec3,
    /// Bound on the absolute error of each coordinate of `position`.
    pub(crate) error: Vec3,
    /// Offset of the surface from `position` along `normal`; NaN if not known, see [`SurfaceInteraction`].
    pub(crate) depth: f32,
    /// Unit geometric normal, outside.
    pub(crate) normal: Vec3,
    /// Shading frame, its first tangent as near to ∂p/∂u as the shading normal lets it be.
    pub(crate) shading: Frame,
    /// Texture coordinates.
    pub(crate) uv: Vec2,
    /// ∂p/∂u.
    pub(crate) dp_du: Vec3,
    /// ∂p/∂v.
    pub(crate) dp_dv: Vec3,
    /// The face of the shape, for materials by face.
    pub(crate) face: u32,
}

impl LocalInteraction {
    /// The smooth point `p`, computed in double precision: all error is that of rounding it,
    /// doubled because the next ray's intersection rounds as well.
    #[inline(always)] // So that nothing is computed that the caller does not need.
    pub(crate) fn exact(p: DVec3, normal: DVec3, uv: Vec2, dp_du: DVec3, dp_dv: DVec3) -> Self {
        let position = p.as_vec3();
        let depth = (p - position.as_dvec3()).dot(normal) as f32;
        let normal = normal.as_vec3();
        let dp_du = dp_du.as_vec3();
        Self {
            position,
            error: position.abs() * gamma(2) + f32::MIN_POSITIVE,
            depth,
            normal,
            shading: Frame::from_normal_and_tangent(normal, dp_du),
            uv,
            dp_du,
            dp_dv: dp_dv.as_vec3(),
            face: 0,
        }
    }

    /// The same point where `placement` puts it.
    pub(crate) fn placed(&self, placement: &Placement) -> Self {
        let (position, error) = placement.rounded_point(self.position, self.error);
        let dp_du = placement.vector(self.dp_du.as_dvec3()).as_vec3();
        Self {
            position,
            error,
            // A ray is rounded on its way into the shape's space.
            depth: f32::NAN,
            normal: placement.unit_normal(self.normal),
            shading: Frame::from_normal_and_tangent(placement.unit_normal(self.shading.n), dp_du),
            uv: self.uv,
            dp_du,
            dp_dv: placement.vector(self.dp_dv.as_dvec3()).as_vec3(),
            face: self.face,
        }
    }

    /// [`LocalInteraction::placed`], skipped for the identity, without loss of precision.
    pub(crate) fn placed_if(self, placement: &Placement) -> Self {
        if *placement == Placement::IDENTITY {
            self
        } else {
            self.placed(placement)
        }
    }

    /// The same point on the other side: the normals turn, the parametrisation stays.
    #[inline(always)] // As above.
    pub(crate) fn flipped_if(mut self, flip: bool) -> Self {
        if flip {
            self.normal = -self.normal;
            self.depth = -self.depth;
            self.shading = self.shading.flipped();
        }
        self
    }

    /// As much of it as light needs, on a shape that is named later.
    #[inline(always)] // So that nothing else of the surface is computed.
    pub(crate) fn point(&self, primitive: u32, parameters: Vec2) -> SurfacePoint {
        SurfacePoint {
            position: self.position,
            error: self.error,
            normal: self.normal,
            texture: TexturePoint {
                position: self.position,
                uv: self.uv,
                shape: ShapeId::NONE,
                primitive,
                parameters,
            },
        }
    }

    /// The same of a shape in one piece.
    #[inline(always)] // As above.
    pub(crate) fn whole(&self) -> SurfacePoint {
        self.point(0, self.uv)
    }

    /// As much of it as paths need that are scattered together.
    #[inline(always)] // As above.
    pub(crate) fn shaded(&self, primitive: u32) -> ShadedPoint {
        ShadedPoint {
            position: self.position,
            error: self.error,
            depth: self.depth,
            normal: self.normal,
            shading: self.shading,
            primitive,
        }
    }

    /// The vertex at this point.
    #[inline]
    pub(crate) fn vertex(
        &self,
        owner: &Owner,
        primitive: u32,
        parameters: Vec2,
    ) -> SurfaceInteraction {
        SurfaceInteraction {
            position: self.position,
            error: self.error,
            depth: self.depth,
            normal: self.normal,
            shading: self.shading,
            uv: self.uv,
            dp_du: self.dp_du,
            dp_dv: self.dp_dv,
            t: 0.0,
            time: 0.0,
            parameters,
            shape: owner.shape,
            primitive,
            instance: owner.instance,
            material: owner.material,
            light: owner.light,
            media: MediumInterface::NONE,
        }
    }
}

/// Whose point it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Owner {
    pub(crate) shape: ShapeId,
    pub(crate) instance: InstanceId,
    pub(crate) material: MaterialId,
    pub(crate) light: LightId,
}
