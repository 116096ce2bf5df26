//! Light from shapes of any size at any distance: sampled against closed forms.

use crate::things::{geometry_of, mesh_of, place};
use core::f64::consts::PI;
use etalon_geometry::shapes::{disk::Disk, rectangle::Rectangle, sphere::Sphere};
use etalon_geometry::{Geometry, Shape};
use etalon_params::{DMat4, DVec3};
use etalon_transport::{
    LightSampleContext, Ray, SampledPoint, ShapeId, Shapes, SurfacePoint, TexturePoint,
};
use glam::{Vec2, Vec3};

const ID: ShapeId = ShapeId(0);

/// A receiver at `at` whose normal is +z.
fn receiver(at: Vec3) -> LightSampleContext {
    LightSampleContext::on_surface(at, Vec3::Z)
}

/// Irradiance at `at` over the radiance of the shape, from sampled points that face it: chosen one by one, and as in lanes if the
/// shape has them.
fn irradiance(geometry: &Geometry, at: Vec3) -> f64 {
    let from = receiver(at);
    let alone = |u| {
        let sampled = geometry.sample_toward(ID, &from, u)?;
        let density = geometry.density_toward(ID, &from, &sampled.point);
        let faces = sampled.point.normal.dot(sampled.point.position - at) < 0.0;
        assert!(
            !faces || (density / sampled.density - 1.0).abs() < 1e-3,
            "{density} {}",
            sampled.density
        );
        Some(sampled)
    };
    let one = mean_irradiance(geometry, at, alone);
    let lane = |u: Vec2| {
        let in_lanes = geometry.are_alike([ID, ID]);
        let point = || geometry.points_toward::<f32>(|_| ID, &from.broadcast(), u.to_array());
        in_lanes.then(point).map(|point| SampledPoint {
            point: SurfacePoint {
                position: point.position,
                error: point.error,
                normal: point.normal,
                texture: TexturePoint::at_uv(u),
            },
            density: point.density,
        })
    };
    if lane(Vec2::splat(0.5)).is_some() {
        let lanes = mean_irradiance(geometry, at, lane);
        assert!(
            (lanes / one - 1.0).abs() < 1e-3,
            "{lanes} in lanes, {one} one by one"
        );
    }
    one
}

fn mean_irradiance(
    geometry: &Geometry,
    at: Vec3,
    sample: impl Fn(Vec2) -> Option<SampledPoint>,
) -> f64 {
    const SIDE: usize = 64;
    let mut sum = 0.0;
    for i in 0..SIDE * SIDE {
        let u = Vec2::new((i % SIDE) as f32 + 0.5, (i / SIDE) as f32 + 0.5) / SIDE as f32;
        let Some(sampled) = sample(u) else {
            continue;
        };
        let point = sampled.point;
        let to = point.position - at;
        if !(point.normal.dot(to) < 0.0) {
            continue;
        }
        let target = point.origin_toward(at);
        let shadow = Ray::between(at + Vec3::Z * 1e-6, target, 0.0).expect("apart");
        assert!(!geometry.occluded(&shadow), "hidden by itself: {shadow:?}");
        sum += f64::from(to.normalize().z.max(0.0) / sampled.density);
    }
    sum / (SIDE * SIDE) as f64
}

fn sphere(center: DVec3, radius: f64) -> Geometry {
    let sphere = Sphere::new(&place(DMat4::IDENTITY), center, radius, false);
    geometry_of([Shape::Sphere(sphere.expect("round"))])
}

/// The direction at `degrees` from +z.
fn at_angle(degrees: f64) -> DVec3 {
    let (sin, cos) = etalon_math::float64::sin_cos(degrees.to_radians());
    DVec3::new(sin, 0.0, cos)
}

/// Inside a glowing sphere E = π L everywhere, on the sphere too. Rejects points of the sphere that rounding puts
/// outside and that then see the hemisphere outside: every other one was dark.
#[test]
fn a_sphere_lights_its_own_inside() {
    for i in 0..40 {
        let radius = 1.0 + 0.137 * f64::from(i);
        let center = DVec3::new(0.3, -0.7, 0.11 * f64::from(i));
        let inward = Sphere::new(&place(DMat4::IDENTITY), center, radius, true);
        let geometry = geometry_of([Shape::Sphere(inward.expect("round"))]);
        let bottom = (center - DVec3::Z * radius).as_vec3();
        let found = irradiance(&geometry, bottom) / PI;
        assert!((found - 1.0).abs() < 0.02, "{i}: {found}");
    }
}

/// E = π L (r/d)² cos θ above the horizon. Rejects a position, a normal or a cone in single precision:
/// the light of r/d = 10⁻⁸ was half.
#[test]
fn spheres_send_all_their_light() {
    for shift in [Vec3::ZERO, Vec3::new(1e4, 3e3, -2e3)] {
        for distance in [3.1, 1000.0, 1e5] {
            for ratio in [0.5, 0.1, 1e-2, 1e-4, 1e-6, 1e-7, 1e-8, 1e-12] {
                for degrees in [0.0, 50.0, 80.0] {
                    let toward = at_angle(degrees);
                    if toward.z < ratio {
                        continue;
                    }
                    let center = shift.as_dvec3() + toward * distance;
                    let geometry = sphere(center, ratio * distance);
                    let expected = PI * ratio * ratio * toward.z;
                    let found = irradiance(&geometry, shift) / expected;
                    // The positions of points far from the origin are rounded.
                    let rounding = f64::from(shift.length()) / distance * 2e-6;
                    assert!(
                        (found - 1.0).abs() < 5e-4 + rounding,
                        "r/d {ratio} at {distance} m, {degrees}°, {shift}: {found}"
                    );
                }
            }
        }
    }
    // Half below the horizon; the value by quadrature of ∫ max(cos, 0) dω over the cone.
    let found = irradiance(&sphere(at_angle(80.0) * 3.1, 1.55), Vec3::ZERO);
    assert!((found / 0.171_832 - 1.0).abs() < 2e-3, "{found}");
}

/// What a ray finds is what light sampling offers. Rejects a hit point that is off its sphere by the
/// rounding of t.
#[test]
fn hits_of_small_spheres_face_the_ray() {
    for ratio in [0.3, 1e-2, 1e-4, 1e-6] {
        let center = at_angle(50.0) * 1000.0;
        let geometry = sphere(center, ratio * 1000.0);
        let from = receiver(Vec3::ZERO);
        let ray = Ray::new(Vec3::ZERO, center.normalize().as_vec3(), 0.0);
        let hit = geometry.intersect(&ray).expect("straight at it");
        let vertex = geometry.vertex(&ray, &hit);
        assert!(
            vertex.normal.dot(ray.direction) < -0.9,
            "{ratio}: {vertex:?}"
        );
        let density = geometry.density_toward(ID, &from, &SurfacePoint::from(&vertex));
        let sampled = geometry.sample_toward(ID, &from, Vec2::splat(0.3));
        assert_eq!(density, sampled.expect("seen").density);
    }
}

/// Small flat lights: E = L A cos θ / d², facing the receiver.
#[test]
fn flat_lights_send_all_their_light() {
    for ratio in [1e-2, 1e-4, 1e-6, 1e-8] {
        for degrees in [0.0, 50.0, 80.0] {
            let toward = at_angle(degrees);
            let distance = 1000.0;
            let size = ratio * distance;
            // +z of the shape looks back.
            let turn = DMat4::from_rotation_y(degrees.to_radians() + PI);
            let matrix = DMat4::from_translation(toward * distance)
                * turn
                * DMat4::from_scale(DVec3::splat(size));
            let flat = place(matrix);
            let disk = Shape::Disk(Disk::new(&flat, false).expect("finite"));
            let rectangle = Shape::Rectangle(Rectangle::new(&flat, false).expect("finite"));
            for (name, shape, area) in [("disk", disk, PI), ("rectangle", rectangle, 4.0)] {
                let expected = area * ratio * ratio * toward.z;
                let found = irradiance(&geometry_of([shape]), Vec3::ZERO) / expected;
                assert!(
                    (found - 1.0).abs() < 5e-4,
                    "{name} of r/d {ratio} at {degrees}°: {found}"
                );
            }
        }
    }
    // A triangle at the origin, seen from far: corners relative to the receiver would be rounded.
    let from = (at_angle(50.0) * -1000.0).as_vec3();
    for size in [3.0_f32, 1.5, 1e-2, 1e-5] {
        let corners = [Vec3::ZERO, Vec3::X * size, Vec3::Y * size];
        let geometry = geometry_of([mesh_of(corners.to_vec(), vec![[0, 2, 1]])]);
        let d = f64::from(from.length());
        let cos = f64::from(-from.z) / d;
        let area = 0.5 * f64::from(size * size);
        let expected = area * cos * cos / (d * d);
        let found = irradiance(&geometry, from) / expected;
        assert!((found - 1.0).abs() < 5e-3, "triangle of {size}: {found}");
    }
}
