//! The disk x² + y² ≤ 1, z = 0, under any affine map (an ellipse in the world).
//!
//! ```text
//! p(u, v) = c + u (a cos 2πv + b sin 2πv)
//! ```
//!
//! with c, a, b the images of the origin and of the x and y axes.

use crate::local_interaction::LocalInteraction;
use crate::placement::Placement;
use crate::shapes::analytic::crossing::{Crossing, Line};
use crate::shapes::shape_model::{ShapeModel, read_flip};

use core::f64::consts::{PI, TAU};
use etalon_math::{DirectionCone, float64};
use etalon_params::Params;
use etalon_sampling::warps::square_to_concentric_disk;
use etalon_transport::SurfacePoint;
use glam::{DVec2, DVec3, Vec2};

/// A disk.
#[derive(Clone, Copy, Debug)]
pub struct Disk {
    center: DVec3,
    a: DVec3,
    b: DVec3,
    /// Unit normal of the image of +z.
    normal: DVec3,
    /// Vectors whose dot products with p − c are p's coordinates along a and b.
    dual: [DVec3; 2],
    area: f64,
    inward: bool,
}

impl Disk {
    /// The image of the unit disk under `placement`. `None` if it is not finite.
    pub fn new(placement: &Placement, flip: bool) -> Option<Self> {
        let (a, b) = (placement.vector(DVec3::X), placement.vector(DVec3::Y));
        let cross = a.cross(b);
        let normal = placement.normal(DVec3::Z).normalize();
        let disk = Self {
            center: placement.point(DVec3::ZERO),
            a,
            b,
            normal,
            dual: [b.cross(cross), cross.cross(a)].map(|v| v / cross.length_squared()),
            area: PI * cross.length(),
            inward: flip,
        };
        let finite = disk.dual.iter().all(|v| v.is_finite()) && disk.center.is_finite();
        (finite && normal.is_finite() && disk.area > 0.0).then_some(disk)
    }

    /// Reads `flip_normals` and `to_world`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Self> {
        let placement = Placement::from_params(params);
        let flip = read_flip(params);
        let disk = Self::new(&placement?, flip);
        if disk.is_none() {
            params.error_at(
                "to_world",
                "`to_world` takes the `disk` out of the range of numbers",
            );
        }
        disk
    }

    fn coordinates(&self, p: DVec3) -> DVec2 {
        let p = p - self.center;
        DVec2::new(self.dual[0].dot(p), self.dual[1].dot(p))
    }

    /// The point with coordinates `xy` in the shape's own plane.
    fn surface(&self, xy: DVec2) -> LocalInteraction {
        let r = xy.length();
        let (cos, sin) = if r > 0.0 {
            (xy.x / r, xy.y / r)
        } else {
            (1.0, 0.0)
        };
        let phi = float64::atan2(sin, cos);
        let v = if phi < 0.0 {
            phi / TAU + 1.0
        } else {
            phi / TAU
        };
        LocalInteraction::exact(
            self.center + self.a * xy.x + self.b * xy.y,
            self.normal,
            DVec2::new(r, v).as_vec2(),
            self.a * cos + self.b * sin,
            (self.b * xy.x - self.a * xy.y) * TAU,
        )
        .flipped_if(self.inward)
    }
}

impl ShapeModel for Disk {
    #[inline]
    fn both_crossings(&self, line: &Line) -> Option<[f64; 2]> {
        Some(self.crossings(line))
    }

    fn surface_at(&self, _: u32, p: DVec3, _: &Crossing) -> Option<LocalInteraction> {
        Some(self.surface(self.coordinates(p)))
    }

    fn parametric(&self, uv: DVec2) -> Option<LocalInteraction> {
        let (sin, cos) = float64::sin_cos(TAU * uv.y);
        Some(self.surface(DVec2::new(cos, sin) * uv.x))
    }

    fn piece_bounds(&self, _: u32) -> [DVec3; 2] {
        let square = |v: DVec3| v * v;
        let squared = square(self.a) + square(self.b);
        let reach = DVec3::new(squared.x.sqrt(), squared.y.sqrt(), squared.z.sqrt());
        [self.center - reach, self.center + reach]
    }

    fn normals(&self) -> DirectionCone {
        DirectionCone::along(if self.inward {
            -self.normal
        } else {
            self.normal
        })
    }

    fn area(&self) -> Option<f64> {
        Some(self.area)
    }

    fn sample_area(&self, u: Vec2) -> Option<SurfacePoint> {
        Some(
            self.surface(square_to_concentric_disk(u).as_dvec2())
                .whole(),
        )
    }
}

impl Disk {
    /// The parameters of up to two crossings with a line, in ascending order; NaN where there is none.
    fn crossings(&self, line: &Line) -> [f64; 2] {
        let Line { origin, direction } = *line;
        let t = self.normal.dot(self.center - origin) / self.normal.dot(direction);
        let inside = self.coordinates(origin + direction * t).length_squared() <= 1.0;
        [if inside { t } else { f64::NAN }, f64::NAN]
    }
}
