//! The directions in which a point sees a sphere: a cone, uniform by solid angle.
//!
//! With sin² θₘₐₓ = R²/d², m = 1 − cos θₘₐₓ = sin² θₘₐₓ / (1 + cos θₘₐₓ), which cancels nowhere. A
//! direction at 1 − cos θ = r² m, 0 ≤ r ≤ 1, meets the sphere's near side at the angle α with its
//! normal,
//!
//! ```text
//! cos² α = 1 − (d/R)² sin² θ = (1 − r²) (2 − m (1 + r²)) / (2 − m)
//! ```
//!
//! again without cancellation. So a sphere of any size and distance is sampled to the precision of
//! the numbers; all is in double precision, since in single precision a direction cannot tell the
//! parts of a sphere that is seen under 10⁻⁷ rad.

use super::cap::uniform_cone_to_square;
use super::disk::square_to_polar;
use core::f64::consts::TAU;
use glam::{DVec3, Vec2, Vec3};

/// The cone of directions from a point outside a sphere to that sphere.
#[derive(Clone, Copy, Debug)]
pub struct SphereCone {
    /// Unit vectors across and along the axis.
    s: DVec3,
    t: DVec3,
    axis: DVec3,
    one_minus_cos_max: f64,
}

impl SphereCone {
    /// The cone to a sphere of radius `radius` (m) whose centre is at `center` (m) from the
    /// point. `None` for a point inside or on the sphere, or a sphere too small to be seen
    /// (the density per solid angle overflows).
    #[inline]
    pub fn new(center: DVec3, radius: f64) -> Option<Self> {
        let distance = center.length();
        // (d − R)(d + R) rather than d² − R²: precise next to the surface.
        let tangent_squared = (distance - radius) * (distance + radius);
        if !(tangent_squared > 0.0) {
            return None;
        }
        let sin = radius / distance;
        let one_minus_cos_max = sin * sin / (1.0 + tangent_squared.sqrt() / distance);
        // A frame around the axis (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
        let axis = center / distance;
        let sign = 1.0_f64.copysign(axis.z);
        let a = -1.0 / (sign + axis.z);
        let b = axis.x * axis.y * a;
        let cone = Self {
            s: DVec3::new(1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x),
            t: DVec3::new(b, sign + axis.y * axis.y * a, -axis.y),
            axis,
            one_minus_cos_max,
        };
        (one_minus_cos_max > 0.0 && cone.density().is_finite()).then_some(cone)
    }

    /// 1 − cos, sin and the unit vector across the axis of a direction, and the squared radius of
    /// its place in the disk.
    #[inline]
    fn choose(&self, u: Vec2) -> (f64, f64, DVec3, f64) {
        let (radius, point) = square_to_polar(u.to_array());
        let point = Vec2::from(point);
        let squared = f64::from(radius) * f64::from(radius);
        let one_minus_cos = squared * self.one_minus_cos_max;
        let sin = (one_minus_cos * (2.0 - one_minus_cos)).sqrt();
        let point = point.as_dvec2();
        let across = (self.s * point.x + self.t * point.y).normalize_or(self.s);
        (one_minus_cos, sin, across, squared)
    }

    /// A unit direction towards the sphere, uniform by solid angle.
    #[inline]
    pub fn sample(&self, u: Vec2) -> Vec3 {
        let (one_minus_cos, sin, across, _) = self.choose(u);
        (across * sin + self.axis * (1.0 - one_minus_cos)).as_vec3()
    }

    /// The unit normal of the sphere, outward, where the direction of [`SphereCone::sample`] first
    /// meets it.
    #[inline]
    pub fn sample_normal(&self, u: Vec2) -> DVec3 {
        let (one_minus_cos, sin, across, squared) = self.choose(u);
        let m = self.one_minus_cos_max;
        let cos = 1.0 - one_minus_cos;
        let cos_alpha_squared = (1.0 - squared) * (2.0 - m * (1.0 + squared)) / (2.0 - m);
        let cos_alpha = cos_alpha_squared.sqrt();
        let sin_alpha = (1.0 - cos_alpha_squared).sqrt();
        across * (sin_alpha * cos - cos_alpha * sin)
            - self.axis * (sin_alpha * sin + cos_alpha * cos)
    }

    /// The inverse of [`SphereCone::sample`], for a direction that meets the sphere.
    #[inline]
    pub fn invert(&self, direction: Vec3) -> Vec2 {
        let direction = direction.as_dvec3();
        let local = DVec3::new(
            self.s.dot(direction),
            self.t.dot(direction),
            self.axis.dot(direction),
        );
        uniform_cone_to_square(local.as_vec3(), self.one_minus_cos_max as f32)
    }

    /// The density per steradian, the same for every direction that meets the sphere.
    #[inline]
    pub fn density(&self) -> f32 {
        (1.0 / (TAU * self.one_minus_cos_max)) as f32
    }
}
