//! The directions in which a point sees a sphere: a cone, uniform by solid angle.
//!
//! With sin² θₘₐₓ = R²/d², 1 − cos θₘₐₓ = sin² θₘₐₓ / (1 + cos θₘₐₓ), which cancels nowhere:
//! a sphere of any size and distance is sampled to full precision.

use super::cap::{square_to_uniform_cone, uniform_cone_density, uniform_cone_to_square};
use etalon_math::Frame;
use glam::{Vec2, Vec3};

/// The cone of directions from a point outside a sphere to that sphere.
#[derive(Clone, Copy, Debug)]
pub struct SphereCone {
    frame: Frame,
    one_minus_cos_max: f32,
}

impl SphereCone {
    /// The cone to a sphere of radius `radius` (m) whose centre is at `center` (m) from the
    /// point. `None` for a point inside or on the sphere, or a sphere too small to be seen
    /// (its solid angle underflows).
    #[inline]
    pub fn new(center: Vec3, radius: f32) -> Option<Self> {
        let distance_squared = center.length_squared();
        let distance = distance_squared.sqrt();
        // (d − R)(d + R) rather than d² − R²: precise next to the surface.
        let tangent_squared = (distance - radius) * (distance + radius);
        if !(tangent_squared > 0.0) {
            return None;
        }
        let sin = radius / distance;
        let one_minus_cos_max = sin * sin / (1.0 + tangent_squared.sqrt() / distance);
        (one_minus_cos_max > f32::MIN_POSITIVE).then(|| Self {
            frame: Frame::from_normal(center / distance),
            one_minus_cos_max,
        })
    }

    /// A unit direction towards the sphere, uniform by solid angle.
    #[inline]
    pub fn sample(&self, u: Vec2) -> Vec3 {
        self.frame
            .to_world(square_to_uniform_cone(u, self.one_minus_cos_max))
    }

    /// The inverse of [`SphereCone::sample`], for a direction that meets the sphere.
    #[inline]
    pub fn invert(&self, direction: Vec3) -> Vec2 {
        uniform_cone_to_square(self.frame.to_local(direction), self.one_minus_cos_max)
    }

    /// The density per steradian, the same for every direction that meets the sphere.
    #[inline]
    pub fn density(&self) -> f32 {
        uniform_cone_density(self.one_minus_cos_max)
    }

    /// 1 − cos of the angle between the axis and the rim.
    #[inline]
    pub fn one_minus_cos_max(&self) -> f32 {
        self.one_minus_cos_max
    }
}
