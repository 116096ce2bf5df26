//! The open cylinder of radius R around the segment from p₀ to p₁.
//!
//! ```text
//! p(u, v) = p₀ + R (x̂ cos 2πu + ŷ sin 2πu) + v (p₁ − p₀)
//! ```
//!
//! x̂ and ŷ are the frame that [`Frame::from_normal`](etalon_math::Frame::from_normal) builds
//! around the axis, carried along by `to_world`.

use crate::local_interaction::LocalInteraction;
use crate::placement::{Placement, perpendicular};
use crate::shapes::analytic::crossing::{Crossing, Line};
use crate::shapes::shape_model::{ShapeModel, read_flip};

use core::f64::consts::TAU;
use etalon_math::{Frame, float64};
use etalon_params::Params;
use etalon_transport::SurfacePoint;
use glam::{DVec2, DVec3, Vec2};

/// An open cylinder.
#[derive(Clone, Copy, Debug)]
pub struct Cylinder {
    start: DVec3,
    /// Unit vectors across and along the axis.
    x: DVec3,
    y: DVec3,
    z: DVec3,
    radius: f64,
    length: f64,
    inward: bool,
}

impl Cylinder {
    /// The image under `placement` of the cylinder of radius `radius` > 0 (m) from `p0` to `p1`.
    /// `None` if the ends coincide or the image is not a right circular cylinder.
    pub fn new(placement: &Placement, ends: [DVec3; 2], radius: f64, flip: bool) -> Option<Self> {
        let axis = ends[1] - ends[0];
        let frame = Frame::from_normal(axis.try_normalize()?.as_vec3());
        // The frame in single precision is made exactly perpendicular in double precision.
        let z = axis.normalize();
        let x = (frame.s.as_dvec3() - z * z.dot(frame.s.as_dvec3())).normalize();
        let y = z.cross(x);
        let [x, y, z] = [x * radius, y * radius, axis].map(|v| placement.vector(v));
        let round =
            perpendicular(x, y, true) && perpendicular(y, z, false) && perpendicular(z, x, false);
        let cylinder = Self {
            start: placement.point(ends[0]),
            x: x.normalize(),
            y: y.normalize(),
            z: z.normalize(),
            radius: 0.5 * (x.length() + y.length()),
            length: z.length(),
            inward: flip,
        };
        let finite = cylinder.start.is_finite() && cylinder.radius.is_finite();
        (round && finite && cylinder.radius > 0.0 && cylinder.length.is_finite())
            .then_some(cylinder)
    }

    /// Reads `p0`, `p1`, `radius`, `flip_normals` and `to_world`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Self> {
        let placement = Placement::from_params(params);
        let ends = [
            params.vector("p0").unwrap_or(DVec3::ZERO),
            params.vector("p1").unwrap_or(DVec3::Z),
        ];
        let radius = params.float_where("radius", 1.0, "a positive finite number", |r| {
            r.is_finite() && r > 0.0
        });
        let flip = read_flip(params);
        if ends[0] == ends[1] {
            params.error_at("p1", "the ends `p0` and `p1` of a `cylinder` must differ");
            return None;
        }
        let cylinder = Self::new(&placement?, ends, radius, flip);
        if cylinder.is_none() {
            params.error_with_help(
                "to_world",
                "a `cylinder` must stay a right circular one: `to_world` shears it or scales it \
                 differently in different directions across its axis",
                "a `cone` with equal radii is a cylinder that may be scaled and sheared; it has ends",
            );
        }
        cylinder
    }

    /// The point at the direction `across` (unit) from the axis, at the fraction `v` along it.
    fn surface(&self, across: DVec2, v: f64) -> LocalInteraction {
        let phi = float64::atan2(across.y, across.x);
        let u = if phi < 0.0 {
            phi / TAU + 1.0
        } else {
            phi / TAU
        };
        let normal = self.x * across.x + self.y * across.y;
        let along = self.z * self.length;
        LocalInteraction::exact(
            self.start + normal * self.radius + along * v,
            normal,
            DVec2::new(u, v).as_vec2(),
            (self.y * across.x - self.x * across.y) * (TAU * self.radius),
            along,
        )
        .flipped_if(self.inward)
    }

    fn local(&self, v: DVec3) -> DVec3 {
        DVec3::new(self.x.dot(v), self.y.dot(v), self.z.dot(v))
    }
}

impl ShapeModel for Cylinder {
    #[inline]
    fn both_crossings(&self, line: &Line) -> Option<[f64; 2]> {
        Some(self.crossings(line))
    }

    fn surface_at(&self, _: u32, p: DVec3, _: &Crossing) -> Option<LocalInteraction> {
        let local = self.local(p - self.start);
        let across = local.truncate().try_normalize().unwrap_or(DVec2::X);
        Some(self.surface(across, (local.z / self.length).clamp(0.0, 1.0)))
    }

    fn parametric(&self, uv: DVec2) -> Option<LocalInteraction> {
        let (sin, cos) = float64::sin_cos(TAU * uv.x);
        Some(self.surface(DVec2::new(cos, sin), uv.y))
    }

    fn piece_bounds(&self, _: u32) -> [DVec3; 2] {
        let end = self.start + self.z * self.length;
        // Half-widths of a disk: R √(1 − ẑᵢ²), here from the other two axes.
        let reach = DVec3::new(
            DVec2::new(self.x.x, self.y.x).length(),
            DVec2::new(self.x.y, self.y.y).length(),
            DVec2::new(self.x.z, self.y.z).length(),
        ) * self.radius;
        [self.start.min(end) - reach, self.start.max(end) + reach]
    }

    fn area(&self) -> Option<f64> {
        Some(TAU * self.radius * self.length)
    }

    fn sample_area(&self, u: Vec2) -> Option<SurfacePoint> {
        let (sin, cos) = etalon_math::float::sin_cos_turns(u.x);
        let across = DVec2::new(cos.into(), sin.into()).normalize();
        Some(self.surface(across, u.y.into()).whole())
    }
}

impl Cylinder {
    /// The parameters of up to two crossings with a line, in ascending order; NaN where there is none.
    fn crossings(&self, line: &Line) -> [f64; 2] {
        let Line { origin, direction } = *line;
        let o = self.local(origin - self.start);
        let d = self.local(direction);
        let (across, slope) = (o.truncate(), d.truncate());
        let a = slope.length_squared();
        let b = across.dot(slope);
        let closest = across - slope * (b / a);
        let disc = self.radius * self.radius - closest.length_squared();
        // Also false for a ray along the axis, where a = 0 makes `closest` NaN.
        if !(disc >= 0.0) {
            return [f64::NAN; 2];
        }
        let q = -(b + (a * disc).sqrt().copysign(b));
        let distance = across.length();
        let c = (distance - self.radius) * (distance + self.radius);
        let (t0, t1) = (c / q, q / a);
        let within = |t: f64| {
            let z = o.z + d.z * t;
            if z >= 0.0 && z <= self.length {
                t
            } else {
                f64::NAN
            }
        };
        if t0 <= t1 {
            [within(t0), within(t1)]
        } else {
            [within(t1), within(t0)]
        }
    }
}
