//! `linearcurve`: balls that roll along a polyline, their radii between those of its points.
//!
//! The balls |p − c(v)| = r(v), c = p₀ + v a, r = r₀ + v b, 0 ≤ v ≤ 1, touch their envelope where
//!
//! ```text
//! v = ((p − p₀)·a + r₀ b) / (a² − b²)
//! |p − p₀|² − r₀² = ((p − p₀)·a + r₀ b)² / (a² − b²)
//! ```
//!
//! a quadratic in t for p = o + t·d; where v is below 0 or above 1, the end's ball is the surface, and where a² ≤ b²
//! one ball holds the other.

use crate::shapes::analytic::crossing::Line;
use crate::shapes::curves::{ControlPoint, CurvePoint, Segment};
use etalon_math::polynomial::quadratic;
use glam::DVec3;

/// The convex hull of two balls.
#[derive(Clone, Copy, Debug)]
pub struct RoundCone {
    ends: [ControlPoint; 2],
}

impl RoundCone {
    fn axis(&self) -> DVec3 {
        self.ends[1].position - self.ends[0].position
    }

    fn growth(&self) -> f64 {
        self.ends[1].radius - self.ends[0].radius
    }

    /// a² − b².
    fn squared_slant(&self) -> f64 {
        self.axis().length_squared() - self.growth() * self.growth()
    }

    /// The parameter of the ball that touches the envelope at `p`.
    fn parameter(&self, p: DVec3) -> f64 {
        let from = p - self.ends[0].position;
        (from.dot(self.axis()) + self.ends[0].radius * self.growth()) / self.squared_slant()
    }
}

impl Segment for RoundCone {
    const POINTS: usize = 2;

    fn new(points: &[ControlPoint]) -> Self {
        Self {
            ends: [points[0], points[1]],
        }
    }

    fn entry(&self, line: &Line, after: f64) -> Option<(f64, f64)> {
        let [first, last] = self.ends;
        let d = line.direction;
        // From the point nearest to the middle, so that a far origin costs no digits.
        let middle = 0.5 * (first.position + last.position);
        let start = (middle - line.origin).dot(d) / d.length_squared();
        let o = line.at(start);
        let (a, b, slant) = (self.axis(), self.growth(), self.squared_slant());
        // The entry into a ball.
        let ball = |end: &ControlPoint| {
            let from = o - end.position;
            let c = from.length_squared() - end.radius * end.radius;
            quadratic(d.length_squared(), 2.0 * from.dot(d), c).map(|(t, _)| t)
        };
        let mut found: Option<(f64, f64)> = None;
        let mut note = |t: Option<f64>, fits: &dyn Fn(f64) -> bool| {
            if let Some(t) = t {
                let v = if slant > 0.0 {
                    self.parameter(o + d * t)
                } else {
                    f64::from(b > 0.0)
                };
                if fits(v) && found.is_none_or(|(nearest, _)| t < nearest) {
                    found = Some((t, v.clamp(0.0, 1.0)));
                }
            }
        };
        if slant > 0.0 {
            let from = o - first.position;
            let (along, slope) = (from.dot(a) + first.radius * b, d.dot(a));
            let second = d.length_squared() - slope * slope / slant;
            let linear = 2.0 * (from.dot(d) - along * slope / slant);
            let constant =
                from.length_squared() - first.radius * first.radius - along * along / slant;
            // A line that is steeper than the cone leaves one nappe and enters the other.
            let sides = quadratic(second, linear, constant);
            let side = sides.map(|(near, far)| if second > 0.0 { near } else { far });
            note(side, &|v| (0.0..=1.0).contains(&v));
            note(ball(&first), &|v| v < 0.0);
            note(ball(&last), &|v| v > 1.0);
        } else {
            let larger = if b > 0.0 { last } else { first };
            note(ball(&larger), &|_| true);
        }
        found
            .map(|(t, v)| (t + start, v))
            .filter(|(t, _)| *t > after)
    }

    fn surface(&self, v: f64, p: DVec3) -> CurvePoint {
        let [first, last] = self.ends;
        let axis = first.position.lerp(last.position, v);
        let radius = first.radius + v * self.growth();
        let outward = (p - axis).normalize_or(DVec3::Z);
        CurvePoint {
            axis,
            radial: outward * radius,
            normal: outward,
            tangent: self.axis().normalize_or(DVec3::X),
            along: self.axis() + outward * self.growth(),
        }
    }

    fn bounds(&self) -> [DVec3; 2] {
        let [[a, b], [c, d]] = self
            .ends
            .map(|end| [end.position - end.radius, end.position + end.radius]);
        [a.min(c), b.max(d)]
    }
}
