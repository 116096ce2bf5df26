//! Distances along a ray at which the light of a point is best caught: even in the angle seen from there.
//!
//! ```text
//! t = Δ + D tan θ,   θ even between θₐ and θᵦ,   p(t) = D / ((θᵦ − θₐ)(D² + (t − Δ)²))
//! ```
//!
//! with Δ where the ray comes nearest to the point, and D how near (C. Kulla, M. Fajardo, Importance sampling techniques for path
//! tracing in participating media, 2012, eqs. 4 to 6). It cancels the square of the distance in the light's irradiance.

use etalon_math::float;
use etalon_transport::Ray;
use glam::Vec3;

/// Distances along a ray by the angle that they are seen at from a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Equiangular {
    /// Δ (m).
    nearest: f32,
    /// D (m); a little above zero for a point on the ray.
    distance: f32,
    /// θₐ.
    first: f32,
    /// θᵦ − θₐ.
    span: f32,
}

impl Equiangular {
    /// Along `ray` up to `t_max`, which may be infinite, from `point`.
    pub(crate) fn new(ray: &Ray, t_max: f32, point: Vec3) -> Option<Self> {
        let way = point - ray.origin;
        let nearest = way.dot(ray.direction);
        let distance = (way - nearest * ray.direction)
            .length()
            .max(1e-5 * way.length());
        let angle = |t: f32| float::atan((t - nearest) / distance);
        let (first, last) = (angle(0.0), angle(t_max));
        let span = last - first;
        // False for NaN, too.
        (span > 0.0).then_some(Self {
            nearest,
            distance,
            first,
            span,
        })
    }

    /// The distance for `u` in [0, 1).
    pub(crate) fn sample(&self, u: f32) -> f32 {
        let t = self.nearest + self.distance * float::tan(self.first + u * self.span);
        t.max(0.0)
    }

    /// The density of a distance (m⁻¹).
    pub(crate) fn density(&self, t: f32) -> f32 {
        let along = t - self.nearest;
        self.distance / (self.span * (self.distance * self.distance + along * along))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Between two of its quantiles the density has as much as between their numbers (by Simpson's rule in the angle's steps).
        #[test]
        fn the_density_is_that_of_the_samples(
            x in -3.0_f32..3.0,
            y in 0.05_f32..2.0,
            end in 0.5_f32..6.0,
            u in 0.0_f32..0.9,
        ) {
            let ray = Ray::new(Vec3::ZERO, Vec3::X, 0.0);
            for end in [end, f32::INFINITY] {
                let along = Equiangular::new(&ray, end, Vec3::new(x, y, 0.0)).expect("a way");
                let (low, high) = (along.sample(u), along.sample(u + 0.01));
                prop_assert!(0.0 <= low && low < high && high <= end * 1.0001);
                let middle = along.density(0.5 * (low + high));
                let mean = (along.density(low) + 4.0 * middle + along.density(high)) / 6.0;
                prop_assert!((mean * (high - low) / 0.01 - 1.0).abs() < 0.02, "{}", mean * (high - low));
            }
        }
    }

    #[test]
    fn a_point_on_the_ray_or_no_way_is_no_trouble() {
        let ray = Ray::new(Vec3::ZERO, Vec3::X, 0.0);
        let along = Equiangular::new(&ray, 2.0, Vec3::X).expect("a way");
        assert!(along.density(along.sample(0.5)).is_finite());
        assert!(Equiangular::new(&ray, 0.0, Vec3::Y).is_none());
        assert!(Equiangular::new(&ray, 1.0, Vec3::ZERO).is_none());
    }
}
