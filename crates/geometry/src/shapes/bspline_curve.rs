//! `bsplinecurve`: circles across a cubic B-spline, their radii one as well; open at its ends. `beziercurve`: the same across cubic Bézier
//! curves, each of which begins where the last one ends.
//!
//! A point p of the circle at u has (p − c)·c′ = 0 and |p − c| = r. With p = o + t·d the first gives
//! t = q·c′/(d·c′), q = c − o, and with that the second is a polynomial of degree 10 for each cubic piece,
//!
//! ```text
//! |c′ × (d × q)|² = r² (d·c′)²
//! ```
//!
//! whose changes of sign are isolated in Bernstein form. Its zeros fall together where the line lies across the curve,
//! d·c′ = 0; there u is the zero of q·c′, and t that of |o + t·d − c|² = r². The normal is
//! (c′² − ρ·c″) ρ − r r′ c′, with ρ = p − c.

use crate::shapes::analytic::crossing::Line;
use crate::shapes::curves::{ControlPoint, CurvePoint, Curves, Segment};
use core::ops::ControlFlow;
use etalon_math::bernstein;
use etalon_math::polynomial::quadratic;
use etalon_params::Params;
use etalon_transport::Build;
use glam::DVec3;

/// A cubic piece of a B-spline, in Bézier form.
#[derive(Clone, Copy, Debug)]
pub struct RoundSpline {
    c: [DVec3; 4],
    r: [f64; 4],
}

/// Lines whose d·c′ is below this part of |d| |c′| lie across the curve.
const ACROSS: f64 = 1e-7;

/// Resolution of zeros, as a share of a piece.
const SMALLEST: f64 = 1e-8;

/// The Bézier form of a cubic B-spline's piece.
fn bezier<T>([a, b, c, d]: [T; 4]) -> [T; 4]
where
    T: Copy + core::ops::Add<Output = T> + core::ops::Mul<f64, Output = T>,
{
    let third = 1.0 / 3.0;
    let (second, next) = (b * (2.0 * third) + c * third, b * third + c * (2.0 * third));
    let first = (a * third + b * (2.0 * third) + second) * 0.5;
    let last = (next + c * (2.0 * third) + d * third) * 0.5;
    [first, second, next, last]
}

/// The sum of products of three pairs of coordinates.
fn dot<const M: usize, const N: usize, const L: usize>(a: &[DVec3; M], b: &[DVec3; N]) -> [f64; L] {
    let mut sum = [0.0; L];
    for axis in 0..3 {
        let product: [f64; L] = bernstein::product(&a.map(|v| v[axis]), &b.map(|v| v[axis]));
        for (sum, term) in sum.iter_mut().zip(product) {
            *sum += term;
        }
    }
    sum
}

impl RoundSpline {
    /// Reads `filename`, `coordinates` and `to_world` of `beziercurve`.
    pub(crate) fn bezier_curves(
        params: &Params<'_>,
        build: &mut dyn Build,
    ) -> Option<Curves<Self>> {
        let curves = Curves::in_steps(params, build, (3, Self::of_bezier));
        curves.map(|curves| curves.with_coordinates(params))
    }

    fn of_bezier(points: &[ControlPoint]) -> Self {
        Self {
            c: core::array::from_fn(|i| points[i].position),
            r: core::array::from_fn(|i| points[i].radius),
        }
    }

    fn derivative(&self) -> [DVec3; 3] {
        core::array::from_fn(|i| 3.0 * (self.c[i + 1] - self.c[i]))
    }

    /// c, c′, c″, r and r′ at `u`.
    fn at(&self, u: f64) -> (DVec3, DVec3, DVec3, f64, f64) {
        let value = |axis: usize| bernstein::value(&self.c.map(|c| c[axis]), u);
        let d = self.derivative();
        let d2 = [d[1] - d[0], d[2] - d[1]].map(|v| 2.0 * v);
        let mixed = [d[0].lerp(d[1], u), d[1].lerp(d[2], u)];
        let r = self.r;
        let slopes = [r[1] - r[0], r[2] - r[1], r[3] - r[2]].map(|v| 3.0 * v);
        (
            DVec3::new(value(0), value(1), value(2)),
            mixed[0].lerp(mixed[1], u),
            d2[0].lerp(d2[1], u),
            bernstein::value(&r, u),
            bernstein::value(&slopes, u),
        )
    }

    fn normal(&self, u: f64, p: DVec3) -> DVec3 {
        let (c, c1, c2, r, r1) = self.at(u);
        let from = p - c;
        (c1.length_squared() - from.dot(c2)) * from - c1 * (r * r1)
    }

    /// Whether a line passes it by: in its own direction's view, with the chord across.
    fn is_missed(&self, o: DVec3, d: DVec3) -> bool {
        let thickest = self.r.into_iter().fold(0.0, f64::max);
        let chord = self.c[3] - self.c[0];
        let along = chord - d * (chord.dot(d) / d.length_squared());
        let along = along.try_normalize().unwrap_or(d.any_orthogonal_vector());
        let beside = |axis: DVec3| {
            let [a, b, c, d] = self.c.map(|c| axis.dot(c - o));
            let reach = thickest * axis.length() * (1.0 + 1e-9);
            a.min(b).min(c).min(d) > reach || a.max(b).max(c).max(d) < -reach
        };
        beside(d.cross(along)) || beside(along)
    }
}

impl Segment for RoundSpline {
    const POINTS: usize = 4;

    fn new(points: &[ControlPoint]) -> Self {
        let points: [ControlPoint; 4] = core::array::from_fn(|i| points[i]);
        Self {
            c: bezier(points.map(|p| p.position)),
            r: bezier(points.map(|p| p.radius)),
        }
    }

    fn entry(&self, line: &Line, after: f64) -> Option<(f64, f64)> {
        let d = line.direction;
        // From the point nearest to the middle, so that a far origin costs no digits.
        let middle = 0.5 * (self.c[0] + self.c[3]);
        let start = (middle - line.origin).dot(d) / d.length_squared();
        let o = line.at(start);
        if self.is_missed(o, d) {
            return None;
        }
        let slope = self.derivative();
        let q = self.c.map(|c| c - o);
        let across = slope.map(|c| d.dot(c));
        let mut found: Option<(f64, f64)> = None;
        let mut note = |u: f64| {
            let (c, .., r, _) = self.at(u);
            let from = o - c;
            let constant = from.length_squared() - r * r;
            // Of both roots, that of the surface is the one across the curve.
            let Some((near, far)) = quadratic(d.length_squared(), 2.0 * from.dot(d), constant)
            else {
                return;
            };
            let c1 = self.at(u).1;
            let off = |t: f64| (from + d * t).dot(c1).abs();
            let both = off(near).max(off(far)) < 1e-6 * r * c1.length();
            let chosen = match both {
                true => [near, far],
                false if off(near) < off(far) => [near; 2],
                false => [far; 2],
            };
            for t in chosen {
                let enters = self.normal(u, o + d * t).dot(d) < 0.0;
                if enters
                    && t + start > after
                    && found.is_none_or(|(nearest, _)| t + start < nearest)
                {
                    found = Some((t + start, u));
                }
            }
        };
        let steepest = across.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let length = d.length() * slope.iter().map(|c| c.length()).fold(0.0, f64::max);
        if steepest > ACROSS * length {
            // d × q and the cross product with c′, by coordinates.
            let m = q.map(|q| d.cross(q));
            let axes = |i: usize, j: usize| -> [f64; 6] {
                let a: [f64; 6] = bernstein::product(&slope.map(|v| v[i]), &m.map(|v| v[j]));
                let b: [f64; 6] = bernstein::product(&slope.map(|v| v[j]), &m.map(|v| v[i]));
                core::array::from_fn(|k| a[k] - b[k])
            };
            let w = [axes(1, 2), axes(2, 0), axes(0, 1)];
            let w: [DVec3; 6] = core::array::from_fn(|k| DVec3::new(w[0][k], w[1][k], w[2][k]));
            let squares: [f64; 11] = dot(&w, &w);
            let thick: [f64; 6] = bernstein::product(&self.r, &across);
            let thick: [f64; 11] = bernstein::product(&thick, &thick);
            let polynomial: [f64; 11] = core::array::from_fn(|k| squares[k] - thick[k]);
            bernstein::sign_changes(&polynomial, SMALLEST, |u, _| {
                note(u);
                ControlFlow::<()>::Continue(())
            });
        } else {
            let polynomial: [f64; 6] = dot(&q, &slope);
            bernstein::sign_changes(&polynomial, SMALLEST, |u, _| {
                note(u);
                ControlFlow::<()>::Continue(())
            });
        }
        found
    }

    fn surface(&self, u: f64, p: DVec3) -> CurvePoint {
        let (axis, c1, _, r, r1) = self.at(u);
        let tangent = c1.normalize_or(DVec3::X);
        let from = p - axis;
        let outward = (from - tangent * from.dot(tangent)).normalize_or(DVec3::Z);
        CurvePoint {
            axis,
            radial: outward * r,
            normal: self.normal(u, axis + outward * r),
            tangent,
            along: c1 + outward * r1,
        }
    }

    fn bounds(&self) -> [DVec3; 2] {
        let thickest = self.r.into_iter().fold(0.0, f64::max);
        let [a, b, c, d] = self.c;
        [
            a.min(b).min(c).min(d) - thickest,
            a.max(b).max(c).max(d) + thickest,
        ]
    }
}
