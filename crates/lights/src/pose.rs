//! `to_world` of lights that have a direction: a position and an orientation.

use etalon_math::Transform;
use etalon_params::Params;
use glam::Vec3;

/// A rotation, perhaps with a reflection, and a position. Scale has no meaning for a light
/// without extent, and is left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Where the light's origin is (m).
    pub position: Vec3,
    transform: Transform,
}

impl Pose {
    /// Reads `to_world`, refusing what would change angles.
    pub fn from_params(params: &Params<'_>) -> Option<Self> {
        let matrix = params.transform("to_world");
        let transform = Transform::from_matrix(&matrix);
        let Some(transform) = transform.filter(|t| t.uniform_scale().is_some()) else {
            params.error_at(
                "to_world",
                format!(
                    "`to_world` of `{}` may rotate, mirror, move and scale uniformly, nothing else",
                    params.node.plugin.value
                ),
            );
            return None;
        };
        Some(Self {
            position: transform.point(Vec3::ZERO),
            transform,
        })
    }

    /// The world direction (unit) of a direction in the light's space.
    #[inline]
    pub fn to_world(&self, direction: Vec3) -> Vec3 {
        self.transform.vector(direction).normalize()
    }

    /// The direction (unit) in the light's space of a world direction.
    #[inline]
    pub fn to_local(&self, direction: Vec3) -> Vec3 {
        self.transform.inverse().vector(direction).normalize()
    }
}
