//! `revolution`: a curve (r(s), z(s)) turned about the z axis.
//!
//! With the line o + t·d, A = dx² + dy², B = ox dx + oy dy, C = ox² + oy², it meets the circle of s where
//!
//! ```text
//! z(s) = oz + t dz   and   A t² + 2 B t + C = r(s)²
//! ```
//!
//! Steep lines (dz² > A): t = (z(s) − oz)/dz is put into the second equation. Others: t = (−B ± √(B² − A (C − r²)))/A
//! into the first, once for each sign, the root being 0 where the line passes the circle by. Either is a function of s
//! whose changes of sign are isolated (`shapes/isolate.rs`), piece by piece; nothing is missed but what comes
//! and goes within 10⁻⁵ of a piece. A profile that is closed, or begins and ends on the axis, bounds a solid.

use crate::shapes::crossing::{Crossing, Line};
use crate::shapes::isolate::{OneParameter, sign_changes};
use crate::shapes::placed::{OwnPoint, OwnShape, Placed};
use crate::shapes::profile::{self, Cubic};
use core::f64::consts::TAU;
use core::ops::ControlFlow;
use etalon_math::expression::Number;
use etalon_math::float64::{atan2, sin_cos};
use etalon_params::Params;
use glam::{DVec2, DVec3};

/// A surface of revolution.
#[derive(Clone, Debug)]
pub struct Revolution {
    pieces: Vec<Cubic>,
    closed: bool,
    /// −1 if the profile's left side, seen along it, is outside.
    outward: f64,
}

/// The smallest piece of a cubic that is cut further.
const SMALLEST: f64 = 1e-5;

/// What vanishes where a line meets the circle of s.
struct Meeting<'a> {
    piece: &'a Cubic,
    line: &'a Line,
    a: f64,
    b: f64,
    c: f64,
    /// The root's sign; 0 for a steep line.
    sign: f64,
}

impl Meeting<'_> {
    /// t of the circle of s.
    fn t<N: Number>(&self, s: N) -> N {
        let constant = N::constant;
        if self.sign == 0.0 {
            let z = self.piece.coordinate(1, s);
            let up = z.add(constant(-self.line.origin.z));
            return up.div(constant(self.line.direction.z));
        }
        let r2 = self.piece.coordinate(0, s).powi(2);
        let beyond = constant(self.b * self.b - self.a * self.c).add(r2.mul(constant(self.a)));
        let none = constant(0.0);
        let root = N::max_with(beyond, none, none, none).0.sqrt();
        root.mul(constant(self.sign))
            .add(constant(-self.b))
            .div(constant(self.a))
    }

    /// Whether the line reaches the circle of s.
    fn reaches(&self, s: f64) -> bool {
        let r: f64 = self.piece.coordinate(0, s);
        let beyond = self.b * self.b - self.a * (self.c - r * r);
        self.sign == 0.0 || beyond >= -1e-12 * self.b * self.b
    }
}

impl OneParameter for Meeting<'_> {
    fn eval<N: Number>(&self, s: N) -> N {
        let constant = N::constant;
        let t = self.t(s);
        if self.sign == 0.0 {
            let r2 = self.piece.coordinate(0, s).powi(2);
            let along = t.powi(2).mul(constant(self.a));
            let across = t.mul(constant(2.0 * self.b)).add(constant(self.c));
            along.add(across).add(r2.neg())
        } else {
            let z = self.piece.coordinate(1, s);
            let up = t.mul(constant(self.line.direction.z));
            z.add(constant(-self.line.origin.z)).add(up.neg())
        }
    }
}

impl Revolution {
    /// Reads `profile`, pairs of r and z, `curve`, `closed`, `flip_normals` and `to_world`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Placed<Self>> {
        let pieces = profile::from_params(params);
        let pieces = pieces.filter(|pieces| {
            let low = pieces.iter().map(|piece| piece.bounds()[0].x);
            let fits = low.fold(f64::INFINITY, f64::min) >= 0.0;
            if !fits {
                let message = "the `profile` of a `revolution` must not cross the axis: all r, those of \
                               inner points included, must be 0 or more";
                params.error_at("profile", message);
            }
            fits
        });
        Placed::from_params(params, pieces.map(Self::new))
    }

    fn new(pieces: Vec<Cubic>) -> Self {
        let (first, last) = (pieces[0].0[0], pieces[pieces.len() - 1].0[3]);
        let closed = first == last || (first.x == 0.0 && last.x == 0.0);
        // ∮ r² dz, by the trapezoid rule: the solid's volume over π if the profile goes up outside.
        let points = pieces
            .iter()
            .flat_map(|p| (0..32).map(|k| p.at(f64::from(k) / 32.0)));
        let points: Vec<DVec2> = points.chain([last]).collect();
        let volume: f64 = (points.windows(2))
            .map(|pair| (pair[0].x.powi(2) + pair[1].x.powi(2)) * (pair[1].y - pair[0].y))
            .sum();
        Self {
            outward: if closed && volume < 0.0 { -1.0 } else { 1.0 },
            pieces,
            closed,
        }
    }

    /// The surface at azimuth and place on a piece.
    fn point(&self, azimuth: f64, index: usize, s: f64) -> OwnPoint {
        let piece = &self.pieces[index];
        let (sin, cos) = sin_cos(azimuth);
        let c = piece.at(s);
        // At a cusp, or where inner points lie on ends, the direction near by.
        let tangent = match piece.tangent(s) {
            DVec2::ZERO => piece.tangent(s + (0.5 - s) * 1e-6),
            tangent => tangent,
        };
        let around = |v: DVec2| DVec3::new(v.x * cos, v.x * sin, v.y);
        let count = self.pieces.len() as f64;
        OwnPoint {
            position: around(c),
            normal: around(DVec2::new(tangent.y, -tangent.x)) * self.outward,
            uv: DVec2::new((azimuth / TAU).rem_euclid(1.0), (index as f64 + s) / count),
            dp_du: DVec3::new(-sin, cos, 0.0) * (TAU * c.x.max(1e-12)),
            dp_dv: around(tangent) * count,
        }
    }

    /// Calls `visit` with t, the piece and s of every crossing.
    fn crossings(&self, line: &Line, mut visit: impl FnMut(f64, usize, f64)) {
        let (o, d) = (line.origin, line.direction);
        let a = d.truncate().length_squared();
        let b = o.truncate().dot(d.truncate());
        let c = o.truncate().length_squared();
        let nearest = c - if a > 0.0 { b * b / a } else { 0.0 };
        let signs: &[f64] = if d.z * d.z > a { &[0.0] } else { &[-1.0, 1.0] };
        for (index, piece) in self.pieces.iter().enumerate() {
            let [low, high] = piece.bounds();
            let slack = 1e-9 * (high.x + high.y - low.y);
            let reach = high.x + slack;
            let around = [
                DVec3::new(-reach, -reach, low.y - slack),
                DVec3::new(reach, reach, high.y + slack),
            ];
            if nearest > reach * reach || line.misses(around, f64::NEG_INFINITY) {
                continue;
            }
            for &sign in signs {
                let meeting = Meeting {
                    piece,
                    line,
                    a,
                    b,
                    c,
                    sign,
                };
                let nothing = |_: f64, _: f64| false;
                sign_changes(&meeting, (0.0, 1.0), SMALLEST, nothing, |s, _| {
                    if meeting.reaches(s) {
                        visit(meeting.t(s), index, s);
                    }
                    ControlFlow::<()>::Continue(())
                });
            }
        }
    }
}

impl OwnShape for Revolution {
    fn next_crossing(&self, line: &Line, after: f64, _: f64) -> Option<Crossing> {
        let mut nearest: Option<(f64, usize, f64)> = None;
        let mut passed = 0_u32;
        self.crossings(line, |t, index, s| {
            if t <= after {
                passed += 1;
            } else if nearest.is_none_or(|(best, ..)| t < best) {
                nearest = Some((t, index, s));
            }
        });
        let (t, index, s) = nearest?;
        let enters = if self.closed {
            passed.is_multiple_of(2)
        } else {
            let p = line.at(t);
            let point = self.point(atan2(p.y, p.x), index, s);
            point.normal.dot(line.direction) < 0.0
        };
        Some(Crossing {
            uv: DVec2::new(index as f64, s),
            ..Crossing::new(t, enters)
        })
    }

    fn surface_at(&self, p: DVec3, crossing: &Crossing) -> OwnPoint {
        let index = (crossing.uv.x as usize).min(self.pieces.len() - 1);
        self.point(atan2(p.y, p.x), index, crossing.uv.y)
    }

    fn bounds(&self) -> [DVec3; 2] {
        let boxes = self.pieces.iter().map(Cubic::bounds);
        let [low, high] = boxes.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[l, h], [a, b]| {
            [l.min(a), h.max(b)]
        });
        [
            DVec3::new(-high.x, -high.x, low.y),
            DVec3::new(high.x, high.x, high.y),
        ]
    }

    fn is_closed(&self) -> bool {
        self.closed
    }
}
