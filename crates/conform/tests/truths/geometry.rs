//! Where rays meet the surfaces of a scene, in double precision.

use etalon_conform::scene::{Object, Scene, Shape, Triple};
use glam::DVec3;

/// A point and a unit direction.
#[derive(Clone, Copy)]
pub(crate) struct Ray {
    pub(crate) origin: DVec3,
    pub(crate) direction: DVec3,
}

/// Where a ray meets an object.
#[derive(Clone, Copy)]
pub(crate) struct Hit<'a> {
    pub(crate) distance: f64,
    pub(crate) point: DVec3,
    /// The unit normal of the outer side.
    pub(crate) normal: DVec3,
    pub(crate) object: &'a Object,
}

impl Hit<'_> {
    /// The radiance that the surface emits against a ray along this direction.
    pub(crate) fn emitted(&self, direction: DVec3) -> f64 {
        if direction.dot(self.normal) < 0.0 {
            self.object.emitted_radiance
        } else {
            0.0
        }
    }
}

/// The first surface beyond a distance that is little to all scenes' forms.
pub(crate) fn nearest<'a>(scene: &'a Scene, ray: &Ray) -> Option<Hit<'a>> {
    const LEAST: f64 = 1e-9;
    let mut found: Option<Hit<'a>> = None;
    for object in &scene.objects {
        let mut keep = |distance: f64, normal: DVec3| {
            if distance > LEAST && found.is_none_or(|hit| distance < hit.distance) {
                found = Some(Hit {
                    distance,
                    point: ray.origin + distance * ray.direction,
                    normal,
                    object,
                });
            }
        };
        meet(&object.shape, ray, &mut keep);
    }
    found
}

/// All distances at which a ray's line meets a form, with the normals there.
fn meet(shape: &Shape, ray: &Ray, keep: &mut impl FnMut(f64, DVec3)) {
    match shape {
        Shape::Sphere {
            center_m,
            radius_m,
            inward,
        } => {
            let from = ray.origin - DVec3::from(*center_m);
            let middle = -from.dot(ray.direction);
            let across = from + middle * ray.direction;
            let square = radius_m * radius_m - across.length_squared();
            if square >= 0.0 {
                for distance in [middle - square.sqrt(), middle + square.sqrt()] {
                    let out = (from + distance * ray.direction).normalize();
                    keep(distance, if *inward { -out } else { out });
                }
            }
        }
        Shape::Quad {
            center_m,
            half_u_m,
            half_v_m,
        } => face(*center_m, *half_u_m, *half_v_m, ray, keep),
        Shape::Box {
            center_m,
            half_axes_m,
        } => {
            let [a, b, c] = half_axes_m.map(DVec3::from);
            for (out, u, v) in [(a, b, c), (b, c, a), (c, a, b)] {
                for side in [-1.0, 1.0] {
                    let center = DVec3::from(*center_m) + side * out;
                    face(center.into(), (side * u).into(), v.into(), ray, keep);
                }
            }
        }
        Shape::Mesh {
            positions_m,
            triangles,
        } => {
            for triangle in triangles {
                let [a, b, c] = triangle.map(|i| DVec3::from(positions_m[i as usize]));
                plane(a, b - a, c - a, ray, keep, |u, v| {
                    u >= 0.0 && v >= 0.0 && u + v <= 1.0
                });
            }
        }
    }
}

fn face(center: Triple, u: Triple, v: Triple, ray: &Ray, keep: &mut impl FnMut(f64, DVec3)) {
    plane(center.into(), u.into(), v.into(), ray, keep, |u, v| {
        u.abs() <= 1.0 && v.abs() <= 1.0
    });
}

/// The point origin + u · `u` + v · `v` of a plane, if its coordinates (u, v) are within the form.
fn plane(
    origin: DVec3,
    u: DVec3,
    v: DVec3,
    ray: &Ray,
    keep: &mut impl FnMut(f64, DVec3),
    within: impl Fn(f64, f64) -> bool,
) {
    let normal = u.cross(v);
    let distance = (origin - ray.origin).dot(normal) / ray.direction.dot(normal);
    let at = ray.origin + distance * ray.direction - origin;
    // Cramer's rule in the plane.
    let square = normal.length_squared();
    let (x, y) = (
        at.cross(v).dot(normal) / square,
        u.cross(at).dot(normal) / square,
    );
    if distance.is_finite() && within(x, y) {
        keep(distance, normal.normalize());
    }
}
