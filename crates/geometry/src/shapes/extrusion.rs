//! `extrusion`: a curve (x(s), y(s)) along the z axis, from 0 to the height h, with flat ends if it is closed.
//!
//! The line o + t·d lies in the upright plane n·(p − o) = 0, n = (−dy, dx, 0), which the curve meets where the cubic
//! n·(c(s) − o) = 0; there t = ((c(s) − o)·(dx, dy)) / (dx² + dy²). Changes of sign are isolated in Bernstein form. A point
//! of an end is part of the solid by the even-odd rule, which also applies to curves that cross themselves.

use crate::shapes::analytic::crossing::{Crossing, Line};
use crate::shapes::analytic::placed::{OwnPoint, OwnShape, Placed};
use crate::shapes::profile::lengths::Lengths;
use crate::shapes::profile::{self, Profile};
use core::ops::ControlFlow;
use etalon_math::bernstein;
use etalon_params::Params;
use glam::{DVec2, DVec3, Vec2};

/// The faces: along the curve, below, above.
const SIDE: u32 = 0;
const BELOW: u32 = 1;
const ABOVE: u32 = 2;

/// A curve moved along an axis.
#[derive(Clone, Debug)]
pub struct Extrusion {
    profile: Profile,
    height: f64,
    /// Whether it has ends, and so bounds a solid.
    caps: bool,
    /// −1 if the profile's left side, seen along it, is outside.
    outward: f64,
    lengths: Lengths,
}

impl Extrusion {
    /// Reads the profile, of x and y, `height` (1), `caps` (true if the profile is closed), `flip_normals` and
    /// `to_world`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Placed<Self>> {
        let positive = |h: f64| h > 0.0 && h.is_finite();
        let height = params.float_where("height", 1.0, "a positive finite number", positive);
        let profile = profile::from_params(params);
        let closed = profile.as_ref().is_some_and(Profile::is_closed);
        let caps = params.boolean_or("caps", closed);
        let fits = profile.is_none() || closed || !caps;
        if !fits {
            params.error_at("caps", "only a closed profile has `caps`".to_owned());
        }
        let profile = profile.filter(|_| fits);
        Placed::from_params(
            params,
            profile.map(|profile| Self::new(profile, height, caps)),
        )
    }

    fn new(profile: Profile, height: f64, caps: bool) -> Self {
        // Twice the area that it goes around, against the clock.
        let points: Vec<DVec2> = profile.points(32).collect();
        let around: f64 = (points.windows(2))
            .map(|pair| pair[0].perp_dot(pair[1]))
            .sum();
        let clockwise = profile.is_closed() && around < 0.0;
        Self {
            lengths: Lengths::new(profile.pieces(), |_| 1.0),
            outward: if clockwise { -1.0 } else { 1.0 },
            profile,
            height,
            caps,
        }
    }

    fn side(&self, index: usize, s: f64, z: f64) -> OwnPoint {
        let piece = &self.profile.pieces()[index];
        let (c, tangent) = (piece.at(s), piece.tangent(s));
        let count = self.profile.pieces().len() as f64;
        OwnPoint {
            position: c.extend(z),
            normal: DVec3::new(tangent.y, -tangent.x, 0.0) * self.outward,
            uv: DVec2::new(self.profile.part(index, s), z / self.height),
            dp_du: tangent.extend(0.0) * count,
            dp_dv: DVec3::Z * self.height,
        }
    }

    /// Calls `visit` with t, the piece and s of every place where a line meets the endless surface; one along the
    /// z axis meets it nowhere.
    fn crossings(&self, line: &Line, mut visit: impl FnMut(f64, usize, f64)) {
        let flat = line.direction.truncate();
        let length = flat.length();
        if length == 0.0 {
            return;
        }
        let d = flat / length;
        let [low, high] = self.profile.bounds();
        // From the point nearest to the middle, so that a far origin costs no digits.
        let origin = line.origin.truncate();
        let start = (0.5 * (low + high) - origin).dot(d);
        let (o, n) = (origin + d * start, d.perp());
        let slack = 1e-9 * (high - low).max_element();
        let meets = |[low, high]: [DVec2; 2]| {
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            n.dot(middle - o).abs() <= n.abs().dot(half) + slack
        };
        self.profile.search(meets, |index| {
            let piece = &self.profile.pieces()[index];
            let across = piece.0.map(|c| n.dot(c - o));
            bernstein::sign_changes(&across, 1e-9, |s, _| {
                visit((start + d.dot(piece.at(s) - o)) / length, index, s);
                ControlFlow::<()>::Continue(())
            });
        });
    }

    /// Whether the profile goes around a point.
    fn surrounds(&self, p: DVec2) -> bool {
        let line = Line {
            origin: p.extend(0.0),
            direction: DVec3::X,
        };
        let mut inside = false;
        self.crossings(&line, |t, _, _| inside ^= t > 0.0);
        inside
    }
}

impl OwnShape for Extrusion {
    fn next_crossing(&self, line: &Line, after: f64, _: f64) -> Option<Crossing> {
        let (o, d) = (line.origin.z, line.direction.z);
        let mut ends = [-o / d, (self.height - o) / d];
        let mut faces = [BELOW, ABOVE];
        if d < 0.0 {
            ends.swap(0, 1);
            faces.swap(0, 1);
        }
        if d == 0.0 {
            if !(o >= 0.0 && o <= self.height) {
                return None;
            }
            ends = [f64::NEG_INFINITY, f64::INFINITY];
        }
        if ends[1] <= after {
            return None;
        }
        let from = after.max(ends[0]);
        let mut nearest: Option<(f64, usize, f64)> = None;
        let (mut passed, mut at_ends) = (0_u32, [0_u32; 2]);
        self.crossings(line, |t, index, s| {
            passed += u32::from(t <= from);
            for (count, end) in at_ends.iter_mut().zip(ends) {
                *count += u32::from(t <= end);
            }
            let within = t > from && t < ends[1];
            if within && nearest.is_none_or(|(best, ..)| t < best) {
                nearest = Some((t, index, s));
            }
        });
        let upright = line.direction.truncate() == DVec2::ZERO;
        let is_in = |count: u32| match upright {
            true => self.surrounds(line.origin.truncate()),
            false => count % 2 == 1,
        };
        let at_end = |end: usize| Crossing {
            face: faces[end],
            ..Crossing::new(ends[end], end == 0)
        };
        if self.caps && ends[0] > after && is_in(at_ends[0]) {
            return Some(at_end(0));
        }
        let Some((t, index, s)) = nearest else {
            let leaves = self.caps && ends[1].is_finite() && is_in(at_ends[1]);
            return leaves.then(|| at_end(1));
        };
        let against = self.side(index, s, 0.0).normal.dot(line.direction) < 0.0;
        let enters = if self.caps {
            passed.is_multiple_of(2)
        } else {
            against
        };
        Some(Crossing {
            face: SIDE,
            uv: Profile::kept((index, s), enters != against),
            ..Crossing::new(t, enters)
        })
    }

    fn surface_at(&self, p: DVec3, crossing: &Crossing) -> OwnPoint {
        if crossing.face == SIDE {
            let (index, s, sign) = self.profile.place(crossing.uv);
            let side = self.side(index, s, p.z.clamp(0.0, self.height));
            return OwnPoint {
                normal: side.normal * sign,
                ..side
            };
        }
        let [low, high] = self.profile.bounds();
        let size = high - low;
        let (z, up) = match crossing.face {
            BELOW => (0.0, -1.0),
            _ => (self.height, 1.0),
        };
        OwnPoint {
            position: p.truncate().extend(z),
            normal: DVec3::Z * up,
            uv: (p.truncate() - low) / size,
            dp_du: DVec3::X * size.x,
            dp_dv: DVec3::Y * size.y,
        }
    }

    fn bounds(&self) -> [DVec3; 2] {
        let [low, high] = self.profile.bounds();
        [low.extend(0.0), high.extend(self.height)]
    }

    fn is_closed(&self) -> bool {
        self.caps
    }

    fn faces(&self) -> u32 {
        3
    }

    /// None of ends.
    fn charts(&self) -> usize {
        if self.caps {
            0
        } else {
            self.profile.pieces().len()
        }
    }

    /// The chart of a piece: place on it and height.
    fn charted(&self, piece: usize, uv: DVec2) -> Option<(OwnPoint, [DVec3; 2])> {
        let point = self.side(piece, uv.x, uv.y * self.height);
        let along = point.dp_du / self.profile.pieces().len() as f64;
        Some((point, [along, point.dp_dv]))
    }

    /// Without ends: points of those are not sampled.
    fn area(&self) -> Option<f64> {
        (!self.caps).then(|| self.lengths.total() * self.height)
    }

    fn sample_area(&self, u: Vec2) -> Option<OwnPoint> {
        let (index, s) = (self.lengths).sample(self.profile.pieces(), u.x.into());
        (!self.caps).then(|| self.side(index, s, f64::from(u.y) * self.height))
    }
}
