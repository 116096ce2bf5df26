//! Bounds on position and direction of lights, and their importance at a receiver.
//!
//! A cluster of lights of power Φ inside a sphere of radius r around c, whose normals are within an
//! angle θₒ of an axis a and which shine up to θₑ from their normals, has the importance, at a point x
//! with the unit normal n,
//!
//! ```text
//! I(x, n) = Φ · cos θ′ · |cos θᵢ′| / max(d², r²),    0 if θ′ ≥ θₑ,
//! θ′  = max(0, θ − θₒ − θᵤ),   θᵢ′ = max(0, θᵢ − θᵤ),
//! ```
//!
//! where d = |x − c|, θ is the angle between a and the way to x, θᵢ that between n (or −n) and the way
//! to c, and θᵤ the angle of the sphere as seen from x (A. Conty Estevez and C. Kulla, Importance sampling of
//! many lights with adaptive tree splitting, 2018, equation 3). No light of the cluster reaches a point
//! where I = 0. The bracket of θᵢ′ is 1 where there is no surface; where light from one side only counts, θᵢ is
//! not folded to that side, and I = 0 where θᵢ′ is beyond a right angle.

use etalon_math::DirectionCone;
use etalon_math::lane::{Lane, Select, Vector};
use etalon_transport::LaneReceiver;
use glam::{DVec3, Vec3};

/// Bounds of lights, in double precision, for building.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightExtent {
    /// Lower corner of the box around them (m).
    pub low: DVec3,
    /// Upper corner (m).
    pub high: DVec3,
    /// The normals of their surfaces; of a light without surface, the directions it shines to.
    pub normals: DirectionCone,
    /// Cosine of the angle from a normal up to which they shine; not below 0.
    pub cos_edge: f64,
    /// Power (W·nm⁻¹).
    pub power: f64,
}

impl LightExtent {
    /// Bounds of both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            normals: self.normals.union(other.normals),
            cos_edge: self.cos_edge.min(other.cos_edge),
            power: self.power + other.power,
        }
    }

    /// The middle of the box (m).
    pub fn centre(&self) -> DVec3 {
        0.5 * (self.low + self.high)
    }

    /// How many solid angles the lights shine into, 2π for one plane (sr): the measure M_Ω of Conty
    /// Estevez and Kulla (2018, equation 1).
    pub fn orientation_measure(&self) -> f64 {
        use core::f64::consts::{PI, TAU};
        use etalon_math::float64::{acos, cos, sin};
        let spread = acos(self.normals.cos.clamp(-1.0, 1.0));
        let reach = (spread + acos(self.cos_edge.clamp(0.0, 1.0))).min(PI);
        let ring =
            2.0 * reach * sin(spread) - cos(spread - 2.0 * reach) - 2.0 * spread * sin(spread)
                + cos(spread);
        TAU * (1.0 - cos(spread)) + 0.5 * PI * ring
    }
}

/// The same in single precision, for asking; bounds of several clusters in lanes.
#[derive(Clone, Copy, Debug)]
pub struct LightBounds<F: Lane = f32> {
    centre: F::Vector,
    /// r².
    radius_squared: F,
    axis: F::Vector,
    cos_spread: F,
    sin_spread: F,
    cos_edge: F,
    power: F,
}

/// The angle max(0, a − b), as cosine and sine.
#[inline(always)]
fn less<F: Lane>(a: [F; 2], b: [F; 2]) -> [F; 2] {
    let ([cos_a, sin_a], [cos_b, sin_b]) = (a, b);
    let none = cos_a.gt(cos_b);
    [
        none.select(F::ONE, cos_a * cos_b + sin_a * sin_b),
        none.select(F::ZERO, (sin_a * cos_b - cos_a * sin_b).max(F::ZERO)),
    ]
}

#[inline(always)]
fn sine<F: Lane>(cosine: F) -> F {
    (F::ONE - cosine * cosine).safe_sqrt()
}

impl LightBounds {
    /// Those of no light.
    pub(crate) const NONE: Self = Self {
        centre: Vec3::ZERO,
        radius_squared: 0.0,
        axis: Vec3::Z,
        cos_spread: 1.0,
        sin_spread: 0.0,
        cos_edge: 0.0,
        power: 0.0,
    };

    /// The bounds of lights within `extent`.
    pub fn new(extent: &LightExtent) -> Self {
        let half = 0.5 * (extent.high - extent.low);
        let centre = extent.centre();
        // Rounding must not turn a light that just reaches a point away from it.
        let slack = 1e-6 * (centre.abs().max_element() + half.length());
        let radius = half.length() * (1.0 + 1e-6) + slack;
        let cos_spread = (extent.normals.cos - 1e-6).max(-1.0) as f32;
        Self {
            centre: centre.as_vec3(),
            radius_squared: (radius * radius) as f32,
            axis: extent.normals.axis.as_vec3(),
            cos_spread,
            sin_spread: sine::<f32>(cos_spread),
            cos_edge: (extent.cos_edge - 1e-6) as f32,
            power: extent.power as f32,
        }
    }

    /// The same bounds in every lane.
    #[inline(always)]
    pub(crate) fn broadcast<F: Lane>(&self) -> LightBounds<F> {
        LightBounds {
            centre: F::Vector::broadcast(self.centre),
            radius_squared: F::splat(self.radius_squared),
            axis: F::Vector::broadcast(self.axis),
            cos_spread: F::splat(self.cos_spread),
            sin_spread: F::splat(self.sin_spread),
            cos_edge: F::splat(self.cos_edge),
            power: F::splat(self.power),
        }
    }
}

impl<F: Lane> LightBounds<F> {
    /// `bounds(i)` in lane i.
    #[inline(always)]
    pub(crate) fn of_lanes<'b>(bounds: impl Fn(usize) -> &'b LightBounds) -> Self {
        let [cx, cy, cz, radius_squared, ax, ay, az, power] = F::columns(|i| {
            let bounds = bounds(i);
            let ([cx, cy, cz], [ax, ay, az]) = (bounds.centre.to_array(), bounds.axis.to_array());
            [cx, cy, cz, bounds.radius_squared, ax, ay, az, bounds.power]
        });
        let [cos_spread, sin_spread, cos_edge, ..] = F::columns(|i| {
            let bounds = bounds(i);
            let [a, b, c] = [bounds.cos_spread, bounds.sin_spread, bounds.cos_edge];
            [a, b, c, 0.0, 0.0, 0.0, 0.0, 0.0]
        });
        Self {
            centre: F::Vector::from_xyz(cx, cy, cz),
            radius_squared,
            axis: F::Vector::from_xyz(ax, ay, az),
            cos_spread,
            sin_spread,
            cos_edge,
            power,
        }
    }

    /// I(x, n): not below 0, and 0 only where nothing arrives.
    #[inline(always)]
    pub fn at(&self, from: &LaneReceiver<F>) -> F {
        let to_centre = self.centre - from.position;
        let squared = to_centre.dot_product(to_centre);
        let direction = to_centre.over(squared.sqrt());
        // θᵤ is below a right angle outside of the sphere.
        let sin_sphere_squared = self.radius_squared / squared;
        let sphere = [
            (F::ONE - sin_sphere_squared).safe_sqrt(),
            sin_sphere_squared.sqrt(),
        ];
        let cos = -self.axis.dot_product(direction);
        let beyond = less(
            less([cos, sine(cos)], [self.cos_spread, self.sin_spread]),
            sphere,
        );
        let cos_light = cos.gt(self.cos_spread).select(F::ONE, beyond[0]);
        let promise = self.power * cos_light / squared;

        let cos = from.normal.dot_product(direction).clamp(-1.0, 1.0);
        let cos = from.one_sided.select(cos, cos.abs());
        let facing = LaneReceiver::<F>::counted(less([cos, sine(cos)], sphere)[0]);
        let promise = from.normal.is_zero().select(promise, promise * facing);
        let promise = cos_light.le(self.cos_edge).select(F::ZERO, promise);
        let inside = squared.le(self.radius_squared);
        inside.select(self.power / self.radius_squared, promise)
    }
}
