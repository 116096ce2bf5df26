//! Curves as tubes and strokes: areas and outlines against formulas and distances.

use crate::description::make;
use crate::things::{Random, geometry_of};
use core::f64::consts::PI;
use etalon_geometry::{Geometry, Shape};
use etalon_math::float64::{cos, sin};
use etalon_params::Value;
use etalon_transport::{Ray, ShapeId, Shapes};
use glam::{DVec2, DVec3, Vec3};

fn text(name: &'static str, value: &str) -> (&'static str, Value) {
    (name, Value::String(value.into()))
}

fn number(name: &'static str, value: f64) -> (&'static str, Value) {
    (name, Value::Float(value))
}

fn drawn(properties: Vec<(&'static str, Value)>) -> Shape {
    let (shape, messages) = make("curve", properties);
    shape.unwrap_or_else(|| panic!("{messages}"))
}

fn circle() -> Vec<(&'static str, Value)> {
    vec![
        text("curve", "parametric"),
        text("x", "cos(2*pi*t)"),
        text("y", "sin(2*pi*t)"),
        number("width", 0.3),
    ]
}

fn with(
    mut properties: Vec<(&'static str, Value)>,
    more: Vec<(&'static str, Value)>,
) -> Vec<(&'static str, Value)> {
    properties.extend(more);
    properties
}

/// A name, its properties, its area by a formula, and whether it bounds a volume.
type Case = (&'static str, Vec<(&'static str, Value)>, f64, bool);

fn cases() -> Vec<Case> {
    let flat = || text("style", "flat");
    let points = |points: &str, width: f64| vec![text("points", points), number("width", width)];
    let ends = |kind: &str| text("ends", kind);
    let (r, w) = (0.15, 0.3);
    let lemniscate = "(x^2 + y^2)^2 - (x^2 - y^2)";
    let implicit = |function: &str, width: f64| {
        let range = |name, x: f64| (name, Value::Vector(DVec3::splat(x)));
        vec![
            text("curve", "implicit"),
            text("function", function),
            range("min", -1.21),
            range("max", 1.2),
            number("width", width),
        ]
    };
    vec![
        ("torus", circle(), 4.0 * PI * PI * r, true),
        ("ring", with(circle(), vec![flat()]), 2.0 * PI * w, false),
        (
            "rod",
            points("0 0 0, 2 1 2", w),
            2.0 * PI * r * 3.0 + 2.0 * PI * r * r,
            true,
        ),
        (
            "pill",
            with(points("0 0 0, 2 1 2", w), vec![ends("round")]),
            2.0 * PI * r * 3.0 + 4.0 * PI * r * r,
            true,
        ),
        (
            "pipe",
            with(points("0 0 0, 2 1 2", w), vec![ends("open")]),
            2.0 * PI * r * 3.0,
            false,
        ),
        (
            "cone",
            vec![text("points", "0 0 0, 0 0 2"), text("widths", "1, 0")],
            PI * 0.5 * 4.25_f64.sqrt() + PI * 0.25,
            true,
        ),
        (
            "bar",
            with(points("0 0 0, 2 0 0", w), vec![flat()]),
            2.0 * w,
            false,
        ),
        (
            "capsule",
            with(points("0 0 0, 2 0 0", w), vec![flat(), ends("round")]),
            2.0 * w + PI * r * r,
            false,
        ),
        // Two bars at a right angle share a quarter of w²; a quarter of a disk rounds their corner.
        (
            "corner",
            with(points("-2 0 0, 0 0 0, 0 2 0", w), vec![flat()]),
            4.0 * w - w * w / 4.0 + PI * r * r / 4.0,
            false,
        ),
        // Crossing itself: what both cover counts once.
        (
            "cross",
            with(
                points("-1 0 0, 1 0 0, 1 1 0, 0 1 0, 0 -1 0", 0.1),
                vec![flat()],
            ),
            6.0 * 0.1 - 0.01 - 3.0 * (0.01 / 4.0 - PI * 0.01 / 16.0),
            false,
        ),
        // Width 0 at the ends and in the middle of a straight line: two lenses of 0.3 (2/π) each.
        (
            "lenses",
            vec![
                text("points", "0 0 0, 2 0 0"),
                text("width", "0.3*abs(sin(2*pi*u))"),
                flat(),
            ],
            2.0 * 0.3 * 2.0 / PI,
            false,
        ),
        // Of length 4 ϖ/2 = 5.244115…, the branches crossing at a right angle.
        (
            "lemniscate",
            with(implicit(lemniscate, 0.04), vec![flat()]),
            5.244_115_1 * 0.04 - 0.0016,
            false,
        ),
        (
            "implicit torus",
            implicit("x^2 + y^2 - 1", w),
            4.0 * PI * PI * r,
            true,
        ),
        (
            "square",
            with(
                points("0 0 0, 1 0 0, 1 1 0, 0 1 0", 0.2),
                vec![("closed", Value::Boolean(true)), flat()],
            ),
            4.0 * 0.2 - 4.0 * (0.04 / 4.0 - PI * 0.04 / 16.0),
            false,
        ),
        // Tapering to nothing: w₀ L / 2.
        (
            "taper",
            with(circle(), vec![flat()])
                .into_iter()
                .filter(|(name, _)| *name != "width")
                .chain([text("width", "0.3*(1 - u)")])
                .collect(),
            0.5 * 2.0 * PI * 0.3,
            false,
        ),
    ]
}

/// Facets take some (π/48)²/6 of an area; the loops of the lemniscate, whose corners are round, 4 parts in a thousand. Overlaps
/// that counted twice would add 0.7 % or more to `corner`, `cross`, `lemniscate` and `square`.
#[test]
fn areas_are_those_of_formulas() {
    for (name, properties, expected, closed) in cases() {
        let shape = drawn(properties);
        assert_eq!(!shape.is_open(), closed, "{name}");
        let area = f64::from(geometry_of([shape]).area(ShapeId(0), 0.0));
        let allowed = if name == "lemniscate" { 5e-3 } else { 2e-3 };
        assert!(
            (area / expected - 1.0).abs() < allowed,
            "{name}: {area} {expected}"
        );
    }
}

fn meets(geometry: &Geometry, from: Vec3, direction: Vec3) -> Option<(f64, Vec3)> {
    let ray = Ray::new(from, direction, 0.0);
    let hit = geometry.intersect(&ray)?;
    let vertex = geometry.vertex(&ray, &hit);
    Some((f64::from(hit.t), vertex.shading.n))
}

/// Whether a place is on a stroke is known from its distance to the curve, but for a thousandth of the width at the edge.
#[test]
fn strokes_end_where_the_distance_says() {
    let ellipse = |t: f64| DVec2::new(cos(2.0 * PI * t), 0.5 * sin(2.0 * PI * t));
    let width = 0.2;
    let properties = vec![
        text("curve", "parametric"),
        text("x", "cos(2*pi*t)"),
        text("y", "0.5*sin(2*pi*t)"),
        number("width", width),
        text("style", "flat"),
    ];
    let geometry = geometry_of([drawn(properties)]);
    let mut random = Random(5);
    let mut told = [0; 2];
    for _ in 0..4000 {
        let p = random.point() * Vec3::new(1.2, 0.7, 0.0);
        let at = DVec2::new(p.x.into(), p.y.into());
        // Golden-section search from the best of some places.
        let off = |t: f64| ellipse(t).distance(at);
        let best = (0..400)
            .map(|k| f64::from(k) / 400.0)
            .min_by(|a, b| off(*a).total_cmp(&off(*b)));
        let (mut low, mut high) = (best.expect("some") - 0.0025, best.expect("some") + 0.0025);
        for _ in 0..40 {
            let (a, b) = (low + 0.382 * (high - low), low + 0.618 * (high - low));
            if off(a) < off(b) { high = b } else { low = a }
        }
        let inside = 0.5 * width - off(0.5 * (low + high));
        if inside.abs() > 2e-3 * width {
            let found = meets(&geometry, p + Vec3::Z, Vec3::NEG_Z);
            assert_eq!(found.is_some(), inside > 0.0, "{at}: {inside}");
            told[usize::from(inside > 0.0)] += 1;
        }
    }
    assert!(told[0] > 500 && told[1] > 500, "{told:?}");
}

/// Rays at a tube around a circle meet it where they meet the torus; its normals are the torus's.
#[test]
fn a_tube_around_a_circle_is_a_torus() {
    let tube = geometry_of([drawn(circle())]);
    let radii = vec![number("major_radius", 1.0), number("minor_radius", 0.15)];
    let (torus, messages) = make("torus", radii);
    let torus = geometry_of([torus.unwrap_or_else(|| panic!("{messages}"))]);
    let mut random = Random(7);
    let (mut hits, mut differ) = (0, 0);
    for _ in 0..4000 {
        let from = random.direction() * 3.0;
        let to = random.point() * Vec3::new(1.2, 1.2, 0.2);
        let direction = (to - from).normalize();
        match (
            meets(&tube, from, direction),
            meets(&torus, from, direction),
        ) {
            (Some((t, n)), Some((exact, normal))) => {
                let cos = f64::from(direction.dot(normal)).abs();
                if cos > 0.3 {
                    assert!((t - exact).abs() < 1e-3 / cos, "{t} {exact}");
                    assert!(n.dot(normal) > 0.999, "{n} {normal}");
                    hits += 1;
                }
            }
            (None, None) => {}
            _ => differ += 1,
        }
    }
    assert!(hits > 1000 && differ < 20, "{hits} {differ}");
}

/// u runs along the curve, v around the tube or across the stroke, from right to left.
#[test]
fn texture_coordinates_run_along() {
    let along = vec![text("profile", "0 0, 4 0"), number("width", 0.4)];
    let stroke = geometry_of([drawn(with(along.clone(), vec![text("style", "flat")]))]);
    let ray = Ray::new(Vec3::new(1.0, 0.1, 1.0), Vec3::NEG_Z, 0.0);
    let vertex = stroke.vertex(&ray, &stroke.intersect(&ray).expect("it is there"));
    assert!(
        (vertex.uv.as_dvec2() - DVec2::new(0.25, 0.75)).length() < 1e-5,
        "{}",
        vertex.uv
    );
    assert!(vertex.dp_du.as_dvec3().distance(DVec3::X * 4.0) < 1e-4);
    let tube = geometry_of([drawn(along)]);
    let vertex = tube.vertex(&ray, &tube.intersect(&ray).expect("it is there"));
    assert!((f64::from(vertex.uv.x) - 0.25).abs() < 1e-5);
    assert!(vertex.dp_du.as_dvec3().distance(DVec3::X * 4.0) < 1e-3);
    assert!(vertex.dp_dv.dot(Vec3::X).abs() < 1e-4);
}

/// What is wrong is said of the parameter that is.
#[test]
fn mistakes_are_told() {
    let flat = || text("style", "flat");
    let cases: Vec<(Vec<(&'static str, Value)>, &str)> = vec![
        (vec![], "`curve` needs the parameter `points`"),
        (
            vec![text("points", "0 0 0, 1 1")],
            "`points` has 5 numbers; a `linear` one takes two points or more, 3 numbers each",
        ),
        (vec![text("points", "1 1 1, 1 1 1")], "has no length"),
        (
            vec![text("points", "0 0 0, 1 0 0"), text("profile", "0 0, 1 1")],
            "both say where this curve runs",
        ),
        (
            vec![text("points", "0 0 0, 1 0 0"), flat(), text("ends", "open")],
            "no lids",
        ),
        (
            vec![text("points", "0 0 0, 1 0 1"), flat()],
            "lies in the plane z = 0",
        ),
        (
            vec![text("points", "0 0 0, 1 0 1"), text("widths", "1, 2, 3")],
            "`widths` has 3 numbers for 2 points",
        ),
        (
            vec![text("points", "0 0 0, 1 0 1"), number("width", 0.0)],
            "its width is 0",
        ),
        (
            vec![text("points", "0 0 0, 1 0 1"), text("width", "0.1*t")],
            "unknown name `t`",
        ),
        (
            vec![text("curve", "parametric"), text("x", "t")],
            "needs the parameter `y`",
        ),
        (
            vec![
                text("curve", "parametric"),
                text("x", "sqrt(t - 0.5)"),
                text("y", "t"),
            ],
            "not defined, or has no direction, at t = 0",
        ),
        (
            vec![text("curve", "implicit"), text("function", "x^2 + y^2 + 1")],
            "does not change its sign",
        ),
        (
            vec![text("curve", "implicit"), text("function", "x + z")],
            "unknown name `z`",
        ),
        (
            vec![text("points", "0 0 0, 1 0 1"), ("sides", Value::Integer(2))],
            "cannot be 2",
        ),
    ];
    for (properties, said) in cases {
        let (shape, messages) = make("curve", properties);
        assert!(
            shape.is_none() && messages.contains(said),
            "{said}: {messages}"
        );
    }
}
