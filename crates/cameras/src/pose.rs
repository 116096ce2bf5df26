//! Where a camera stands: the map from camera space to the world, in the form that rays and
//! connections need.

use etalon_params::{DMat4, Params};
use glam::{DMat3, Mat3, Vec3};

/// How far MᵀM may be from the identity for a camera that refuses scale (Mitsuba's bound, so
/// that matrices written with few digits are accepted). What remains is honoured exactly.
const RIGID_TOLERANCE: f64 = 1e-3;

/// An affine map from camera space to the world.
///
/// World points are taken relative to the camera's position before anything else, so that a
/// camera far from the origin loses as little as possible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The camera's position (m, world).
    pub position: Vec3,
    /// The images of the camera's axes.
    pub axes: Mat3,
    inverse: Mat3,
    /// |det| of the linear part: the volume of the unit cube's image.
    pub volume: f32,
}

impl Pose {
    /// The pose of an affine, invertible matrix; `None` for any other.
    pub fn new(to_world: &DMat4) -> Option<Self> {
        let linear = DMat3::from_mat4(*to_world);
        let inverse = linear.inverse();
        let affine = to_world.row(3).to_array() == [0.0, 0.0, 0.0, 1.0];
        let volume = linear.determinant().abs();
        (affine && to_world.is_finite() && inverse.is_finite() && volume > 0.0).then(|| Self {
            position: to_world.w_axis.truncate().as_vec3(),
            axes: linear.as_mat3(),
            inverse: inverse.as_mat3(),
            volume: volume as f32,
        })
    }

    /// Reads `to_world`. With `rigid`, scale and shear are refused (a reflection is not).
    pub fn from_params(params: &Params<'_>, rigid: bool) -> Option<Self> {
        let matrix = params.transform("to_world");
        let Some(pose) = Self::new(&matrix) else {
            params.error_at(
                "to_world",
                format!(
                    "the camera-to-world transform of `{}` cannot be inverted",
                    params.node.plugin.value
                ),
            );
            return None;
        };
        let linear = DMat3::from_mat4(matrix);
        let deviation = linear.transpose() * linear - DMat3::IDENTITY;
        let scaled = deviation
            .to_cols_array()
            .iter()
            .any(|x| x.abs() > RIGID_TOLERANCE);
        if rigid && scaled {
            params.error_at(
                "to_world",
                format!(
                    "the camera-to-world transform of `{}` must not contain scale or shear",
                    params.node.plugin.value
                ),
            );
            return None;
        }
        Some(pose)
    }

    /// The world image of a camera-space vector.
    #[inline]
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.axes * v
    }

    /// The camera-space coordinates of a world point.
    #[inline]
    pub fn to_camera(&self, point: Vec3) -> Vec3 {
        self.inverse * (point - self.position)
    }
}
