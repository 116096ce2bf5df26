//! Solids against what says of any point whether it is inside of them: rays through them, from outside and inside,
//! random, axis-parallel and nearly tangent, meet every surface, from the right side, and never the same one twice.

use crate::description::make;
use crate::functions::implicit_cases;
use crate::things::{Random, geometry_of, moved};
use core::f64::consts::PI;
use etalon_geometry::shapes::csg::{Csg, Operation};
use etalon_geometry::{Geometry, Placement, Shape};
use etalon_params::{DVec3, Value};
use etalon_transport::{Ray, ShapeId, Shapes};
use glam::Vec3;

/// How far a point is inside of a solid.
pub(crate) type Depth = Box<dyn Fn(DVec3) -> f64>;

/// A solid, and how far a point is inside of it, in a measure of its own: negative outside.
struct Case {
    name: &'static str,
    geometry: Geometry,
    depth: Depth,
}

pub(crate) fn vector(name: &'static str, x: f64, y: f64, z: f64) -> (&'static str, Value) {
    (name, Value::Vector(DVec3::new(x, y, z)))
}

pub(crate) fn number(name: &'static str, value: f64) -> (&'static str, Value) {
    (name, Value::Float(value))
}

pub(crate) fn built(plugin: &str, properties: Vec<(&str, Value)>) -> Shape {
    let (shape, messages) = make(plugin, properties);
    shape.unwrap_or_else(|| panic!("{messages}"))
}

pub(crate) fn ball(x: f64, y: f64, z: f64, radius: f64) -> Shape {
    built(
        "sphere",
        vec![vector("center", x, y, z), number("radius", radius)],
    )
}

pub(crate) fn combine(operation: Operation, operands: Vec<Shape>) -> Shape {
    let csg = Csg::new(operation, operands, Placement::IDENTITY, false);
    Shape::Csg(csg.expect("operands"))
}

pub(crate) fn in_ball(p: DVec3, x: f64, y: f64, z: f64, radius: f64) -> f64 {
    radius - (p - DVec3::new(x, y, z)).length()
}

fn in_cube(p: DVec3) -> f64 {
    1.0 - p.abs().max_element()
}

fn in_torus(p: DVec3) -> f64 {
    let ring = p.truncate().length() - 1.0;
    0.4 - (ring * ring + p.z * p.z).sqrt()
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add = |name, shape: Shape, depth: Box<dyn Fn(DVec3) -> f64>| {
        let geometry = geometry_of([shape]);
        cases.push(Case {
            name,
            geometry,
            depth,
        });
    };
    let torus = || {
        let radii = vec![number("major_radius", 1.0), number("minor_radius", 0.4)];
        built("torus", radii)
    };
    let cube = || built("cube", vec![]);
    add("torus", torus(), Box::new(in_torus));
    // All that is in the tube, which reaches over the axis.
    add(
        "spindle torus",
        built(
            "torus",
            vec![number("major_radius", 0.4), number("minor_radius", 0.7)],
        ),
        Box::new(|p| {
            let ring = p.truncate().length() - 0.4;
            0.7 - (ring * ring + p.z * p.z).sqrt()
        }),
    );
    let sheared = moved(Vec3::new(0.2, -0.1, 0.1), 0.8, Vec3::new(1.2, 0.7, -0.9));
    let matrix = etalon_params::DMat4::from_cols(
        sheared.vector(DVec3::X).extend(0.0),
        sheared.vector(DVec3::Y).extend(0.0),
        sheared.vector(DVec3::Z).extend(0.0),
        sheared.point(DVec3::ZERO).extend(1.0),
    );
    let placed = || ("to_world", Value::Transform(matrix));
    let radii = vec![
        number("major_radius", 1.0),
        number("minor_radius", 0.4),
        placed(),
    ];
    add(
        "torus, mirrored and stretched",
        built("torus", radii),
        Box::new(move |p| in_torus(sheared.local_point(p))),
    );
    let cone = |r0: f64, r1: f64| {
        move |p: DVec3| {
            let radius = r0 + (r1 - r0) * p.z;
            (radius - p.truncate().length()).min(p.z).min(1.0 - p.z)
        }
    };
    for (name, r0, r1) in [
        ("cone", 1.0, 0.0),
        ("truncated cone", 0.3, 0.9),
        ("capped cylinder", 0.7, 0.7),
    ] {
        let shape = built("cone", vec![number("radius0", r0), number("radius1", r1)]);
        add(name, shape, Box::new(cone(r0, r1)));
    }
    let below = || {
        let turned = etalon_params::DMat4::from_rotation_x(0.6);
        built("plane", vec![("to_world", Value::Transform(turned))])
    };
    let (sin, cos) = etalon_math::float64::sin_cos(0.6);
    let up = DVec3::new(0.0, -sin, cos);
    add(
        "a ball above a plane",
        combine(
            Operation::Difference,
            vec![ball(0.1, 0.0, 0.1, 0.8), below()],
        ),
        Box::new(move |p| p.dot(up).min(in_ball(p, 0.1, 0.0, 0.1, 0.8))),
    );
    add(
        "a ball below a plane",
        combine(
            Operation::Intersection,
            vec![ball(0.1, 0.0, 0.1, 0.8), below()],
        ),
        Box::new(move |p| (-p.dot(up)).min(in_ball(p, 0.1, 0.0, 0.1, 0.8))),
    );
    let hyperboloid = vec![
        vector("squares", 1.0, 1.0, -0.8),
        vector("products", 0.1, 0.0, 0.2),
        number("constant", -0.1),
        vector("min", -1.0, -0.9, -0.8),
    ];
    let hyperbolic = |p: DVec3| {
        let f = p.x * p.x + p.y * p.y - 0.8 * p.z * p.z + 0.1 * p.x * p.y + 0.2 * p.y * p.z - 0.1;
        let (low, high) = (p - DVec3::new(-1.0, -0.9, -0.8), DVec3::ONE - p);
        (-f).min(low.min_element()).min(high.min_element())
    };
    add(
        "hyperboloid",
        built("quadric", hyperboloid),
        Box::new(hyperbolic),
    );
    let radii = vec![
        vector("radii", 1.2, 0.5, 0.8),
        vector("center", 0.1, 0.0, -0.1),
    ];
    let elliptic =
        |p: DVec3| 1.0 - ((p - DVec3::new(0.1, 0.0, -0.1)) / DVec3::new(1.2, 0.5, 0.8)).length();
    add("ellipsoid", built("ellipsoid", radii), Box::new(elliptic));
    for case in implicit_cases() {
        add(case.0, case.1, case.2);
    }

    let two = || vec![ball(-0.4, 0.0, 0.0, 0.9), ball(0.5, 0.1, 0.0, 0.8)];
    let (a, b) = (
        |p: DVec3| in_ball(p, -0.4, 0.0, 0.0, 0.9),
        |p: DVec3| in_ball(p, 0.5, 0.1, 0.0, 0.8),
    );
    add(
        "union",
        combine(Operation::Union, two()),
        Box::new(move |p| a(p).max(b(p))),
    );
    add(
        "intersection",
        combine(Operation::Intersection, two()),
        Box::new(move |p| a(p).min(b(p))),
    );
    add(
        "difference",
        combine(Operation::Difference, two()),
        Box::new(move |p| a(p).min(-b(p))),
    );
    // A cube without a torus and without the half of another cube whose faces coincide with its own.
    let half = || {
        let up = etalon_params::DMat4::from_translation(DVec3::new(0.0, 0.0, 1.5));
        built("cube", vec![("to_world", Value::Transform(up))])
    };
    add(
        "coincident faces",
        combine(Operation::Difference, vec![cube(), torus(), half()]),
        Box::new(|p| {
            in_cube(p)
                .min(-in_torus(p))
                .min(-in_cube(p - DVec3::Z * 1.5))
        }),
    );
    // Nested, with a difference within a difference.
    let shell = combine(
        Operation::Difference,
        vec![ball(0.0, 0.0, 0.0, 1.2), ball(0.0, 0.0, 0.0, 1.0)],
    );
    let core = combine(
        Operation::Difference,
        vec![cube(), ball(0.0, 0.0, 0.0, 1.1)],
    );
    add(
        "nested",
        combine(
            Operation::Difference,
            vec![
                combine(Operation::Union, vec![shell, core]),
                ball(1.0, 1.0, 1.0, 0.7),
            ],
        ),
        Box::new(|p| {
            let r = p.length();
            let shell = (1.2 - r).min(r - 1.0);
            let core = in_cube(p).min(r - 1.1);
            shell.max(core).min(-in_ball(p, 1.0, 1.0, 1.0, 0.7))
        }),
    );
    cases
}

/// Where a line through everything crosses the surface, as rays that go on and on find it.
fn follow(case: &Case, mut ray: Ray) -> Vec<(f64, bool)> {
    let start = ray.origin;
    let mut crossings = Vec::new();
    while let Some(hit) = case.geometry.intersect(&ray) {
        let vertex = case.geometry.vertex(&ray, &hit);
        let t = f64::from((vertex.position - start).dot(ray.direction));
        crossings.push((t, vertex.normal.dot(ray.direction) < 0.0));
        assert!(crossings.len() < 100, "{}: {ray:?} does not end", case.name);
        ray = vertex.spawn(ray.direction);
    }
    crossings
}

/// 10⁴ rays (or `ETALON_RAYS`) for each solid, and a quarter of that for those of functions, each looked at in 400 points. A point is judged if it is farther from the surface than
/// rounding moves it.
#[test]
fn rays_cross_what_is_there() {
    const SURE: f64 = 2e-4;
    for case in cases() {
        let mut random = Random(3);
        let (mut judged, mut inside_count) = (0, 0);
        let all = std::env::var("ETALON_RAYS").ok();
        let all = all.and_then(|count| count.parse().ok()).unwrap_or(10_000);
        let rays = if case.name.contains("of a function") {
            all / 4
        } else {
            all
        };
        for index in 0..rays {
            let origin = random.point() * 1.6;
            let direction = match index % 4 {
                0 => [Vec3::X, Vec3::NEG_Y, Vec3::new(-0.0, -0.0, 1.0)][index / 4 % 3],
                // Toward the middle, where many lines cross many surfaces.
                1 => (random.point() * 0.3 - origin).normalize(),
                _ => random.direction(),
            };
            let ray = Ray::new(origin, direction, 0.0);
            let crossings = follow(&case, ray);
            // A limit to the ray changes nothing before it.
            if let Some(hit) = case.geometry.intersect(&ray) {
                let within = |t_max| case.geometry.intersect(&Ray { t_max, ..ray });
                let [short, long] = [hit.t * 0.999 - 1e-3, hit.t * 1.001 + 1e-3];
                assert_eq!(within(long), Some(hit), "{}: {ray:?}", case.name);
                assert_eq!(within(short), None, "{}: {ray:?}", case.name);
            }
            let starts_inside = crossings.first().is_some_and(|(_, enters)| !enters);
            for pair in crossings.windows(2) {
                assert!(
                    pair[0].1 != pair[1].1 && pair[0].0 <= pair[1].0 + 1e-5,
                    "{}: {ray:?} crosses {crossings:?}",
                    case.name
                );
            }
            for step in 0..400 {
                let t = f64::from(step) * 0.01;
                let depth = (case.depth)(origin.as_dvec3() + direction.as_dvec3() * t);
                let near_crossing = crossings.iter().any(|(at, _)| (at - t).abs() < 1e-4);
                if depth.abs() < SURE || near_crossing {
                    continue;
                }
                let passed = crossings.iter().take_while(|(at, _)| *at < t).count();
                let inside = starts_inside != (passed % 2 == 1);
                assert_eq!(
                    inside,
                    depth > 0.0,
                    "{}: at {t} of {ray:?}, depth {depth}, {crossings:?}",
                    case.name
                );
                judged += 1;
                inside_count += usize::from(inside);
            }
        }
        assert!(
            judged > 300 * rays && inside_count > 5 * rays,
            "{}: {judged} {inside_count}",
            case.name
        );
    }
}

/// Areas by Pappus and Guldin, and points that lie on the surface and are spread evenly: each half-space holds its
/// share (50 000 points; a share off by 0.015 is beyond six standard deviations).
#[test]
fn points_are_spread_by_area() {
    let torus = built(
        "torus",
        vec![number("major_radius", 1.0), number("minor_radius", 0.4)],
    );
    assert!((torus.area() - 4.0 * PI * PI * 0.4).abs() < 1e-12);
    for (major, minor) in [(0.6_f64, 0.6_f64), (0.4, 0.7), (1e-9, 1.0)] {
        let radii = vec![number("major_radius", major), number("minor_radius", minor)];
        // The arc that does not reach over the axis, by Pappus and Guldin; at last a sphere.
        let angle = etalon_math::float64::acos(-major / minor);
        let expected = 4.0 * PI * minor * (major * angle + (minor * minor - major * major).sqrt());
        let area = built("torus", radii).area();
        assert!((area - expected).abs() < 1e-12, "{area} {expected}");
    }
    let cone = built("cone", vec![number("radius0", 0.3), number("radius1", 0.9)]);
    let slant = (1.0_f64 + 0.36).sqrt();
    assert!((cone.area() - PI * (1.2 * slant + 0.09 + 0.81)).abs() < 1e-12);
    for case in cases() {
        let shape = case.geometry.shape(ShapeId(0));
        if !shape.can_emit() {
            continue;
        }
        let mut random = Random(11);
        let (mut found, mut outer, mut upper) = (0.0, 0.0, 0.0);
        const COUNT: u32 = 50_000;
        for _ in 0..COUNT {
            let sampled = case.geometry.sample_area(ShapeId(0), random.square(), 0.0);
            if sampled.density == 0.0 {
                continue;
            }
            let p = sampled.point.position.as_dvec3();
            assert!(
                (case.depth)(p).abs() < 1e-5,
                "{}: {p} is off the surface",
                case.name
            );
            let outside = p + sampled.point.normal.as_dvec3() * 1e-3;
            assert!(
                (case.depth)(outside) < 0.0,
                "{}: the normal at {p} points inside",
                case.name
            );
            found += 1.0;
            outer += f64::from(u8::from(p.truncate().length() > 1.0));
            upper += f64::from(u8::from(p.z > 0.25));
        }
        let [outer, upper] = [outer, upper].map(|count: f64| count / found);
        let expected = match case.name {
            // ∫ (R + r cos v) dv over |v| < π/2, and over sin v > 5/8.
            "torus" => Some([
                0.5 + 0.4 / PI,
                0.5 - etalon_math::float64::asin(0.25 / 0.4) / PI,
            ]),
            "truncated cone" => {
                let r = 0.3 + 0.6 * 0.25;
                let side = PI * slant * (0.9 * 0.9 - r * r) / 0.6;
                Some([0.0, (side + PI * 0.81) / shape.area()])
            }
            _ => None,
        };
        for (seen, expected) in [outer, upper]
            .into_iter()
            .zip(expected.into_iter().flatten())
        {
            assert!(
                (seen - expected).abs() < 0.015,
                "{}: {seen} for {expected}",
                case.name
            );
        }
        // Points off the boundary of a solid of solids count as zero.
        let of_solids = matches!(case.name, "union" | "intersection" | "difference");
        if of_solids {
            let (r, s): (f64, f64) = (0.9, 0.8);
            let d = (0.9_f64 * 0.9 + 0.1 * 0.1).sqrt();
            let cap = |r: f64, s: f64| 2.0 * PI * r * (r - (d * d + r * r - s * s) / (2.0 * d));
            let (all, caps) = (4.0 * PI * (r * r + s * s), [cap(r, s), cap(s, r)]);
            let area = match case.name {
                "union" => all - caps[0] - caps[1],
                "intersection" => caps[0] + caps[1],
                _ => 4.0 * PI * r * r - caps[0] + caps[1],
            };
            assert!(
                (found / f64::from(COUNT) - area / all).abs() < 0.015,
                "{}",
                case.name
            );
        } else if case.name != "nested" && case.name != "coincident faces" {
            assert!(found == f64::from(COUNT), "{}: {found}", case.name);
        }
    }
}

#[test]
fn mistakes() {
    let message = |plugin, properties| make(plugin, properties).1;
    assert!(message("torus", vec![number("minor_radius", -2.0)]).contains("positive finite"));
    assert!(message("cone", vec![vector("p1", 0.0, 0.0, 0.0)]).contains("must differ"));
    assert!(message("cone", vec![number("radius0", 0.0)]).contains("above 0"));
    assert!(message("ellipsoid", vec![vector("radii", 1.0, 0.0, 1.0)]).contains("positive"));
    assert!(message("quadric", vec![vector("min", 1.0, 0.0, 0.0)]).contains("above `min`"));
    assert!(!built("disk", vec![]).is_solid() && !built("cylinder", vec![]).is_solid());
    assert!(built("cube", vec![]).is_solid() && ball(0.0, 0.0, 0.0, 1.0).is_solid());
}
