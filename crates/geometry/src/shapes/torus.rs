//! `torus`: all points at the distance r from a circle of radius R in the plane z = 0,
//!
//! ```text
//! (|p|² + R² − r²)² = 4 R² (x² + y²)
//! p(u, v) = ((R + r cos 2πv) cos 2πu, (R + r cos 2πv) sin 2πu, r sin 2πv)
//! ```
//!
//! A line meets it where a quartic vanishes, whose origin is moved to the point of the line nearest to the
//! torus's centre, so that far rays lose nothing. Its area is 4π² R r, its area element (R + r cos 2πv).

use crate::shapes::crossing::{Crossing, Line};
use crate::shapes::placed::{OwnPoint, OwnShape, Placed};
use core::f64::consts::{PI, TAU};
use etalon_math::float64::{atan2, sin, sin_cos};
use etalon_math::polynomial::quartic_roots;
use etalon_params::Params;
use glam::{DVec2, DVec3, Vec2};

/// A torus around the z axis.
#[derive(Clone, Copy, Debug)]
pub struct Torus {
    major: f64,
    minor: f64,
}

impl Torus {
    /// The torus with the radii R > r > 0 (m).
    pub fn new(major: f64, minor: f64) -> Option<Self> {
        (major > minor && minor > 0.0 && major.is_finite()).then_some(Self { major, minor })
    }

    /// Reads `major_radius`, `minor_radius`, `flip_normals` and `to_world`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Placed<Self>> {
        let positive = |r: f64| r > 0.0 && r.is_finite();
        let what = "a positive finite number";
        let major = params.float_where("major_radius", 1.0, what, positive);
        let minor = params.float_where("minor_radius", 0.25, what, positive);
        let torus = Self::new(major, minor);
        if torus.is_none() {
            let message = "the `minor_radius` of a `torus` must be below its `major_radius`";
            params.error_at("minor_radius", message);
        }
        Placed::from_params(params, torus)
    }

    /// The point with the azimuth and the angle around the tube (rad).
    fn point(&self, azimuth: f64, around: f64) -> OwnPoint {
        let ((sin_u, cos_u), (sin_v, cos_v)) = (sin_cos(azimuth), sin_cos(around));
        let radius = self.major + self.minor * cos_v;
        let normal = DVec3::new(cos_v * cos_u, cos_v * sin_u, sin_v);
        let turns = |angle: f64| (angle / TAU).rem_euclid(1.0);
        OwnPoint {
            position: DVec3::new(self.major * cos_u, self.major * sin_u, 0.0) + normal * self.minor,
            normal,
            uv: DVec2::new(turns(azimuth), turns(around)),
            dp_du: DVec3::new(-sin_u, cos_u, 0.0) * (TAU * radius),
            dp_dv: DVec3::new(-sin_v * cos_u, -sin_v * sin_u, cos_v) * (TAU * self.minor),
        }
    }
}

impl OwnShape for Torus {
    fn next_crossing(&self, line: &Line, after: f64, _: f64) -> Option<Crossing> {
        let length = line.direction.length();
        let d = line.direction / length;
        // Distances from the point nearest to the centre.
        let nearest = -line.origin.dot(d);
        let o = line.origin + d * nearest;
        let (outer, r2) = (self.major + self.minor, o.length_squared());
        let reach_squared = outer * outer - r2;
        if !(reach_squared > 0.0) {
            return None;
        }
        let reach = reach_squared.sqrt();
        // |p|² = s² + o², as o·d = 0: (s² + k)² − 4R²(…) with k = o² + R² − r².
        let k = r2 + self.major * self.major - self.minor * self.minor;
        let four = 4.0 * self.major * self.major;
        let [a, b, c] = [
            d.truncate().length_squared(),
            2.0 * o.truncate().dot(d.truncate()),
            o.truncate().length_squared(),
        ];
        let quartic = [k * k - four * c, -four * b, 2.0 * k - four * a, 0.0, 1.0];
        let roots = quartic_roots(quartic, -reach, reach);
        // A line comes from outside, so roots alternate between entering and leaving.
        (roots.as_slice().iter().enumerate())
            .map(|(index, s)| ((s + nearest) / length, index % 2 == 0))
            .find(|(t, _)| *t > after)
            .map(|(t, enters)| Crossing::new(t, enters))
    }

    fn surface_at(&self, p: DVec3, _: &Crossing) -> OwnPoint {
        let radius = p.truncate().length();
        self.point(atan2(p.y, p.x), atan2(p.z, radius - self.major))
    }

    fn parametric(&self, uv: DVec2) -> Option<OwnPoint> {
        Some(self.point(TAU * uv.x, TAU * uv.y))
    }

    fn bounds(&self) -> [DVec3; 2] {
        let outer = self.major + self.minor;
        let corner = DVec3::new(outer, outer, self.minor);
        [-corner, corner]
    }

    fn area(&self) -> Option<f64> {
        Some(4.0 * PI * PI * self.major * self.minor)
    }

    /// The angle around the tube by inverting v + (r/R) sin(2πv)/2π = u.
    fn sample_area(&self, u: Vec2) -> Option<OwnPoint> {
        let target = TAU * f64::from(u.y);
        let ratio = self.minor / self.major;
        let (mut low, mut high) = (0.0, TAU);
        let mut v = target;
        for _ in 0..60 {
            let (sine, cosine) = sin_cos(v);
            let off = v + ratio * sine - target;
            if off > 0.0 {
                high = v;
            } else {
                low = v;
            }
            let next = v - off / (1.0 + ratio * cosine);
            let next = if next > low && next < high {
                next
            } else {
                0.5 * (low + high)
            };
            if (next - v).abs() < 1e-14 {
                break;
            }
            v = next;
        }
        debug_assert!((v + ratio * sin(v) - target).abs() < 1e-9);
        Some(self.point(TAU * f64::from(u.x), v))
    }
}
