//! The sphere |p − c| = R.
//!
//! ```text
//! p(u, v) = c + R (cos 2πu sin πv, sin 2πu sin πv, cos πv)       in the shape's own axes
//! ```
//!
//! Intersection solves the quadratic in double precision, with the discriminant taken from the
//! ray's closest approach and the product of the roots from (|o − c| − R)(|o − c| + R), which
//! loses nothing for far origins or for origins on the surface.

use crate::local_interaction::LocalInteraction;
use crate::placement::{Placement, perpendicular};
use crate::shapes::analytic::crossing::{Crossing, Line};
use crate::shapes::shape_model::{ShapeModel, area_density_toward, read_flip};
use core::f32::consts::FRAC_1_PI;
use core::f64::consts::{PI, TAU};
use etalon_math::lane::{self, Lane, Mask, Select, Vector, per_lane};
use etalon_math::{float64, gamma};
use etalon_params::Params;
use etalon_sampling::warps::{SphereCone, square_to_uniform_sphere};
use etalon_transport::{LanePoint, LaneReceiver, LightSampleContext, SampledPoint, SurfacePoint};
use glam::{DMat3, DVec2, DVec3, Vec2, Vec3};

/// A sphere.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    center: DVec3,
    radius: f64,
    /// The shape's own axes in the world; left-handed if mirrored.
    axes: DMat3,
    inward: bool,
}

/// How far rounding moves a point of a sphere off it, relative to its coordinates: a few roundings
/// of single precision.
const ROUNDING: f32 = 4.0 * f32::EPSILON;

/// The cones in which observers outside see spheres. A point of the sphere itself, which rounding puts on either side, sees it from
/// inside if at all.
#[inline(always)]
fn cone<F: Lane>(center: F::Vector, radius: F, from: F::Vector) -> SphereCone<F> {
    let center = center - from;
    let [x, y, z] = from.magnitudes().xyz();
    let rounding = (x.max(y).max(z) + radius) * ROUNDING;
    let mut cone = SphereCone::new(center, radius);
    cone.exists = cone.exists & center.norm().gt(rounding + radius);
    cone
}

impl Sphere {
    /// The image under `placement` of the sphere around `center` with radius `radius` ≠ 0 (m). As
    /// in Mitsuba, a map that mirrors turns the sphere inside out; so do a negative radius (which
    /// mirrors) and `flip`, and two of them cancel. `None` if the image is not a sphere.
    pub fn new(placement: &Placement, center: DVec3, radius: f64, flip: bool) -> Option<Self> {
        let m = placement.linear() * radius;
        let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
        let round =
            perpendicular(x, y, true) && perpendicular(y, z, true) && perpendicular(z, x, true);
        let scale = (x.length() + y.length() + z.length()) / 3.0;
        let sphere = Self {
            center: placement.point(center),
            radius: scale,
            axes: DMat3::from_cols(x.normalize(), y.normalize(), z.normalize()),
            inward: flip != (m.determinant() < 0.0),
        };
        (round && scale > 0.0 && scale.is_finite() && sphere.center.is_finite()).then_some(sphere)
    }

    /// Reads `center`, `radius`, `flip_normals` and `to_world`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Self> {
        let placement = Placement::from_params(params);
        let center = params.vector("center").unwrap_or(DVec3::ZERO);
        let radius = params.float_where("radius", 1.0, "a positive finite number", |r| {
            r.is_finite() && r > 0.0
        });
        let flip = read_flip(params);
        let sphere = Self::new(&placement?, center, radius, flip);
        if sphere.is_none() {
            params.error_with_help(
                "to_world",
                "a `sphere` must stay round: `to_world` scales it differently in different directions",
                "an `ellipsoid` has three `radii`, and may be scaled and sheared",
            );
        }
        sphere
    }

    /// The point where a line crosses it near the parameter `t`.
    #[inline(always)] // So that nothing is computed that the caller does not need.
    pub(crate) fn surface_near(&self, line: &Line, t: f64) -> LocalInteraction {
        let crossing = Crossing::nearest_of_convex(self.crossings(line), t);
        self.surface_toward(line.at(crossing.t))
    }

    /// The point toward `p` from the centre.
    #[inline(always)] // As above.
    fn surface_toward(&self, p: DVec3) -> LocalInteraction {
        let normal = (p - self.center).try_normalize();
        self.surface(normal.unwrap_or(self.axes.z_axis))
    }

    /// The point in the direction `normal` (unit) from the centre.
    #[inline(always)] // As above.
    fn surface(&self, normal: DVec3) -> LocalInteraction {
        let (uv, [dp_du, dp_dv]) = coordinates(self.axes.transpose() * normal);
        LocalInteraction::exact(
            self.center + normal * self.radius,
            normal,
            uv,
            self.axes * dp_du * self.radius,
            self.axes * dp_dv * self.radius,
        )
        .flipped_if(self.inward)
    }

    /// The cone in which an observer outside sees it.
    #[inline]
    fn cone(&self, from: Vec3) -> SphereCone {
        let (center, radius, _) = Self::in_lanes::<f32>(|_| self);
        cone::<f32>(center, radius, from)
    }

    /// The centre, the radius and whether the outside is within, of `sphere(i)` in lane i.
    #[inline(always)]
    fn in_lanes<'s, F: Lane>(sphere: impl Fn(usize) -> &'s Self) -> (F::Vector, F, F::Mask) {
        let [x, y, z, radius, inward, ..] = F::columns(|i| {
            let sphere = sphere(i);
            let [x, y, z] = sphere.center.as_vec3().to_array();
            let inward = f32::from(u8::from(sphere.inward));
            [x, y, z, sphere.radius as f32, inward, 0.0, 0.0, 0.0]
        });
        (F::Vector::from_xyz(x, y, z), radius, inward.gt(F::ZERO))
    }

    /// Points of `sphere(i)` in lane i, chosen for a receiver: by solid angle from outside, by area from inside.
    #[inline(always)]
    pub(super) fn points_toward<'s, F: Lane>(
        sphere: impl Fn(usize) -> &'s Self,
        from: &LaneReceiver<F>,
        u: [F; 2],
    ) -> LanePoint<F> {
        let (center, radius, inward) = Self::in_lanes::<F>(&sphere);
        let cone = cone::<F>(center, radius, from.position);
        let outward = cone.sample_normal(u);
        let reach = center.magnitudes() + F::Vector::from_xyz(radius, radius, radius);
        let mut point = LanePoint {
            position: center + outward * radius,
            error: reach * F::splat(gamma(4)),
            normal: F::Vector::choose(inward, -outward, outward),
            density: cone.density(),
        };
        if !cone.exists.all() {
            let inside = per_lane::<F, _>(|i| {
                let at = || sphere(i).sample_area(Vec2::from(u.map(|u| u.lane(i))));
                (!cone.exists.lane(i)).then(at).flatten()
            });
            let vector = |of: fn(&SurfacePoint) -> Vec3| {
                F::Vector::of_lanes(|i| inside[i].as_ref().map_or(Vec3::ZERO, of))
            };
            let choose = |yes, no| F::Vector::choose(cone.exists, yes, no);
            point.position = choose(point.position, vector(|at| at.position));
            point.error = choose(point.error, vector(|at| at.error));
            point.normal = choose(point.normal, vector(|at| at.normal));
            let area = F::from_fn(|i| sphere(i).area().unwrap_or(f64::INFINITY) as f32);
            let by_area =
                area_density_toward::<F>(area, from.position, point.position, point.normal);
            point.density = cone.exists.select(point.density, by_area);
        }
        point
    }
}

impl ShapeModel for Sphere {
    #[inline]
    fn both_crossings(&self, line: &Line) -> Option<[f64; 2]> {
        Some(self.crossings(line))
    }

    fn surface_at(&self, _: u32, p: DVec3, _: &Crossing) -> Option<LocalInteraction> {
        Some(self.surface_toward(p))
    }

    fn parametric(&self, uv: DVec2) -> Option<LocalInteraction> {
        let (sin_phi, cos_phi) = float64::sin_cos(TAU * uv.x);
        let (sin, cos) = float64::sin_cos(PI * uv.y);
        let own = DVec3::new(cos_phi * sin, sin_phi * sin, cos);
        Some(self.surface(self.axes * own))
    }

    fn piece_bounds(&self, _: u32) -> [DVec3; 2] {
        [self.center - self.radius, self.center + self.radius]
    }

    fn is_closed(&self) -> bool {
        true
    }

    fn area(&self) -> Option<f64> {
        Some(2.0 * TAU * self.radius * self.radius)
    }

    fn sample_area(&self, u: Vec2) -> Option<SurfacePoint> {
        let normal = square_to_uniform_sphere(u).as_dvec3().normalize();
        Some(self.surface(normal).whole())
    }

    fn sample_toward(&self, from: &LightSampleContext, u: Vec2) -> Option<SampledPoint> {
        let cone = self.cone(from.position);
        if !cone.exists {
            let point = self.sample_area(u)?;
            let density = self.area_density_toward(from.position, &point);
            return Some(SampledPoint { point, density });
        }
        let normal = cone.sample_normal(u.to_array()).as_dvec3().normalize();
        Some(SampledPoint {
            point: self.surface(normal).whole(),
            density: cone.density(),
        })
    }

    fn density_toward(&self, from: &LightSampleContext, at: &SurfacePoint) -> f32 {
        let cone = self.cone(from.position);
        if !cone.exists {
            return self.area_density_toward(from.position, at);
        }
        // From outside, only the near side is sampled. The normal identifies it even if the position is rounded by more than
        // the radius.
        let outward = if self.inward { -at.normal } else { at.normal };
        let near = outward.dot(from.position - at.position) >= 0.0;
        if near { cone.density() } else { 0.0 }
    }
}

impl Sphere {
    /// The parameters of up to two crossings with a line, in ascending order; NaN where there is none.
    fn crossings(&self, line: &Line) -> [f64; 2] {
        crossings(line.origin - self.center, line.direction, self.radius)
    }
}

/// The same of the line o + t·d with the sphere of this radius around the origin.
#[inline(always)] // As above.
pub(crate) fn crossings(o: DVec3, direction: DVec3, radius: f64) -> [f64; 2] {
    let a = direction.length_squared();
    let b = o.dot(direction);
    let closest = o - direction * (b / a);
    let disc = radius * radius - closest.length_squared();
    if !(disc >= 0.0) {
        return [f64::NAN; 2];
    }
    let q = -(b + (a * disc).sqrt().copysign(b));
    let distance = o.length();
    let c = (distance - radius) * (distance + radius);
    let (t0, t1) = (c / q, q / a);
    if t0 <= t1 { [t0, t1] } else { [t1, t0] }
}

/// (u, v) of a point of the unit sphere, ∂p/∂u and ∂p/∂v.
#[inline(always)] // So that nothing is computed that the caller does not need.
pub(crate) fn coordinates(DVec3 { x, y, z }: DVec3) -> (Vec2, [DVec3; 2]) {
    let sin = float64::safe_sqrt(x * x + y * y);
    let (cos_phi, sin_phi) = if sin > 0.0 {
        (x / sin, y / sin)
    } else {
        (1.0, 0.0)
    };
    let phi = lane::atan2(sin_phi as f32, cos_phi as f32);
    let u = 0.5 * FRAC_1_PI * phi + if phi < 0.0 { 1.0 } else { 0.0 };
    let v = lane::atan2(sin as f32, z as f32) * FRAC_1_PI;
    // At the poles ∂p/∂u vanishes: the tangent of the meridian's neighbour is given length 0
    // by the formula and direction by its limit, so that a frame can still be built.
    let dp_du = DVec3::new(-sin_phi, cos_phi, 0.0) * (TAU * sin.max(1e-12));
    let dp_dv = DVec3::new(z * cos_phi, z * sin_phi, -sin) * PI;
    (Vec2::new(u, v), [dp_du, dp_dv])
}
