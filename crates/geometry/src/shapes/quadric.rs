//! `quadric`: the surface of second degree
//!
//! ```text
//! A x² + B y² + C z² + D xy + E xz + F yz + G x + H y + I z + J = 0
//! ```
//!
//! in a box: ellipsoids, paraboloids, hyperboloids, cones, cylinders. It is the boundary of where the left side is
//! negative, cut by the box: the solid has the box's faces where it is cut. `ellipsoid` is the one with
//! x² + y² + z² = 1, in its smallest box.

use crate::shapes::analytic::clip_box::{CURVED, ClipBox, FACES};
use crate::shapes::analytic::crossing::{Crossing, Line};
use crate::shapes::analytic::placed::{OwnPoint, OwnShape, Placed};
use core::f64::consts::{PI, TAU};
use etalon_math::float64::sin_cos;
use etalon_math::polynomial::quadratic;
use etalon_params::Params;
use glam::{DMat3, DVec2, DVec3};

/// A quadric in a box.
#[derive(Clone, Copy, Debug)]
pub struct Quadric {
    /// The symmetric matrix of the second-degree terms.
    matrix: DMat3,
    linear: DVec3,
    constant: f64,
    clip: ClipBox,
    /// Centre and radii of an `ellipsoid`.
    ellipsoid: Option<[DVec3; 2]>,
}

impl Quadric {
    /// Reads `squares` (A, B, C), `products` (D, E, F), `linear` (G, H, I), `constant` (J), the corners `min` and
    /// `max` of the box, `flip_normals` and `to_world`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Placed<Self>> {
        let vector = |name, default| params.vector(name).unwrap_or(default);
        let squares = vector("squares", DVec3::ONE);
        let DVec3 { x: d, y: e, z: f } = vector("products", DVec3::ZERO) * 0.5;
        let linear = vector("linear", DVec3::ZERO);
        let constant = params.float_or("constant", -1.0);
        let matrix = DMat3::from_cols(
            DVec3::new(squares.x, d, e),
            DVec3::new(d, squares.y, f),
            DVec3::new(e, f, squares.z),
        );
        let quadric = ClipBox::from_params(params).map(|clip| Self {
            matrix,
            linear,
            constant,
            clip,
            ellipsoid: None,
        });
        let finite = matrix.is_finite() && linear.is_finite() && constant.is_finite();
        if !finite || (matrix == DMat3::ZERO && linear == DVec3::ZERO) {
            params.error("the coefficients of a `quadric` must be finite, and not all of them 0");
        }
        Placed::from_params(params, quadric)
    }

    /// Reads `center`, `radii` (a vector), `flip_normals` and `to_world`.
    pub(crate) fn ellipsoid(params: &Params<'_>) -> Option<Placed<Self>> {
        let center = params.vector("center").unwrap_or(DVec3::ZERO);
        let radii = params.vector("radii").unwrap_or(DVec3::ONE);
        if !(radii.cmpgt(DVec3::ZERO).all() && radii.is_finite() && center.is_finite()) {
            params.error_at(
                "radii",
                "the `radii` of an `ellipsoid` must be positive and finite",
            );
            return Placed::from_params(params, None);
        }
        let squares = (radii * radii).recip();
        let ellipsoid = Self {
            matrix: DMat3::from_diagonal(squares),
            linear: -2.0 * squares * center,
            constant: (squares * center * center).element_sum() - 1.0,
            clip: ClipBox {
                low: center - radii * (1.0 + 1e-9),
                high: center + radii * (1.0 + 1e-9),
            },
            ellipsoid: Some([center, radii]),
        };
        Placed::from_params(params, Some(ellipsoid))
    }

    fn gradient(&self, p: DVec3) -> DVec3 {
        self.matrix * p * 2.0 + self.linear
    }

    fn value(&self, p: DVec3) -> f64 {
        p.dot(self.matrix * p) + self.linear.dot(p) + self.constant
    }
}

impl OwnShape for Quadric {
    fn next_crossing(&self, line: &Line, after: f64, _: f64) -> Option<Crossing> {
        let [first, last] = self.clip.cut(line)?;
        // From the middle of the box, so that far origins lose nothing.
        let middle = 0.5 * (first.0 + last.0);
        let (o, d) = (line.at(middle), line.direction);
        let a = d.dot(self.matrix * d);
        let b = 2.0 * o.dot(self.matrix * d) + self.linear.dot(d);
        let roots = quadratic(a, b, self.value(o));
        let inside_at = |t: f64| self.value(line.at(t)) <= 0.0;
        let enters_at = |t: f64| self.gradient(line.at(t)).dot(d) < 0.0;
        let mut crossings = [None; 4];
        if inside_at(first.0) {
            crossings[0] = Some((first.0, true, first.1));
        }
        let within = |t: f64| t > first.0 && t < last.0;
        if let Some((t0, t1)) = roots {
            let (t0, t1) = (t0 + middle, t1 + middle);
            if within(t0) && t0 < t1 || (t0 == t1 && a == 0.0 && within(t0)) {
                crossings[1] = Some((t0, enters_at(t0), CURVED));
            }
            if within(t1) && t0 < t1 {
                crossings[2] = Some((t1, enters_at(t1), CURVED));
            }
        }
        if inside_at(last.0) {
            crossings[3] = Some((last.0, false, last.1));
        }
        let (t, enters, face) = crossings.into_iter().flatten().find(|c| c.0 > after)?;
        Some(Crossing {
            face,
            ..Crossing::new(t, enters)
        })
    }

    fn surface_at(&self, p: DVec3, crossing: &Crossing) -> OwnPoint {
        if let Some(point) = self.clip.face(crossing.face, p) {
            return point;
        }
        let mut position = p;
        // One step of Newton's method brings it onto the surface.
        let gradient = self.gradient(position);
        let squared = gradient.length_squared();
        if squared > 0.0 {
            position -= gradient * (self.value(position) / squared);
        }
        let normal = self.gradient(position).try_normalize().unwrap_or(DVec3::Z);
        self.clip.curved(position, normal)
    }

    fn charts(&self) -> usize {
        usize::from(self.ellipsoid.is_some())
    }

    /// Azimuth and polar angle of the unit sphere, stretched.
    fn charted(&self, _chart: usize, uv: DVec2) -> Option<(OwnPoint, [DVec3; 2])> {
        let [center, radii] = self.ellipsoid?;
        let ((sin_u, cos_u), (sin_v, cos_v)) = (sin_cos(TAU * uv.x), sin_cos(PI * uv.y));
        let n = DVec3::new(sin_v * cos_u, sin_v * sin_u, cos_v);
        let position = center + radii * n;
        let normal = self.gradient(position).try_normalize()?;
        let around = DVec3::new(-sin_v * sin_u, sin_v * cos_u, 0.0) * TAU;
        let down = DVec3::new(cos_v * cos_u, cos_v * sin_u, -sin_v) * PI;
        Some((
            self.clip.curved(position, normal),
            [radii * around, radii * down],
        ))
    }

    fn faces(&self) -> u32 {
        FACES
    }

    fn bounds(&self) -> [DVec3; 2] {
        [self.clip.low, self.clip.high]
    }
}
