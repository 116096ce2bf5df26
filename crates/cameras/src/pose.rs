//! Where a camera stands: the map from camera space to the world, in the form that rays and
//! connections need.

use etalon_math::lane::{Lane, Vector};
use etalon_math::{Animated, FromAffine};
use etalon_params::{DMat4, Params};
use etalon_transport::Shutter;
use glam::{DAffine3, DMat3, Mat3, Vec3};

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
        let affine = to_world.row(3).to_array() == [0.0, 0.0, 0.0, 1.0];
        let invertible = linear.inverse().is_finite() && linear.determinant() != 0.0;
        (affine && to_world.is_finite() && invertible)
            .then(|| Self::from_affine(&DAffine3::from_mat4(*to_world)))
    }

    /// Reads `to_world`. With `rigid`, scale and shear are refused (a reflection is not).
    pub fn from_params(
        params: &Params<'_>,
        rigid: bool,
        shutter: &Shutter,
    ) -> Option<Animated<Self>> {
        let keys = params.keyframes("to_world");
        if keys.iter().any(|matrix| Self::new(matrix).is_none()) {
            params.error_at(
                "to_world",
                format!(
                    "the camera-to-world transform of `{}` cannot be inverted",
                    params.node.plugin.value
                ),
            );
            return None;
        }
        let scaled = keys.iter().any(|matrix| {
            let linear = DMat3::from_mat4(*matrix);
            let deviation = linear.transpose() * linear - DMat3::IDENTITY;
            let off = |x: &f64| x.abs() > RIGID_TOLERANCE;
            deviation.to_cols_array().iter().any(off)
        });
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
        if let [still] = keys.as_slice() {
            return Self::new(still).map(Animated::from);
        }
        Some(Animated::new(shutter.motion(params, "to_world")?))
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

/// Poses in lanes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LanePose<F: Lane> {
    /// Positions (m, world).
    pub(crate) position: F::Vector,
    axes: [F::Vector; 3],
}

impl<F: Lane> LanePose<F> {
    /// Where a camera stands at these moments.
    #[inline(always)]
    pub(crate) fn at(pose: &Animated<Pose>, time: F) -> Self {
        if pose.motion().is_none() {
            let still = pose.start();
            let Mat3 {
                x_axis,
                y_axis,
                z_axis,
            } = still.axes;
            return Self {
                position: F::Vector::broadcast(still.position),
                axes: [x_axis, y_axis, z_axis].map(F::Vector::broadcast),
            };
        }
        let poses = F::array(|i| pose.at(time.lane(i), |pose| *pose));
        let pose = |i: usize| &poses.as_ref()[i];
        Self {
            position: F::Vector::of_lanes(|i| pose(i).position),
            axes: [0, 1, 2].map(|axis| F::Vector::of_lanes(|i| pose(i).axes.col(axis))),
        }
    }

    /// [`Pose::vector`].
    #[inline(always)]
    pub(crate) fn vector(&self, [x, y, z]: [F; 3]) -> F::Vector {
        let [a, b, c] = self.axes;
        a * x + b * y + c * z
    }
}

impl FromAffine for Pose {
    fn from_affine(map: &DAffine3) -> Self {
        Self {
            position: map.translation.as_vec3(),
            axes: map.matrix3.as_mat3(),
            inverse: map.matrix3.inverse().as_mat3(),
            volume: map.matrix3.determinant().abs() as f32,
        }
    }
}
