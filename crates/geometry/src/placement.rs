//! Where a shape stands: an invertible affine map in double precision.
//!
//! Transforms between a shape's own space and the world are applied in double precision and
//! rounded once, so that a ray taken into an instance and a point taken out of it agree to within
//! one rounding of single precision.

use etalon_math::{FromAffine, gamma};
use etalon_params::{DMat4, Params};
use glam::{DAffine3, DMat3, DVec3, Vec3};

/// An invertible affine map from a shape's own space to the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    forward: DAffine3,
    inverse: DAffine3,
}

impl Placement {
    /// The shape stands where it was made.
    pub const IDENTITY: Self = Self {
        forward: DAffine3::IDENTITY,
        inverse: DAffine3::IDENTITY,
    };

    /// The map of a 4×4 matrix whose last row is (0, 0, 0, 1). `None` if the matrix is
    /// projective, singular or not finite.
    pub fn from_matrix(matrix: &DMat4) -> Option<Self> {
        let affine = matrix.row(3) == glam::DVec4::W;
        if !affine || !matrix.is_finite() {
            return None;
        }
        let placement = Self::from_affine(&DAffine3::from_mat4(*matrix));
        let invertible = placement.linear().determinant() != 0.0;
        (invertible && placement.inverse.is_finite()).then_some(placement)
    }

    /// Reads the parameter `to_world` (default: the identity). An animated shape stays in its own space, as an
    /// instance moves it. `None` after a mistake, which has been recorded.
    pub fn from_params(params: &Params<'_>) -> Option<Self> {
        if params.is_animated("to_world") {
            return Some(Self::IDENTITY);
        }
        let placement = Self::from_matrix(&params.transform("to_world"));
        if placement.is_none() {
            params.cannot_be_undone("to_world");
        }
        placement
    }

    /// This map after `first`.
    pub fn after(&self, first: &Self) -> Self {
        Self {
            forward: self.forward * first.forward,
            inverse: first.inverse * self.inverse,
        }
    }

    /// The image in the world of a point of the shape's space.
    #[inline]
    pub fn point(&self, p: DVec3) -> DVec3 {
        self.forward.transform_point3(p)
    }

    /// The image in the world of a vector of the shape's space.
    #[inline]
    pub fn vector(&self, v: DVec3) -> DVec3 {
        self.forward.transform_vector3(v)
    }

    /// The image in the world of a normal of the shape's space (a covector; not normalised).
    #[inline]
    pub fn normal(&self, n: DVec3) -> DVec3 {
        let m = &self.inverse.matrix3;
        DVec3::new(n.dot(m.x_axis), n.dot(m.y_axis), n.dot(m.z_axis))
    }

    /// The unit normal in the world of one in the shape's space.
    #[inline]
    pub(crate) fn unit_normal(&self, n: Vec3) -> Vec3 {
        self.normal(n.as_dvec3()).normalize().as_vec3()
    }

    /// A point of the shape in the world, and the bound on the error of each of its coordinates: the point's own
    /// box, mapped; the rounding of the position in the world; and, since the next ray is taken back into the
    /// shape's space, the rounding of its origin there.
    #[inline]
    pub(crate) fn rounded_point(&self, point: Vec3, error: Vec3) -> (Vec3, Vec3) {
        let m = self.linear();
        let position = self.point(point.as_dvec3()).as_vec3();
        let local = (error + point.abs() * gamma(1)).as_dvec3();
        let spread = m.x_axis.abs() * local.x + m.y_axis.abs() * local.y + m.z_axis.abs() * local.z;
        let error = spread.as_vec3() * (1.0 + gamma(4)) + position.abs() * gamma(2);
        (position, error + f32::MIN_POSITIVE)
    }

    /// The point of the shape's space whose image is the world's `p`.
    #[inline]
    pub fn local_point(&self, p: DVec3) -> DVec3 {
        self.inverse.transform_point3(p)
    }

    /// A ray's origin and direction in the shape's space. The direction is not normalised, so that
    /// t means the same there.
    #[inline]
    pub(crate) fn local_ray(&self, origin: Vec3, direction: Vec3) -> (Vec3, Vec3) {
        (
            self.local_point(origin.as_dvec3()).as_vec3(),
            self.local_vector(direction.as_dvec3()).as_vec3(),
        )
    }

    /// The vector of the shape's space whose image is the world's `v`.
    #[inline]
    pub fn local_vector(&self, v: DVec3) -> DVec3 {
        self.inverse.transform_vector3(v)
    }

    /// A box around the image of a box; everything, if the box has no end.
    pub(crate) fn bounds(&self, [min, max]: [DVec3; 2]) -> [DVec3; 2] {
        if min.cmple(max).all() && !(max - min).is_finite() {
            return [DVec3::NEG_INFINITY, DVec3::INFINITY];
        }
        let half = (max - min) * 0.5;
        let m = self.linear();
        let reach = m.x_axis.abs() * half.x + m.y_axis.abs() * half.y + m.z_axis.abs() * half.z;
        let center = self.point((min + max) * 0.5);
        [center - reach, center + reach]
    }

    /// The linear part.
    #[inline]
    pub fn linear(&self) -> &DMat3 {
        &self.forward.matrix3
    }

    /// Whether the map turns left hands into right hands.
    #[inline]
    pub fn mirrors(&self) -> bool {
        self.forward.matrix3.determinant() < 0.0
    }
}

impl FromAffine for Placement {
    fn from_affine(map: &DAffine3) -> Self {
        Self {
            forward: *map,
            inverse: map.inverse(),
        }
    }
}

/// The largest relative deviation from equal lengths and right angles that still counts as a
/// similarity: what single-precision matrices in scene files leave.
pub(crate) const SIMILARITY_TOLERANCE: f64 = 1e-4;

/// Whether vectors are perpendicular and, if `equal`, of equal length, within
/// [`SIMILARITY_TOLERANCE`].
pub(crate) fn perpendicular(a: DVec3, b: DVec3, equal: bool) -> bool {
    let (la, lb) = (a.length(), b.length());
    a.dot(b).abs() <= SIMILARITY_TOLERANCE * la * lb
        && (!equal || (la - lb).abs() <= SIMILARITY_TOLERANCE * la.max(lb))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_what_cannot_be_undone() {
        let mut projective = DMat4::IDENTITY;
        projective.z_axis.w = 1.0;
        assert_eq!(Placement::from_matrix(&projective), None);
        let flat = DMat4::from_scale(DVec3::new(1.0, 0.0, 1.0));
        assert_eq!(Placement::from_matrix(&flat), None);
        assert_eq!(Placement::from_matrix(&(DMat4::IDENTITY * f64::NAN)), None);
    }

    #[test]
    fn there_and_back() {
        let matrix = DMat4::from_translation(DVec3::new(1e4, -2.0, 3.0))
            * DMat4::from_rotation_y(0.7)
            * DMat4::from_scale(DVec3::new(2.0, -1.0, 0.5));
        let placement = Placement::from_matrix(&matrix).expect("invertible");
        let p = DVec3::new(0.3, -0.7, 0.9);
        assert!((placement.local_point(placement.point(p)) - p).length() < 1e-11);
        assert!(placement.mirrors());
        let (a, b) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(-1.0, 0.5, 2.0));
        let n = placement.normal(a.cross(b));
        assert!(n.dot(placement.vector(a)).abs() < 1e-12);
    }
}
