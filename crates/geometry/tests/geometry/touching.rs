//! Dielectrics whose surfaces lie closer than single precision tells, or coincide: a ray never meets
//! one from the wrong side.

use crate::things::{Random, place};
use etalon_geometry::shapes::{
    cube::cube, cylinder::Cylinder, disk::Disk, rectangle::Rectangle, sphere::Sphere,
};
use etalon_geometry::{Geometry, GeometryBuilder, Placement, Shape};
use etalon_params::{DMat4, DVec3};
use etalon_transport::{LightId, MaterialId, Ray, ShapeId};
use glam::Vec3;

const GAPS: [f64; 10] = [1e-2, 1e-4, 1e-6, 3e-7, 1e-7, 6e-8, 1e-8, 1e-9, 1e-10, 0.0];

fn dielectrics(shapes: [Shape; 2]) -> Geometry {
    let mut builder = GeometryBuilder::new();
    for shape in shapes {
        let id = builder.add_shape(shape, MaterialId(0), LightId::NONE);
        builder.set_refractive(id);
    }
    builder.build()
}

/// Follows rays that pass surfaces or are reflected at random, and counts their surfaces. What is
/// met from its inside must have been entered, and one is only met `within` the other, if it is.
fn follow(
    name: &str,
    geometry: &Geometry,
    rays: impl Iterator<Item = Ray>,
    within: [bool; 2],
) -> usize {
    let mut random = Random(77);
    let mut met = 0;
    for mut ray in rays {
        let mut inside = [false; 2];
        for _ in 0..60 {
            let Some(hit) = geometry.intersect(&ray) else {
                assert_eq!(inside, [false; 2], "{name}: left by a hole, {ray:?}");
                break;
            };
            met += 1;
            let vertex = geometry.vertex(&ray, &hit);
            let which = vertex.shape.0 as usize;
            let enters = ray.direction.dot(vertex.normal) < 0.0;
            assert_eq!(
                enters, !inside[which],
                "{name}: shape {which} from the wrong side, inside {inside:?}, {ray:?}"
            );
            if within[which] {
                assert!(
                    inside[1 - which],
                    "{name}: {which} met outside of the other"
                );
            }
            let side = if enters {
                -vertex.normal
            } else {
                vertex.normal
            };
            let passes = random.number() < 0.6;
            if passes {
                inside[which] = enters;
            }
            // Anywhere on the side on which it goes on, as rough surfaces and refraction do.
            let to = if passes { side } else { -side };
            let mut direction = (ray.direction + random.point() * 0.7).normalize();
            if direction.dot(to) < 0.0 {
                direction -= 2.0 * direction.dot(to) * to;
            }
            // Within some 10⁻³ of the tangent plane the ray's line, which starts a little off the
            // surface, may pass the other sphere by.
            let lift = (0.01 - direction.dot(to)).max(0.0);
            ray = vertex.spawn((direction + to * lift).normalize());
        }
    }
    met
}

/// Rays from far around at a ball.
fn around(center: Vec3, radius: f32) -> impl Iterator<Item = Ray> {
    let mut random = Random(5);
    (0..300).map(move |_| {
        let from = center + random.direction() * radius * 4.0;
        let to = center + random.point() * radius * 0.9;
        Ray::new(from, (to - from).normalize(), 0.0)
    })
}

/// The shape at `index` with all its sizes times `scale`.
fn closed(index: usize, place: &dyn Fn(f64) -> Placement, scale: f64) -> Shape {
    match index {
        0 => Shape::Sphere(Sphere::new(&place(1.0), DVec3::ZERO, scale, false).expect("round")),
        1 => Shape::Sphere(Sphere::new(&place(scale), DVec3::ZERO, 1.0, false).expect("round")),
        _ => Shape::Mesh(cube(&place(scale), false).expect("finite")),
    }
}

/// Rejects rays that start by jumping over the second surface, and distances compared in single
/// precision.
#[test]
fn one_in_another() {
    for (shift, size, angle) in [
        (Vec3::ZERO, 1.0, 0.0),
        (Vec3::new(3.0, -20.0, 7.0), 1.0, 0.7),
        (Vec3::new(0.1, 0.2, -0.1), 0.01, 0.3),
        (Vec3::new(100.0, 50.0, -30.0), 250.0, 1.1),
    ] {
        let axis = DVec3::new(0.3, -0.7, 0.65).normalize();
        let turned =
            DMat4::from_translation(shift.as_dvec3()) * DMat4::from_axis_angle(axis, angle);
        let place = |scale: f64| place(turned * DMat4::from_scale(DVec3::splat(scale * size)));
        for index in 0..3 {
            for gap in GAPS {
                for outer_first in [true, false] {
                    let outer = closed(index, &place, 1.0);
                    let inner = closed(index, &place, 1.0 - gap);
                    let name =
                        format!("shape {index}, gap {gap}, {size} m at {shift}, {outer_first}");
                    let (shapes, mut within) = if outer_first {
                        ([outer, inner], [false, true])
                    } else {
                        ([inner, outer], [true, false])
                    };
                    if gap < 1e-5 && index == 2 || gap == 0.0 {
                        // Corners are rounded, and so may coincide; the first is the outer one then.
                        within = [false, false];
                    }
                    let rays = around(shift, size as f32);
                    let met = follow(&name, &dielectrics(shapes), rays, within);
                    assert!(met > 500, "{name}: {met}");
                }
            }
        }
    }
}

/// Two layers side by side: of each only the face toward the other is there.
#[test]
fn side_by_side() {
    for height in [0.0, 1.0, 100.0] {
        for gap in GAPS {
            for kind in 0..2 {
                let face = |z: f64, up: bool| {
                    let turn = DMat4::from_rotation_x(if up { 0.0 } else { core::f64::consts::PI });
                    let matrix = DMat4::from_translation(DVec3::new(0.0, 0.0, z))
                        * turn
                        * DMat4::from_scale(DVec3::splat(1000.0));
                    let placement = place(matrix);
                    match kind {
                        0 => Shape::Disk(Disk::new(&placement, false).expect("finite")),
                        _ => Shape::Rectangle(Rectangle::new(&placement, false).expect("finite")),
                    }
                };
                for upper_first in [true, false] {
                    let (upper, lower) = (face(height, false), face(height - gap, true));
                    let shapes = if upper_first {
                        [upper, lower]
                    } else {
                        [lower, upper]
                    };
                    let upper = ShapeId(u32::from(!upper_first));
                    let geometry = dielectrics(shapes);
                    let mut random = Random(9);
                    for _ in 0..300 {
                        let tilt = random.direction() * Vec3::new(3.0, 3.0, 0.0);
                        let down = (tilt - Vec3::Z).normalize();
                        let name = format!("kind {kind}, height {height}, gap {gap}: {down}");
                        let from = random.point().with_z(height as f32 + 2.0);
                        let ray = Ray::new(from, down, 0.0);
                        // Down through both, and from the lower one up again.
                        let first = geometry.vertex(&ray, &geometry.intersect(&ray).expect("one"));
                        assert_eq!(first.shape, upper, "{name}");
                        let ray = first.spawn(down);
                        let hit = geometry.intersect(&ray);
                        let second =
                            geometry.vertex(&ray, &hit.unwrap_or_else(|| panic!("{name}")));
                        assert_ne!(second.shape, upper, "{name}");
                        assert!(geometry.intersect(&second.spawn(down)).is_none(), "{name}");
                        let up = down.with_z(-down.z);
                        let ray = second.spawn(up);
                        assert!(geometry.occluded(&ray), "{name}");
                        let hit = geometry.intersect(&ray);
                        let third = geometry.vertex(&ray, &hit.unwrap_or_else(|| panic!("{name}")));
                        assert_eq!(third.shape, upper, "{name}");
                        assert!(geometry.intersect(&third.spawn(up)).is_none(), "{name}");
                        assert!(geometry.intersect(&first.spawn(up)).is_none(), "{name}");
                    }
                }
            }
        }
    }
}

/// A glass filled to its wall: a cylinder and a sphere around it touch along a circle only, coaxial
/// cylinders all along.
#[test]
fn coaxial_cylinders() {
    for gap in GAPS {
        let tube = |radius: f64| {
            let placement = place(DMat4::from_translation(DVec3::new(0.3, -0.2, 0.1)));
            let ends = [DVec3::new(0.0, 0.0, -50.0), DVec3::new(0.0, 0.0, 50.0)];
            Shape::Cylinder(Cylinder::new(&placement, ends, radius, false).expect("round"))
        };
        let geometry = dielectrics([tube(1.0), tube(1.0 - gap)]);
        let mut random = Random(15);
        for _ in 0..1000 {
            let from = Vec3::new(0.3, -0.2, 0.1) + random.direction().with_z(0.0).normalize() * 4.0;
            let to = Vec3::new(0.3, -0.2, 0.1) + random.point() * Vec3::new(0.6, 0.6, 0.5);
            let mut ray = Ray::new(from, (to - from).normalize(), 0.0);
            let mut order = Vec::new();
            while let Some(hit) = geometry.intersect(&ray) {
                let vertex = geometry.vertex(&ray, &hit);
                order.push(vertex.shape.0);
                ray = vertex.spawn(ray.direction);
            }
            assert_eq!(order, [0, 1, 1, 0], "gap {gap}: {ray:?}");
        }
    }
}
