//! A ray that leaves a surface does not meet that surface again, however far from the origin of
//! space it lies; points that are sampled lie on the shape.

use crate::things::{Random, convex_shapes, geometry_of, moved};
use etalon_geometry::{GeometryBuilder, Shape};
use etalon_transport::{
    LightSampleContext, MaterialId, Ray, ShapeId, Shapes, SurfaceInteraction, SurfacePoint,
};
use glam::Vec3;

/// Directions on the side of `normal`: anywhere, and close to the tangent plane.
fn leaving(normal: Vec3, random: &mut Random) -> [Vec3; 2] {
    let outward = |d: Vec3| if d.dot(normal) < 0.0 { -d } else { d };
    let any = outward(random.direction());
    let tangent = random.direction().cross(normal).normalize();
    let grazing = (tangent + normal * (0.001 + 0.01 * random.number())).normalize();
    [any, outward(grazing)]
}

/// Where a shape is (m), how large, and how it is turned.
const PLACES: [(f32, f32, f64); 6] = [
    (0.0, 1.0, 0.0),
    (3.0, 1.0, 0.7),
    (1e3, 1.0, 1.9),
    (1e5, 20.0, 2.4),
    (0.01, 1e-3, 0.3),
    (1e4, 5e3, 1.1),
];

#[test]
fn convex_surfaces_are_left_for_good() {
    let mut random = Random(21);
    for (distance, scale, angle) in PLACES {
        let shift = Vec3::new(0.8, -0.5, 0.33) * distance;
        for (name, shape) in convex_shapes(shift, angle, scale) {
            let flat = matches!(name, "disk" | "rectangle");
            let geometry = geometry_of([shape]);
            let mut count = 0;
            for _ in 0..4000 {
                let from = shift + random.direction() * scale * 4.0;
                let to = shift + random.point() * scale;
                let ray = Ray::new(from, (to - from).normalize(), 0.0);
                let Some(hit) = geometry.intersect(&ray) else {
                    continue;
                };
                let vertex = geometry.vertex(&ray, &hit);
                count += 1;
                let sides: &[f32] = if flat { &[1.0, -1.0] } else { &[1.0] };
                for side in sides {
                    for direction in leaving(vertex.normal * *side, &mut random) {
                        let ray = vertex.spawn(direction);
                        let again = geometry.intersect(&ray);
                        assert!(
                            again.is_none(),
                            "{name} at {distance}, {scale}: {ray:?} {again:?}"
                        );
                        assert!(!geometry.occluded(&ray), "{name}: {ray:?}");
                    }
                }
            }
            assert!(count > 500, "{name}: {count}");
        }
    }
}

#[test]
fn the_inside_of_a_sphere_is_met_on_the_far_side_only() {
    let mut random = Random(22);
    for (distance, scale, angle) in PLACES {
        let shift = Vec3::new(0.8, -0.5, 0.33) * distance;
        let sphere = convex_shapes(shift, angle, scale).swap_remove(0).1;
        let geometry = geometry_of([sphere]);
        for _ in 0..4000 {
            let Some(vertex) = first(&geometry, shift, scale, &mut random) else {
                continue;
            };
            let direction = leaving(-vertex.normal, &mut random)[0];
            let ray = vertex.spawn(direction);
            let hit = geometry.intersect(&ray).expect("a sphere is closed");
            // The chord's length is 2R |cos θ|; from a depth h, t² − chord·t = 2Rh.
            let chord = -2.0 * scale * direction.dot(vertex.normal);
            let depth = 8.0 * vertex.error.max_element();
            let off = (hit.t * (hit.t - chord)).abs();
            assert!(
                off < 2.0 * scale * depth + 1e-5 * scale * hit.t,
                "{} {chord}",
                hit.t
            );
        }
    }
}

fn first(
    geometry: &etalon_geometry::Geometry,
    shift: Vec3,
    scale: f32,
    random: &mut Random,
) -> Option<SurfaceInteraction> {
    let from = shift + random.direction() * scale * 4.0;
    let to = shift + random.point() * scale;
    let ray = Ray::new(from, (to - from).normalize(), 0.0);
    let hit = geometry.intersect(&ray)?;
    Some(geometry.vertex(&ray, &hit))
}

#[test]
fn instanced_surfaces_are_left_for_good() {
    let mut random = Random(23);
    for (distance, scale, angle) in PLACES {
        let shift = Vec3::new(-0.3, 0.9, 0.5) * distance;
        let stretch = Vec3::new(1.0, 0.4, -0.7) * scale;
        for index in 0..6 {
            let (name, shape) =
                convex_shapes(Vec3::new(0.5, 2.0, -1.0), 0.3, 1.0).swap_remove(index);
            let mut builder = GeometryBuilder::new();
            let group = builder.add_group([(shape, MaterialId(0))]);
            let placement = moved(shift, angle, stretch);
            builder.add_instance(group, placement);
            let geometry = builder.build();
            let middle = placement.point(glam::DVec3::new(0.5, 2.0, -1.0)).as_vec3();
            let mut count = 0;
            for _ in 0..2000 {
                let Some(vertex) = first(&geometry, middle, scale, &mut random) else {
                    continue;
                };
                count += 1;
                for direction in leaving(vertex.normal, &mut random) {
                    let ray = vertex.spawn(direction);
                    let again = geometry.intersect(&ray);
                    assert!(
                        again.is_none(),
                        "{name} at {distance}, {scale}: {ray:?} {again:?}"
                    );
                }
            }
            assert!(count > 100, "{name}: {count}");
        }
    }
}

#[test]
fn sampled_points_lie_on_the_shape_and_are_seen() {
    let mut random = Random(24);
    for (distance, scale, angle) in PLACES {
        let shift = Vec3::new(0.8, -0.5, 0.33) * distance;
        for (name, shape) in convex_shapes(shift, angle, scale) {
            let geometry = geometry_of([shape]);
            let id = ShapeId(0);
            for _ in 0..1000 {
                let from = shift + random.direction() * scale * (1.8 + 3.0 * random.number());
                let receiver = LightSampleContext::on_surface(from, random.direction());
                for point in [
                    Some(geometry.sample_area(id, random.square(), 0.0)),
                    geometry.sample_toward(id, &receiver, random.square()),
                ]
                .into_iter()
                .flatten()
                {
                    let at = point.point;
                    assert!(at.normal.is_normalized() && point.density > 0.0, "{name}");
                    // A ray straight at the point, from just outside, meets the shape there.
                    let step = at.normal * 0.01 * scale;
                    let ray = Ray::new(at.position + step, -at.normal, 0.0);
                    let Some(hit) = geometry.intersect(&ray) else {
                        // At a rim, rounding may take the ray past the shape.
                        assert!(near_rim(name, &at), "{name}: {at:?}");
                        continue;
                    };
                    let error = 4.0 * at.error.max_element() + 1e-4 * scale;
                    assert!(
                        (hit.t - 0.01 * scale).abs() <= error,
                        "{name}: {} {}",
                        hit.t,
                        scale
                    );
                }
                if let Some(point) = geometry.sample_toward(id, &receiver, random.square()) {
                    let at = point.point;
                    let target = at.origin_toward(from);
                    // Convex: what faces the observer is not hidden by the shape itself.
                    let facing = at.normal.dot(from - at.position);
                    if facing > 1e-3 * scale {
                        let ray = Ray::between(from, target, 0.0).expect("apart");
                        assert!(!geometry.occluded(&ray), "{name} at {distance}: {ray:?}");
                    }
                }
            }
        }
    }
}

/// Whether a point is so close to where its shape ends that a ray at it may miss.
fn near_rim(name: &str, at: &SurfacePoint) -> bool {
    let edge = |x: f32| !(1e-4..=1.0 - 1e-4).contains(&x);
    match name {
        "disk" => edge(at.texture.uv.x),
        "cylinder" => edge(at.texture.uv.y),
        "rectangle" => edge(at.texture.uv.x) || edge(at.texture.uv.y),
        _ => false,
    }
}

#[test]
fn a_box_of_every_shape_holds_it() {
    let mut random = Random(25);
    for (distance, scale, angle) in PLACES {
        for (name, shape) in convex_shapes(Vec3::splat(distance), angle, scale) {
            let bounds = Shape::bounds(&shape);
            let geometry = geometry_of([shape]);
            for _ in 0..500 {
                let p = geometry.sample_area(ShapeId(0), random.square(), 0.0).point;
                let slack = p.error * 2.0;
                let inside = p.position.cmpge(bounds.min - slack).all()
                    && p.position.cmple(bounds.max + slack).all();
                assert!(inside, "{name}: {} not in {bounds:?}", p.position);
            }
        }
    }
}
