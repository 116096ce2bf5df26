//! Affine transforms with their inverses.
//!
//! Composed in double precision while a scene is read, applied in single precision while it is
//! rendered.

use crate::FromAffine;
use crate::lane::{Lane, Vector};
use glam::{Affine3A, DAffine3, DMat4, Vec3, Vec3A};

/// An invertible affine map of space, with its inverse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    forward: Affine3A,
    inverse: Affine3A,
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Transform {
    /// The transform that changes nothing.
    pub const IDENTITY: Self = Self {
        forward: Affine3A::IDENTITY,
        inverse: Affine3A::IDENTITY,
    };

    /// The transform of a 4×4 matrix whose last row is (0, 0, 0, 1). `None` if the matrix is
    /// projective, singular or not finite.
    pub fn from_matrix(matrix: &DMat4) -> Option<Self> {
        let last = matrix.row(3);
        let inverse = matrix.inverse();
        if last.truncate() != glam::DVec3::ZERO
            || last.w != 1.0
            || !matrix.is_finite()
            || !inverse.is_finite()
            || matrix.determinant() == 0.0
        {
            return None;
        }
        Some(Self {
            forward: Affine3A::from_mat4(matrix.as_mat4()),
            inverse: Affine3A::from_mat4(inverse.as_mat4()),
        })
    }

    /// The inverse transform.
    #[inline]
    pub fn inverse(&self) -> Self {
        Self {
            forward: self.inverse,
            inverse: self.forward,
        }
    }

    /// `self` after `first`.
    pub fn after(&self, first: &Self) -> Self {
        Self {
            forward: self.forward * first.forward,
            inverse: first.inverse * self.inverse,
        }
    }

    /// The image of a point.
    #[inline]
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.forward.transform_point3(p)
    }

    /// The image of a vector (a difference of points).
    #[inline]
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.forward.transform_vector3(v)
    }

    /// The images of several vectors.
    #[inline(always)]
    pub fn vectors<F: Lane>(&self, v: F::Vector) -> F::Vector {
        let m = &self.forward.matrix3;
        let [x, y, z] = v.xyz();
        let axis = |axis: Vec3A| F::Vector::broadcast(axis.into());
        axis(m.x_axis) * x + axis(m.y_axis) * y + axis(m.z_axis) * z
    }

    /// The image of a normal (a covector; not normalised).
    #[inline]
    pub fn normal(&self, n: Vec3) -> Vec3 {
        let m = &self.inverse.matrix3;
        Vec3::new(
            n.dot(Vec3::from(m.x_axis)),
            n.dot(Vec3::from(m.y_axis)),
            n.dot(Vec3::from(m.z_axis)),
        )
    }

    /// The linear part's determinant; negative if the transform mirrors.
    pub fn determinant(&self) -> f32 {
        self.forward.matrix3.determinant()
    }

    /// The common factor by which all lengths are scaled, if there is one (within a relative
    /// 10⁻⁴), else `None`.
    pub fn uniform_scale(&self) -> Option<f32> {
        let m = &self.forward.matrix3;
        let (a, b, c) = (m.x_axis.length(), m.y_axis.length(), m.z_axis.length());
        let scale = (a + b + c) / 3.0;
        let close = |x: f32| (x - scale).abs() <= 1e-4 * scale;
        let orthogonal = |x: f32| x.abs() <= 1e-4 * scale * scale;
        (close(a)
            && close(b)
            && close(c)
            && orthogonal(m.x_axis.dot(m.y_axis))
            && orthogonal(m.y_axis.dot(m.z_axis))
            && orthogonal(m.z_axis.dot(m.x_axis)))
        .then_some(scale)
    }

    /// The forward map as `glam` stores it.
    #[inline]
    pub fn forward(&self) -> &Affine3A {
        &self.forward
    }
}

impl FromAffine for Transform {
    fn from_affine(map: &DAffine3) -> Self {
        Self {
            forward: map.as_affine3a(),
            inverse: map.inverse().as_affine3a(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;

    fn sheared() -> DMat4 {
        let mut m = DMat4::from_rotation_y(0.7) * DMat4::from_scale(DVec3::new(2.0, -1.0, 0.5));
        m.w_axis.x = 3.0;
        m.x_axis.z += 0.4;
        m
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::with_cases(256) })]
        #[test]
        fn inverse_undoes_and_normals_stay_perpendicular(
            x in -5.0f32..5.0, y in -5.0f32..5.0, z in -5.0f32..5.0,
            u in -5.0f32..5.0, v in -5.0f32..5.0, w in -5.0f32..5.0,
        ) {
            let t = Transform::from_matrix(&sheared()).expect("invertible");
            let p = Vec3::new(x, y, z);
            prop_assert!((t.inverse().point(t.point(p)) - p).length() < 1e-4);
            let a = Vec3::new(u, v, w);
            prop_assert!(t.vector(a).dot(t.normal(a.cross(p))).abs() < 1e-2);
        }
    }

    #[test]
    fn refuses_what_it_cannot_invert() {
        assert!(Transform::from_matrix(&DMat4::from_scale(DVec3::new(1.0, 0.0, 1.0))).is_none());
        assert!(Transform::from_matrix(&DMat4::perspective_rh_test()).is_none());
        assert!(Transform::from_matrix(&(DMat4::IDENTITY * f64::NAN)).is_none());
    }

    trait Projective {
        fn perspective_rh_test() -> DMat4;
    }
    impl Projective for DMat4 {
        fn perspective_rh_test() -> DMat4 {
            let mut m = DMat4::IDENTITY;
            m.z_axis.w = 1.0;
            m
        }
    }

    #[test]
    fn finds_uniform_scale() {
        let m = DMat4::from_rotation_x(1.0) * DMat4::from_scale(DVec3::splat(2.5));
        let scale = Transform::from_matrix(&m).and_then(|t| t.uniform_scale());
        assert!((scale.expect("uniform") - 2.5).abs() < 1e-5);
        let t = Transform::from_matrix(&sheared()).expect("invertible");
        assert_eq!(t.uniform_scale(), None);
    }
}
