//! `bilinear`: the patch between four corners, a hyperbolic paraboloid unless they lie in a plane.
//!
//! ```text
//! p(u, v) = q(u) + v s(u),   q(u) = (1 − u) p00 + u p10,   s(u) = (1 − u)(p01 − p00) + u (p11 − p10)
//! ```
//!
//! A line o + t·d meets the ruling q(u) + v s(u) where (s(u) × d)·(q(u) − o) = 0, which is quadratic in u; v and t
//! follow from (q(u) − o) + v s(u) = t d (A. Reshetov 2019, *Cool Patches*, in *Ray Tracing Gems*).

use crate::shapes::analytic::crossing::{Crossing, Line};
use crate::shapes::analytic::placed::{OwnPoint, OwnShape, Placed};
use etalon_math::polynomial::quadratic;
use etalon_params::Params;
use glam::{DVec2, DVec3};

/// A patch of four corners.
#[derive(Clone, Copy, Debug)]
pub struct Bilinear {
    p00: DVec3,
    /// p10 − p00.
    along: DVec3,
    /// s(0).
    first: DVec3,
    /// s(1) − s(0).
    turn: DVec3,
}

impl Bilinear {
    /// Reads the corners `p00`, `p10`, `p01` and `p11` (those of the square [−1, 1]²), `flip_normals` and `to_world`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Placed<Self>> {
        let corner = |name, x: f64, y: f64| {
            let given = params.vector(name);
            given.unwrap_or(DVec3::new(x, y, 0.0))
        };
        let p00 = corner("p00", -1.0, -1.0);
        let p10 = corner("p10", 1.0, -1.0);
        let p01 = corner("p01", -1.0, 1.0);
        let p11 = corner("p11", 1.0, 1.0);
        let patch = Self {
            p00,
            along: p10 - p00,
            first: p01 - p00,
            turn: (p11 - p10) - (p01 - p00),
        };
        // A patch with area has a normal at a corner or in the middle.
        let spans = |u: f64, v: f64| patch.point(DVec2::new(u, v)).normal != DVec3::ZERO;
        let corners = [p00, p10, p01, p11];
        let any = spans(0.5, 0.5) || spans(0.0, 0.0) || spans(1.0, 0.0) || spans(0.0, 1.0);
        let fits = corners.iter().all(|p| p.is_finite()) && any;
        if !fits {
            params.error("the corners of a `bilinear` must be finite, and not all in a line");
        }
        Placed::from_params(params, fits.then_some(patch))
    }

    fn point(&self, uv: DVec2) -> OwnPoint {
        let ruling = self.first + self.turn * uv.x;
        let dp_du = self.along + self.turn * uv.y;
        OwnPoint {
            position: self.p00 + self.along * uv.x + ruling * uv.y,
            normal: dp_du.cross(ruling),
            uv,
            dp_du,
            dp_dv: ruling,
        }
    }

    /// The crossing with the ruling at `u`.
    fn crossing(&self, line: &Line, u: f64) -> Option<Crossing> {
        if !(0.0..=1.0).contains(&u) {
            return None;
        }
        let d = line.direction;
        let from = self.p00 + self.along * u - line.origin;
        let ruling = self.first + self.turn * u;
        let across = ruling.cross(d);
        let v = -from.cross(d).dot(across) / across.length_squared();
        if !(0.0..=1.0).contains(&v) {
            return None;
        }
        let t = (from + ruling * v).dot(d) / d.length_squared();
        let uv = DVec2::new(u, v);
        Some(Crossing {
            uv,
            ..Crossing::new(t, self.point(uv).normal.dot(d) < 0.0)
        })
    }
}

impl OwnShape for Bilinear {
    fn next_crossing(&self, line: &Line, after: f64, _: f64) -> Option<Crossing> {
        let (d, from) = (line.direction, self.p00 - line.origin);
        let (first, turn) = (self.first.cross(d), self.turn.cross(d));
        let a = turn.dot(self.along);
        let b = first.dot(self.along) + turn.dot(from);
        let (u0, u1) = quadratic(a, b, first.dot(from))?;
        let met = [u0, u1].map(|u| self.crossing(line, u));
        (met.into_iter().flatten())
            .filter(|met| met.t > after)
            .min_by(|a, b| a.t.total_cmp(&b.t))
    }

    fn surface_at(&self, _: DVec3, crossing: &Crossing) -> OwnPoint {
        let point = self.point(crossing.uv);
        // A corner where two sides meet in a line has the normal of a place near by.
        let normal = if point.normal.length_squared() > 0.0 {
            point.normal
        } else {
            let inward = crossing.uv + (DVec2::splat(0.5) - crossing.uv) * 1e-6;
            self.point(inward).normal
        };
        OwnPoint { normal, ..point }
    }

    fn parametric(&self, uv: DVec2) -> Option<OwnPoint> {
        Some(self.point(uv))
    }

    fn charts(&self) -> usize {
        1
    }

    fn charted(&self, _chart: usize, uv: DVec2) -> Option<(OwnPoint, [DVec3; 2])> {
        let point = self.point(uv);
        Some((point, [point.dp_du, point.dp_dv]))
    }

    fn bounds(&self) -> [DVec3; 2] {
        let corners =
            [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE].map(|uv| self.point(uv).position);
        let fold = |f: fn(DVec3, DVec3) -> DVec3| corners.into_iter().reduce(f).unwrap_or_default();
        [fold(DVec3::min), fold(DVec3::max)]
    }

    fn is_closed(&self) -> bool {
        false
    }
}
