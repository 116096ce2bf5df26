//! The directions in which a point sees a sphere: a cone, uniform by solid angle.
//!
//! With sin² θₘₐₓ = R²/d², m = 1 − cos θₘₐₓ = sin² θₘₐₓ / (1 + cos θₘₐₓ), which cancels nowhere. A
//! direction at 1 − cos θ = r² m, 0 ≤ r ≤ 1, meets the sphere's near side at the angle α with its
//! normal,
//!
//! ```text
//! cos² α = 1 − (d/R)² sin² θ = (1 − r²) (2 − m (1 + r²)) / (2 − m)
//! sin² α = (d/R)² sin² θ       = r² (2 − m r²) / (2 − m)
//! ```
//!
//! again without cancellation. So normals of a sphere of any size and distance are sampled to the precision of the numbers, though
//! in single precision a direction cannot tell the parts of a sphere that is seen under 10⁻⁷ rad.

use super::cap::uniform_cone_to_square;
use super::disk::square_to_polar;
use core::f32::consts::TAU;
use etalon_math::lane::{Lane, LaneFrame, Vector};
use glam::{Vec2, Vec3};

/// The cones of directions from points outside spheres to those.
#[derive(Clone, Copy, Debug)]
pub struct SphereCone<F: Lane = f32> {
    /// Whether there is one: not for a point inside or on the sphere, or a sphere too small to be seen (the density per solid
    /// angle overflows).
    pub exists: F::Mask,
    /// Around the axis.
    frame: LaneFrame<F>,
    one_minus_cos_max: F,
}

/// A direction within a cone.
struct Choice<F: Lane> {
    one_minus_cos: F,
    sin: F,
    /// The unit vector across the axis.
    across: F::Vector,
    /// The squared radius of its place in the disk.
    squared: F,
}

impl<F: Lane> SphereCone<F> {
    /// The cones to spheres of radius `radius` (m) whose centres are at `center` (m) from the points.
    #[inline(always)]
    pub fn new(center: F::Vector, radius: F) -> Self {
        let distance = center.norm();
        // (d − R)(d + R) rather than d² − R²: precise next to the surface.
        let tangent_squared = (distance - radius) * (distance + radius);
        let sin = radius / distance;
        let one_minus_cos_max = sin * sin / (tangent_squared.sqrt() / distance + F::ONE);
        let density = F::ONE / (one_minus_cos_max * TAU);
        Self {
            exists: tangent_squared.gt(F::ZERO)
                & one_minus_cos_max.gt(F::ZERO)
                & density.lt(F::splat(f32::INFINITY)),
            frame: LaneFrame::from_normal(center.over(distance)),
            one_minus_cos_max,
        }
    }

    #[inline(always)]
    fn choose(&self, u: [F; 2]) -> Choice<F> {
        let (radius, [x, y]) = square_to_polar(u);
        let squared = radius * radius;
        let one_minus_cos = squared * self.one_minus_cos_max;
        let across = self.frame.s * x + self.frame.t * y;
        let length = across.norm();
        Choice {
            one_minus_cos,
            sin: (one_minus_cos * (F::splat(2.0) - one_minus_cos)).sqrt(),
            across: F::Vector::choose(length.gt(F::ZERO), across.over(length), self.frame.s),
            squared,
        }
    }

    /// Unit directions towards the spheres, uniform by solid angle.
    #[inline(always)]
    pub fn sample(&self, u: [F; 2]) -> F::Vector {
        let choice = self.choose(u);
        choice.across * choice.sin + self.frame.n * (F::ONE - choice.one_minus_cos)
    }

    /// The unit normals of the spheres, outward, where the directions of [`SphereCone::sample`] first meet them.
    #[inline(always)]
    pub fn sample_normal(&self, u: [F; 2]) -> F::Vector {
        let choice = self.choose(u);
        let (m, squared) = (self.one_minus_cos_max, choice.squared);
        let two = F::splat(2.0);
        let (sin, cos) = (choice.sin, F::ONE - choice.one_minus_cos);
        let cos_alpha = (F::ONE - squared) * (two - m * (squared + F::ONE)) / (two - m);
        let sin_alpha = squared * (two - m * squared) / (two - m);
        let (sin_alpha, cos_alpha) = (sin_alpha.sqrt(), cos_alpha.sqrt());
        choice.across * (sin_alpha * cos - cos_alpha * sin)
            - self.frame.n * (sin_alpha * sin + cos_alpha * cos)
    }

    /// The densities per steradian, the same for every direction that meets a sphere.
    #[inline(always)]
    pub fn density(&self) -> F {
        F::ONE / (self.one_minus_cos_max * TAU)
    }
}

impl SphereCone {
    /// The inverse of [`SphereCone::sample`], for a direction that meets the sphere.
    #[inline]
    pub fn invert(&self, direction: Vec3) -> Vec2 {
        uniform_cone_to_square(self.frame.to_local(direction), self.one_minus_cos_max)
    }
}
