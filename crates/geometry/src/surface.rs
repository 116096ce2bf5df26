//! The differential geometry of a surface point, before it is known whose point it is.

use crate::Placement;
use etalon_math::{Frame, gamma};
use etalon_transport::{InstanceId, LightId, MaterialId, ShapeId, Vertex};
use glam::{DVec3, Vec2, Vec3};

/// A point of a surface, in the space of its shape or of the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    /// Position (m).
    pub(crate) position: Vec3,
    /// Bound on the absolute error of each coordinate of `position`.
    pub(crate) error: Vec3,
    /// Unit geometric normal, outside.
    pub(crate) normal: Vec3,
    /// Unit shading normal.
    pub(crate) shading_normal: Vec3,
    /// Texture coordinates.
    pub(crate) uv: Vec2,
    /// ∂p/∂u.
    pub(crate) dp_du: Vec3,
    /// ∂p/∂v.
    pub(crate) dp_dv: Vec3,
}

impl Surface {
    /// The smooth point `p`, computed in double precision: all error is that of rounding it,
    /// doubled because the next ray's intersection rounds as well.
    pub(crate) fn exact(p: DVec3, normal: DVec3, uv: Vec2, dp_du: DVec3, dp_dv: DVec3) -> Self {
        let position = p.as_vec3();
        let normal = normal.as_vec3();
        Self {
            position,
            error: position.abs() * gamma(2) + f32::MIN_POSITIVE,
            normal,
            shading_normal: normal,
            uv,
            dp_du: dp_du.as_vec3(),
            dp_dv: dp_dv.as_vec3(),
        }
    }

    /// The same point where `placement` puts it.
    ///
    /// Error: the point's own box, mapped; the rounding of the position in the world; and, since
    /// the next ray is taken back into the shape's space, the rounding of its origin there.
    pub(crate) fn placed(&self, placement: &Placement) -> Self {
        let m = placement.linear();
        let position = placement.point(self.position.as_dvec3()).as_vec3();
        let local = (self.error + self.position.abs() * gamma(1)).as_dvec3();
        let spread = m.x_axis.abs() * local.x + m.y_axis.abs() * local.y + m.z_axis.abs() * local.z;
        let unit = |n: Vec3| placement.normal(n.as_dvec3()).normalize().as_vec3();
        Self {
            position,
            error: spread.as_vec3() * (1.0 + gamma(4))
                + position.abs() * gamma(2)
                + f32::MIN_POSITIVE,
            normal: unit(self.normal),
            shading_normal: unit(self.shading_normal),
            uv: self.uv,
            dp_du: placement.vector(self.dp_du.as_dvec3()).as_vec3(),
            dp_dv: placement.vector(self.dp_dv.as_dvec3()).as_vec3(),
        }
    }

    /// The same point on the other side: the normals turn, the parametrisation stays.
    pub(crate) fn flipped_if(mut self, flip: bool) -> Self {
        if flip {
            self.normal = -self.normal;
            self.shading_normal = -self.shading_normal;
        }
        self
    }

    /// The vertex at this point. Its shading frame's first tangent is as near to ∂p/∂u as the
    /// shading normal lets it be.
    #[inline(always)] // Lights that are sampled need little of a vertex; see `Frame`.
    pub(crate) fn vertex(&self, owner: &Owner, primitive: u32, parameters: Vec2) -> Vertex {
        Vertex {
            position: self.position,
            error: self.error,
            normal: self.normal,
            shading: Frame::from_normal_and_tangent(self.shading_normal, self.dp_du),
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
