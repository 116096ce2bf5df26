//! `revolution`: a curve (r(s), z(s)) turned about the z axis.
//!
//! With the line o + t·d, A = dx² + dy², B = ox dx + oy dy, C = ox² + oy², it meets the circle of s where
//!
//! ```text
//! z(s) = oz + t dz   and   A t² + 2 B t + C = r(s)²
//! ```
//!
//! Without t these are one polynomial of degree 6 for each cubic piece,
//!
//! ```text
//! A (z − oz)² + 2 B dz (z − oz) + dz² (C − r²) = 0,
//! ```
//!
//! whose changes of sign are isolated in Bernstein form. Its zeros come in pairs that fall together where a line lies
//! across the axis, dz = 0. There t = (−B ± √(B² − A (C − r²)))/A is put into the first equation, once for each sign,
//! and zeros are isolated by intervals (`shapes/analytic/sign_changes.rs`). A profile that is closed, or begins and ends on the
//! axis, bounds a solid.

use crate::shapes::analytic::crossing::{Crossing, Line};
use crate::shapes::analytic::placed::{OwnPoint, OwnShape, Placed};
use crate::shapes::analytic::sign_changes::{OneParameter, sign_changes};
use crate::shapes::profile::cubic::Cubic;
use crate::shapes::profile::lengths::Lengths;
use crate::shapes::profile::{self, Profile};
use core::f64::consts::TAU;
use core::ops::ControlFlow;
use etalon_math::bernstein;
use etalon_math::expression::Number;
use etalon_math::float64::{atan2, sin_cos};
use etalon_params::Params;
use glam::{DVec2, DVec3, Vec2};

/// A surface of revolution.
#[derive(Clone, Debug)]
pub struct Revolution {
    profile: Profile,
    /// r², z² and z of each piece, to degree 6.
    powers: Vec<[[f64; 7]; 3]>,
    closed: bool,
    /// −1 if the profile's left side, seen along it, is outside.
    outward: f64,
    /// Areas, for sampling points.
    areas: Lengths,
}

/// No t is larger, so that its products with zero are zero.
const MOST: f64 = 1e300;

/// Resolution of zeros, as a share of a piece.
const SMALLEST: f64 = 1e-9;

/// Lines with dz² below this part of A lie across the axis.
const ACROSS: f64 = 1e-10;

/// A line, from a point near the shape.
struct Turned {
    o: DVec3,
    d: DVec3,
    a: f64,
    b: f64,
    c: f64,
}

impl Turned {
    /// B² − A (C − r²): at least 0 where the line reaches the circle of radius r.
    fn beyond(&self, r: f64) -> f64 {
        self.b * self.b - self.a * (self.c - r * r)
    }

    /// The parameter of the line at a circle that it meets.
    fn t(&self, circle: DVec2) -> f64 {
        let steep = (circle.y - self.o.z) / self.d.z;
        let root = self.beyond(circle.x).max(0.0).sqrt();
        // Errors of the circle are divided by dz here, and there, where a line nearly touches it, by the root.
        if self.d.z.abs() * circle.x >= root {
            return steep;
        }
        let [near, far] = [-root, root].map(|root| (root - self.b) / self.a);
        if (near - steep).abs() < (far - steep).abs() {
            near
        } else {
            far
        }
    }
}

/// z(s) − oz − t dz of a line across the axis, t being the nearer or the farther place where it meets the circle's
/// cylinder, or comes closest to it.
struct Across<'a> {
    line: &'a Turned,
    piece: &'a Cubic,
    sign: f64,
}

impl Across<'_> {
    fn coordinate<N: Number>(&self, axis: usize, s: N) -> N {
        let [c0, c1, c2, c3] = self.piece.coordinate(axis).map(N::constant);
        let rest = N::constant(1.0).add(s.neg());
        let three = N::constant(3.0);
        let outer = rest.powi(3).mul(c0).add(s.powi(3).mul(c3));
        let inner = rest.mul(c1).add(s.mul(c2)).mul(three.mul(s.mul(rest)));
        outer.add(inner)
    }

    fn t<N: Number>(&self, s: N) -> N {
        let constant = N::constant;
        let Turned { a, b, c, .. } = *self.line;
        let r2 = self.coordinate(0, s).powi(2);
        let beyond = constant(b * b - a * c).add(r2.mul(constant(a)));
        let none = constant(0.0);
        let root = N::max_with(beyond, none, none, none).0.sqrt();
        root.mul(constant(self.sign))
            .add(constant(-b))
            .div(constant(a))
    }
}

impl OneParameter for Across<'_> {
    fn eval<N: Number>(&self, s: N) -> N {
        let up = self.t(s).mul(N::constant(self.line.d.z));
        let z = self.coordinate(1, s).add(N::constant(-self.line.o.z));
        z.add(up.neg())
    }
}

impl Revolution {
    /// Reads the profile, of r and z, `flip_normals` and `to_world`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Placed<Self>> {
        let profile = profile::from_params(params);
        let profile = profile.filter(|profile| {
            let fits = profile.bounds()[0].x >= 0.0;
            if !fits {
                let name = if params.has("profile") {
                    "profile"
                } else {
                    "x"
                };
                let message = format!(
                    "`{name}` of a `revolution` must not cross the axis: all r, those of \
                     inner points included, must be 0 or more"
                );
                params.error_at(name, message);
            }
            fits
        });
        Placed::from_params(params, profile.map(Self::new))
    }

    fn new(profile: Profile) -> Self {
        let [first, last] = profile.ends();
        let closed = profile.is_closed() || (first.x == 0.0 && last.x == 0.0);
        // ∮ r² dz, by the trapezoid rule: the solid's volume over π if the profile goes up outside.
        let points: Vec<DVec2> = profile.points(32).collect();
        let volume: f64 = (points.windows(2))
            .map(|pair| (pair[0].x.powi(2) + pair[1].x.powi(2)) * (pair[1].y - pair[0].y))
            .sum();
        let powers = profile.pieces().iter().map(|piece| {
            let [r, z] = [0, 1].map(|axis| piece.coordinate(axis));
            [
                bernstein::product(&r, &r),
                bernstein::product(&z, &z),
                bernstein::product(&z, &[1.0; 4]),
            ]
        });
        Self {
            powers: powers.collect(),
            areas: Lengths::new(profile.pieces(), |c| TAU * c.x),
            outward: if closed && volume < 0.0 { -1.0 } else { 1.0 },
            closed,
            profile,
        }
    }

    /// The surface at azimuth and place on a piece.
    fn point(&self, azimuth: f64, index: usize, s: f64) -> OwnPoint {
        let piece = &self.profile.pieces()[index];
        let (sin, cos) = sin_cos(azimuth);
        let (c, tangent) = (piece.at(s), piece.tangent(s));
        let around = |v: DVec2| DVec3::new(v.x * cos, v.x * sin, v.y);
        OwnPoint {
            position: around(c),
            normal: around(DVec2::new(tangent.y, -tangent.x)) * self.outward,
            uv: DVec2::new((azimuth / TAU).rem_euclid(1.0), self.profile.part(index, s)),
            dp_du: DVec3::new(-sin, cos, 0.0) * (TAU * c.x.max(1e-12)),
            dp_dv: around(tangent) * self.profile.pieces().len() as f64,
        }
    }

    /// The line from the point nearest to the middle, so that a far origin costs no digits; and where that is.
    fn turned(&self, line: &Line) -> (f64, Turned) {
        let [low, high] = self.profile.bounds();
        let middle = DVec3::new(0.0, 0.0, 0.5 * (low.y + high.y));
        let d = line.direction;
        let start = (middle - line.origin).dot(d) / d.length_squared();
        let o = line.at(start);
        let turned = Turned {
            o,
            d,
            a: d.truncate().length_squared(),
            b: o.truncate().dot(d.truncate()),
            c: o.truncate().length_squared(),
        };
        (start, turned)
    }

    /// Calls `visit` with every piece that a segment of a line may cross.
    fn reached(&self, line: &Turned, (from, to): (f64, f64), visit: impl FnMut(usize)) {
        let [low, high] = self.profile.bounds();
        let slack = 1e-9 * (high.x + high.y - low.y);
        // The ring that the segment lies in: heights, and squares of distances from the axis.
        let ends = [from, to].map(|t| t.clamp(-MOST, MOST));
        let distance = |t: f64| (line.a * t + 2.0 * line.b) * t + line.c;
        let nearest = if line.a > 0.0 {
            distance((-line.b / line.a).clamp(ends[0], ends[1].max(ends[0])))
        } else {
            line.c
        };
        let farthest = distance(ends[0]).max(distance(ends[1]));
        let heights = ends.map(|t| line.o.z + t * line.d.z);
        let [lowest, highest] = [heights[0].min(heights[1]), heights[0].max(heights[1])];
        let path = Line {
            origin: line.o,
            direction: line.d,
        };
        let inverse = line.d.recip();
        let meets = |[low, high]: [DVec2; 2]| {
            let (reach, hole) = (high.x + slack, (low.x - slack).max(0.0));
            if lowest > high.y + slack || highest < low.y - slack || farthest < hole * hole {
                return false;
            }
            let around = [
                DVec3::new(-reach, -reach, low.y - slack),
                DVec3::new(reach, reach, high.y + slack),
            ];
            nearest <= reach * reach && !path.misses_by(inverse, around, f64::NEG_INFINITY)
        };
        self.profile.search(meets, visit);
    }

    /// Calls `visit` with t and s of every crossing of a piece.
    fn crossings(&self, line: &Turned, index: usize, mut visit: impl FnMut(f64, f64)) {
        let piece = &self.profile.pieces()[index];
        let Turned { o, d, .. } = *line;
        if d.z * d.z > ACROSS * line.a {
            let [rr, zz, z] = &self.powers[index];
            let linear = 2.0 * (line.b * d.z - line.a * o.z);
            let constant = line.a * o.z * o.z + d.z * (line.c * d.z - 2.0 * line.b * o.z);
            let polynomial: [f64; 7] = core::array::from_fn(|k| {
                line.a * zz[k] + linear * z[k] + constant - d.z * d.z * rr[k]
            });
            bernstein::sign_changes(&polynomial, SMALLEST, |s, _| {
                visit(line.t(piece.at(s)), s);
                ControlFlow::<()>::Continue(())
            });
            return;
        }
        for sign in [-1.0, 1.0] {
            let across = Across { line, piece, sign };
            let nothing = |_: f64, _: f64| false;
            sign_changes(&across, (0.0, 1.0), 1e-5, nothing, |s, _| {
                let r = piece.at(s).x;
                if line.beyond(r) >= -1e-12 * line.b * line.b {
                    visit(across.t(s), s);
                }
                ControlFlow::<()>::Continue(())
            });
        }
    }
}

impl OwnShape for Revolution {
    fn next_crossing(&self, line: &Line, after: f64, before: f64) -> Option<Crossing> {
        let (start, turned) = self.turned(line);
        let margin = 1e-12 * start.abs();
        let [from, to] = [after - start - margin, before - start + margin];
        let mut reached = false;
        if self.closed && before.is_finite() {
            self.reached(&turned, (from, to), |_| reached = true);
            if !reached {
                return None;
            }
        }
        // A solid is entered and left by turns, so what lies behind counts.
        let from = if self.closed { f64::NEG_INFINITY } else { from };
        let mut nearest: Option<(f64, usize, f64)> = None;
        let mut passed = 0_u32;
        self.reached(&turned, (from, to), |index| {
            self.crossings(&turned, index, |t, s| {
                let t = start + t;
                if t <= after {
                    passed += 1;
                } else if nearest.is_none_or(|(best, ..)| t < best) {
                    nearest = Some((t, index, s));
                }
            });
        });
        let (t, index, s) = nearest?;
        let p = line.at(t);
        let point = self.point(atan2(p.y, p.x), index, s);
        let against = point.normal.dot(line.direction) < 0.0;
        let enters = if self.closed {
            passed.is_multiple_of(2)
        } else {
            against
        };
        Some(Crossing {
            uv: Profile::kept((index, s), enters != against),
            ..Crossing::new(t, enters)
        })
    }

    fn surface_at(&self, p: DVec3, crossing: &Crossing) -> OwnPoint {
        let (index, s, sign) = self.profile.place(crossing.uv);
        let point = self.point(atan2(p.y, p.x), index, s);
        OwnPoint {
            normal: point.normal * sign,
            ..point
        }
    }

    fn bounds(&self) -> [DVec3; 2] {
        let [low, high] = self.profile.bounds();
        [
            DVec3::new(-high.x, -high.x, low.y),
            DVec3::new(high.x, high.x, high.y),
        ]
    }

    fn is_closed(&self) -> bool {
        self.closed
    }

    fn charts(&self) -> usize {
        self.profile.pieces().len()
    }

    /// The chart of a piece: azimuth and place on it.
    fn charted(&self, piece: usize, uv: DVec2) -> Option<(OwnPoint, [DVec3; 2])> {
        let point = self.point(TAU * uv.x, piece, uv.y);
        let along = point.dp_dv / self.profile.pieces().len() as f64;
        Some((point, [point.dp_du, along]))
    }

    fn area(&self) -> Option<f64> {
        Some(self.areas.total())
    }

    fn sample_area(&self, u: Vec2) -> Option<OwnPoint> {
        let (index, s) = self.areas.sample(self.profile.pieces(), u.y.into());
        Some(self.point(TAU * f64::from(u.x), index, s))
    }
}
