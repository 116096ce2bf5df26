//! The sphere that holds a scene, for lights at infinity.

use etalon_math::Frame;
use etalon_sampling::warps::square_to_concentric_disk;
use etalon_transport::Ray;
use glam::{Vec2, Vec3};

/// A sphere that holds everything that light can fall on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingSphere {
    /// Its centre (m).
    pub centre: Vec3,
    /// Its radius (m); zero if there is nothing.
    pub radius: f32,
}

impl BoundingSphere {
    /// The sphere around the box from `low` to `high`, a little larger, so that rays that start
    /// on it start outside of everything. Nothing at all if the box is empty or not finite.
    pub fn of_box(low: Vec3, high: Vec3) -> Self {
        let half = (high - low) * 0.5;
        if !(half.is_finite() && half.min_element() >= 0.0) {
            return Self {
                centre: Vec3::ZERO,
                radius: 0.0,
            };
        }
        let centre = low + half;
        let radius = half.length() * 1.001 + centre.length() * 1e-6;
        Self { centre, radius }
    }

    /// Area of a cross-section through the centre (m²).
    pub fn cross_section(&self) -> f64 {
        core::f64::consts::PI * f64::from(self.radius) * f64::from(self.radius)
    }

    /// The density of the rays of [`BoundingSphere::ray_into`] over a cross-section (m⁻²); zero where there
    /// is nothing to enter.
    #[inline]
    pub fn ray_density(&self) -> f32 {
        let area = self.cross_section() as f32;
        if area > 0.0 { 1.0 / area } else { 0.0 }
    }

    /// A ray along `direction` that starts outside of the sphere and enters it, uniformly
    /// distributed over the sphere's cross-section: with density 1/(π r²) (m⁻²).
    #[inline]
    pub fn ray_into(&self, direction: Vec3, u: Vec2) -> Ray {
        let offset = square_to_concentric_disk(u);
        let frame = Frame::from_normal(direction);
        let start = frame.s * offset.x + frame.t * offset.y - direction;
        Ray::new(self.centre + start * self.radius, direction, 0.0)
    }
}
