//! `cone`: a solid cone or truncated cone around the z axis from z = 0 (radius r₀) to z = 1 (radius r₁), with its
//! flat ends.
//!
//! ```text
//! x² + y² ≤ (r₀ + (r₁ − r₀) z)²,   0 ≤ z ≤ 1
//! ```
//!
//! It is convex, so a line is inside of it on one interval: that of the slab, cut by the double cone's.

use crate::placement::Placement;
use crate::shapes::analytic::crossing::{Crossing, Line};
use crate::shapes::analytic::placed::{OwnPoint, OwnShape, Placed};
use core::f64::consts::{PI, TAU};
use etalon_math::Frame;
use etalon_math::float64::{atan2, sin_cos};
use etalon_math::polynomial::quadratic;
use etalon_params::Params;
use glam::{DAffine3, DMat3, DVec2, DVec3, Vec2};

/// A truncated cone.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    /// r₀.
    bottom: f64,
    /// r₁ − r₀.
    slope: f64,
}

/// The faces.
const SIDE: u32 = 0;
const BOTTOM: u32 = 1;
const TOP: u32 = 2;

impl Cone {
    /// Reads `p0`, `p1`, `radius0`, `radius1`, `flip_normals` and `to_world`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Placed<Self>> {
        let what = "a finite number not below 0";
        let radius =
            |name, default| params.float_where(name, default, what, |r| r >= 0.0 && r.is_finite());
        let (bottom, top) = (radius("radius0", 1.0), radius("radius1", 0.0));
        let ends = [
            params.vector("p0").unwrap_or(DVec3::ZERO),
            params.vector("p1").unwrap_or(DVec3::Z),
        ];
        let placement = Placement::from_params(params);
        let flip = crate::shapes::shape_model::read_flip(params);
        let axis = ends[1] - ends[0];
        let Some(z) = axis.try_normalize() else {
            params.error_at("p1", "the ends `p0` and `p1` of a `cone` must differ");
            return None;
        };
        if bottom == 0.0 && top == 0.0 {
            params.error_at("radius1", "one of the radii of a `cone` must be above 0");
            return None;
        }
        // The frame in single precision is made exactly perpendicular in double precision.
        let near_x = Frame::from_normal(z.as_vec3()).s.as_dvec3();
        let x = (near_x - z * z.dot(near_x)).normalize();
        let own = DAffine3 {
            matrix3: DMat3::from_cols(x, z.cross(x), axis),
            translation: ends[0],
        };
        let cone = Self {
            bottom,
            slope: top - bottom,
        };
        Some(Placed::new(
            placement?.after(&etalon_math::FromAffine::from_affine(&own)),
            cone,
            flip,
        ))
    }

    fn radius(&self, z: f64) -> f64 {
        self.bottom + self.slope * z
    }

    /// The interval of a line inside: parameters and faces.
    fn interval(&self, line: &Line) -> Option<[(f64, u32); 2]> {
        let Line {
            origin: o,
            direction: d,
        } = *line;
        let (mut first, mut last) = if d.z == 0.0 {
            if !(o.z > 0.0 && o.z < 1.0) {
                return None;
            }
            ((f64::NEG_INFINITY, BOTTOM), (f64::INFINITY, TOP))
        } else {
            let (bottom, top) = ((-o.z / d.z, BOTTOM), ((1.0 - o.z) / d.z, TOP));
            if d.z > 0.0 {
                (bottom, top)
            } else {
                (top, bottom)
            }
        };
        // |xy|² − r(z)² along the line, from the point nearest to the axis for the sake of precision.
        let a = d.truncate().length_squared() - self.slope * self.slope * d.z * d.z;
        let r = self.radius(o.z);
        let b = 2.0 * (o.truncate().dot(d.truncate()) - r * self.slope * d.z);
        let c = o.truncate().length_squared() - r * r;
        match quadratic(a, b, c) {
            None => {
                if c > 0.0 || a > 0.0 {
                    return None;
                }
            }
            // One interval between the roots, …
            Some((t0, t1)) if a > 0.0 => {
                if t0 > first.0 {
                    first = (t0, SIDE);
                }
                if t1 < last.0 {
                    last = (t1, SIDE);
                }
            }
            // … or outside of them, of which one part lies in the slab; a linear equation has one root.
            Some((t0, t1)) => {
                let in_slab = |t: f64| t > first.0 && t < last.0;
                let linear = a == 0.0;
                if in_slab(t0) && (!linear || b > 0.0) {
                    last = (t0, SIDE);
                } else if in_slab(t1) && (!linear || b < 0.0) {
                    first = (t1, SIDE);
                } else {
                    let middle = 0.5 * (first.0.max(-1e300) + last.0.min(1e300));
                    let inside = (a * middle + b) * middle + c <= 0.0;
                    if !inside {
                        return None;
                    }
                }
            }
        }
        (first.0 < last.0 && first.0.is_finite() && last.0.is_finite()).then_some([first, last])
    }

    /// The point of a face at `(x, y)` or, of the side, at the direction (x, y) from the axis and the height z.
    fn point(&self, face: u32, at: DVec3) -> OwnPoint {
        let across = at.truncate();
        let azimuth = atan2(across.y, across.x);
        let u = (azimuth / TAU).rem_euclid(1.0);
        let (sin, cos) = sin_cos(azimuth);
        let around = DVec3::new(-sin, cos, 0.0) * TAU;
        if face == SIDE {
            let z = at.z.clamp(0.0, 1.0);
            let radius = self.radius(z);
            return OwnPoint {
                position: DVec3::new(radius * cos, radius * sin, z),
                normal: DVec3::new(cos, sin, -self.slope),
                uv: DVec2::new(u, z),
                dp_du: around * radius.max(1e-12),
                dp_dv: DVec3::new(self.slope * cos, self.slope * sin, 1.0),
            };
        }
        let (z, up) = if face == TOP { (1.0, 1.0) } else { (0.0, -1.0) };
        let radius = across.length();
        let edge = self.radius(z).max(f64::MIN_POSITIVE);
        OwnPoint {
            position: across.extend(z),
            normal: DVec3::Z * up,
            uv: DVec2::new(u, radius / edge),
            dp_du: around * radius.max(1e-12),
            dp_dv: DVec3::new(cos, sin, 0.0) * edge,
        }
    }

    /// The areas of the faces, for a height of 1.
    fn areas(&self) -> [f64; 3] {
        let (r0, r1) = (self.bottom, self.bottom + self.slope);
        let slant = (1.0 + self.slope * self.slope).sqrt();
        [PI * (r0 + r1) * slant, PI * r0 * r0, PI * r1 * r1]
    }
}

impl OwnShape for Cone {
    fn next_crossing(&self, line: &Line, after: f64, _: f64) -> Option<Crossing> {
        let [(first, entered), (last, left)] = self.interval(line)?;
        let face = if first > after { entered } else { left };
        Some(Crossing {
            face,
            ..Crossing::of_convex([first, last], after)?
        })
    }

    fn surface_at(&self, p: DVec3, crossing: &Crossing) -> OwnPoint {
        self.point(crossing.face, p)
    }

    fn bounds(&self) -> [DVec3; 2] {
        let reach = self.bottom.max(self.bottom + self.slope);
        [
            DVec3::new(-reach, -reach, 0.0),
            DVec3::new(reach, reach, 1.0),
        ]
    }

    fn faces(&self) -> u32 {
        3
    }

    fn is_convex(&self) -> bool {
        true
    }

    fn charts(&self) -> usize {
        self.areas().len()
    }

    /// The chart of a face is that of its texture coordinates.
    fn charted(&self, face: usize, uv: DVec2) -> Option<(OwnPoint, [DVec3; 2])> {
        let face = face as u32;
        let radius = match face {
            SIDE => self.radius(uv.y),
            BOTTOM => self.radius(0.0) * uv.y,
            _ => self.radius(1.0) * uv.y,
        };
        let (sin, cos) = sin_cos(TAU * uv.x);
        let point = self.point(face, DVec3::new(radius * cos, radius * sin, uv.y));
        Some((point, [point.dp_du, point.dp_dv]))
    }

    fn area(&self) -> Option<f64> {
        Some(self.areas().iter().sum())
    }

    fn sample_area(&self, u: Vec2) -> Option<OwnPoint> {
        let areas = self.areas();
        let total: f64 = areas.iter().sum();
        let mut rest = f64::from(u.x) * total;
        let (sin, cos) = sin_cos(TAU * f64::from(u.y));
        for (face, area) in [(BOTTOM, areas[1]), (TOP, areas[2])] {
            if rest < area {
                let edge = self.radius(if face == TOP { 1.0 } else { 0.0 });
                let radius = edge * (rest / area).sqrt();
                return Some(self.point(face, DVec3::new(radius * cos, radius * sin, 0.0)));
            }
            rest -= area;
        }
        // The radius grows linearly with the height: ∫ r dz = x (r₀² … r₁²).
        let x = (rest / areas[0]).min(1.0);
        let (r0, r1) = (self.bottom, self.bottom + self.slope);
        let radius = (r0 * r0 + x * (r1 * r1 - r0 * r0)).sqrt();
        let z = if self.slope.abs() > 1e-9 * r0.max(r1) {
            (radius - r0) / self.slope
        } else {
            x
        };
        Some(self.point(SIDE, DVec3::new(cos, sin, z)))
    }
}
