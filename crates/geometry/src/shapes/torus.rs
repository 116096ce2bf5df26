//! `torus`: all points at the distance r from a circle of radius R in the plane z = 0,
//!
//! ```text
//! (|p|² + R² − r²)² = 4 R² (x² + y²)
//! p(u, v) = ((R + r cos 2πv) cos 2πu, (R + r cos 2πv) sin 2πu, r sin 2πv)
//! ```
//!
//! A line meets it where a quartic vanishes, whose origin is moved to the point of the line nearest to the
//! torus's centre, so that far rays lose nothing. Its area element is (R + r cos 2πv).
//!
//! Where r ≥ R (a horn, a spindle) the tube reaches over the axis, and the solid is all that is in it: of the quartic's surface the
//! part is left that lies where |p|² + R² − r² = 2R √(x² + y²) > 0, as seen from outside, and not the spindle inside. It has the angles
//! |2πv| ≤ ω = arccos(−R/r) around the tube (ω = π of a ring), on which v is spread evenly over all of [0, 1], and the area
//! 4π r (R ω + r sin ω), which of a ring is 4π² R r.

use crate::shapes::analytic::crossing::{Crossing, Line};
use crate::shapes::analytic::placed::{OwnPoint, OwnShape, Placed};
use core::f64::consts::{PI, TAU};
use etalon_math::float64::{acos, atan2, sin, sin_cos};
use etalon_math::polynomial::quartic_roots;
use etalon_params::Params;
use glam::{DVec2, DVec3, Vec2};

/// A torus around the z axis.
#[derive(Clone, Copy, Debug)]
pub struct Torus {
    major: f64,
    minor: f64,
    /// ω, the largest angle around the tube.
    widest: f64,
}

impl Torus {
    /// The torus with the radii R > 0 and r > 0 (m).
    pub fn new(major: f64, minor: f64) -> Option<Self> {
        let widest = match minor > major {
            true => acos(-major / minor),
            false => PI,
        };
        (major > 0.0 && minor > 0.0 && major.is_finite() && minor.is_finite()).then_some(Self {
            major,
            minor,
            widest,
        })
    }

    /// Whether the tube reaches over the axis.
    fn is_spindle(&self) -> bool {
        self.minor > self.major
    }

    /// Reads `major_radius`, `minor_radius`, `flip_normals` and `to_world`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Placed<Self>> {
        let positive = |r: f64| r > 0.0 && r.is_finite();
        let what = "a positive finite number";
        let major = params.float_where("major_radius", 1.0, what, positive);
        let minor = params.float_where("minor_radius", 0.25, what, positive);
        Placed::from_params(params, Self::new(major, minor))
    }

    /// The angle around the tube of a point (rad).
    fn around(&self, p: DVec3) -> f64 {
        atan2(p.z, p.truncate().length() - self.major)
    }

    /// The point with the azimuth and the angle around the tube (rad).
    fn point(&self, azimuth: f64, around: f64) -> OwnPoint {
        let ((sin_u, cos_u), (sin_v, cos_v)) = (sin_cos(azimuth), sin_cos(around));
        let radius = self.major + self.minor * cos_v;
        let normal = DVec3::new(cos_v * cos_u, cos_v * sin_u, sin_v);
        let turns = |angle: f64| (angle / TAU).rem_euclid(1.0);
        // The existing share of the circle around the tube.
        let share = self.widest / PI;
        OwnPoint {
            position: DVec3::new(self.major * cos_u, self.major * sin_u, 0.0) + normal * self.minor,
            normal,
            uv: DVec2::new(turns(azimuth), turns(around / share)),
            dp_du: DVec3::new(-sin_u, cos_u, 0.0) * (TAU * radius),
            dp_dv: DVec3::new(-sin_v * cos_u, -sin_v * sin_u, cos_v) * (TAU * self.minor * share),
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
        if self.is_spindle() {
            let met = (roots.as_slice().iter())
                .filter(|s| *s * *s + k > 0.0)
                .map(|s| ((s + nearest) / length, *s))
                .find(|(t, _)| *t > after);
            return met.map(|(t, s)| {
                let p = o + d * s;
                let outward = self.point(atan2(p.y, p.x), self.around(p)).normal;
                Crossing::new(t, outward.dot(d) < 0.0)
            });
        }
        // A line comes from outside, so roots alternate between entering and leaving.
        (roots.as_slice().iter().enumerate())
            .map(|(index, s)| ((s + nearest) / length, index % 2 == 0))
            .find(|(t, _)| *t > after)
            .map(|(t, enters)| Crossing::new(t, enters))
    }

    fn surface_at(&self, p: DVec3, _: &Crossing) -> OwnPoint {
        self.point(atan2(p.y, p.x), self.around(p))
    }

    fn parametric(&self, uv: DVec2) -> Option<OwnPoint> {
        let around = match self.is_spindle() {
            // From −½ to ½ turn, which meet in the axis.
            true => 2.0 * self.widest * (uv.y - uv.y.round()),
            false => TAU * uv.y,
        };
        Some(self.point(TAU * uv.x, around))
    }

    fn charts(&self) -> usize {
        1
    }

    fn charted(&self, _chart: usize, uv: DVec2) -> Option<(OwnPoint, [DVec3; 2])> {
        let point = self.parametric(uv)?;
        Some((point, [point.dp_du, point.dp_dv]))
    }

    fn bounds(&self) -> [DVec3; 2] {
        let outer = self.major + self.minor;
        let corner = DVec3::new(outer, outer, self.minor);
        [-corner, corner]
    }

    fn area(&self) -> Option<f64> {
        // ω is π of a ring, whose sine only rounds.
        let beyond = match self.is_spindle() {
            true => self.minor * sin(self.widest),
            false => 0.0,
        };
        Some(4.0 * PI * self.minor * (self.major * self.widest + beyond))
    }

    /// The angle around the tube by inverting v + (r/R) sin(2πv)/2π = u, from −ω to ω of a spindle.
    fn sample_area(&self, u: Vec2) -> Option<OwnPoint> {
        let ratio = self.minor / self.major;
        let (target, [mut low, mut high]) = match self.is_spindle() {
            true => {
                let most = self.widest + ratio * sin(self.widest);
                let target = (2.0 * f64::from(u.y) - 1.0) * most;
                (target, [-self.widest, self.widest])
            }
            false => (TAU * f64::from(u.y), [0.0, TAU]),
        };
        let mut v = target.clamp(low, high);
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
