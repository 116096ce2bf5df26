//! Solids that functions bound, for the tests of [`crate::solids`].

use crate::files::good_volume;
use crate::solids::{Depth, ball, built, combine, in_ball, number, vector};
use core::f64::consts::PI;
use etalon_geometry::Shape;
use etalon_geometry::shapes::csg::Operation;
use etalon_math::float64::{exp, ln};
use etalon_params::{DVec3, Value};
use glam::DVec2;

const BALLS: &str = "-0.4 0 0 0.9 1, 0.4 0.1 0 0.8 1.2, 0 0.1 0.4 0.5 -0.6";

fn superellipsoid(e: f64, n: f64) -> Depth {
    Box::new(move |p: DVec3| {
        let of = |x: f64, power: f64| exp(power * ln(x.abs()));
        let around = of(p.x, 2.0 / e) + of(p.y, 2.0 / e);
        1.0 - of(around, e / n) - of(p.z, 2.0 / n)
    })
}

/// Surfaces of functions, whole and cut by their boxes, by both methods, placed, and as operands.
pub(crate) fn implicit_cases() -> Vec<(&'static str, Shape, Depth)> {
    let implicit = |text: &str, mut more: Vec<(&'static str, Value)>| {
        more.push(("function", Value::String(text.into())));
        built("implicit", more)
    };
    let in_box = |p: DVec3, half: f64| half - p.abs().max_element();
    let gyroid = |p: DVec3| {
        let (s, c) = (
            (p * 4.0).map(etalon_math::float64::sin),
            (p * 4.0).map(etalon_math::float64::cos),
        );
        (s.x * c.y + s.y * c.z + s.z * c.x).abs() - 0.5
    };
    let gyroid_text = "abs(sin(4*x)*cos(4*y) + sin(4*y)*cos(4*z) + sin(4*z)*cos(4*x)) - 0.5";
    let rough = |p: DVec3| p.length() - 0.8 + 0.2 * etalon_math::noise::noise(p * 3.0);
    let corner = |x: f64| vec![vector("min", -x, -x, -x), vector("max", x, x, x)];
    let marched = || {
        let mut more = corner(1.5);
        more.push(("method", Value::String("march".into())));
        more.push(number("step", 0.0002));
        more
    };
    let ring = "(sqrt(x*x + y*y) - 1)^2 + z^2 - 0.16";
    let ring_depth = |p: DVec3| {
        let r = p.truncate().length() - 1.0;
        0.16 - r * r - p.z * p.z
    };
    let revolution = |profile: &str, curve: &str, closed: bool| {
        let text = |value: &str| Value::String(value.into());
        let closed = ("closed", Value::Boolean(closed));
        built(
            "revolution",
            vec![("profile", text(profile)), ("curve", text(curve)), closed],
        )
    };
    let corners = [(0.4, -0.5), (1.2, 0.1), (0.5, 0.7)];
    let in_triangle = move |p: DVec3| {
        let c = DVec2::new(p.truncate().length(), p.z);
        let corner = |i: usize| DVec2::from(corners[i % 3]);
        (0..3)
            .map(|i| {
                let (a, b) = (corner(i), corner(i + 1));
                (b - a).normalize().perp().dot(c - a)
            })
            .fold(f64::INFINITY, f64::min)
    };
    // r = s, z = 1 − s² down to the ground, and back along it.
    let dome = "0 1, 0.33333333333333333 1, 0.66666666666666667 0.66666666666666667, 1 0, \
                0.66666666666666667 0, 0.33333333333333333 0, 0 0";
    let parametric = |plugin: &str, x: &str, y: &str| {
        let text = |value: &str| Value::String(value.into());
        let (curve, x, y) = (
            ("curve", text("parametric")),
            ("x", text(x)),
            ("y", text(y)),
        );
        built(plugin, vec![curve, x, y, number("to", 2.0 * PI)])
    };
    let centred = || {
        let scaled = etalon_params::DMat4::from_scale(DVec3::new(2.4, 2.0, -2.2));
        let moved = etalon_params::DMat4::from_translation(DVec3::new(-1.2, -1.0, 1.1));
        moved * scaled
    };
    let to_grid = centred().inverse();
    let corners: Vec<f64> = {
        let bytes = good_volume();
        let four = |word: &[u8]| f32::from_le_bytes([word[0], word[1], word[2], word[3]]);
        bytes[48..]
            .chunks_exact(4)
            .map(|word| four(word).into())
            .collect()
    };
    // The grid's own interpolation.
    let in_grid = move |p: DVec3| {
        let p = to_grid.transform_point3(p);
        let border = (0.5 - (p - 0.5).abs().max_element()).max(-1.0);
        let q = p.clamp(DVec3::ZERO, DVec3::ONE) * DVec3::new(8.0, 7.0, 6.0);
        let cell = q.floor().min(DVec3::new(7.0, 6.0, 5.0));
        let at = q - cell;
        let mut sum = 0.0;
        for corner in 0..8 {
            let upper = [corner & 1, corner >> 1 & 1, corner >> 2];
            let weight: f64 = (0..3)
                .map(|i| if upper[i] == 1 { at[i] } else { 1.0 - at[i] })
                .product();
            let [x, y, z] = core::array::from_fn(|i| cell[i] as usize + upper[i]);
            sum += weight * corners[(z * 8 + y) * 9 + x];
        }
        (-sum).min(border)
    };
    vec![
        (
            "a grid, of a function",
            built(
                "sdfgrid",
                vec![
                    ("filename", Value::String("volume".into())),
                    ("normals", Value::String("analytic".into())),
                    ("to_world", Value::Transform(centred())),
                ],
            ),
            Box::new(in_grid),
        ),
        (
            "rounded box, of a function",
            built("superellipsoid", vec![number("e", 0.4), number("n", 0.3)]),
            superellipsoid(0.4, 0.3),
        ),
        (
            "star, of a function",
            built("superellipsoid", vec![number("e", 2.5), number("n", 1.5)]),
            superellipsoid(2.5, 1.5),
        ),
        (
            "blob with a dent, of a function",
            built("blob", vec![("balls", Value::String(BALLS.into()))]),
            Box::new(|p: DVec3| {
                let balls = BALLS.split(", ").map(|ball| {
                    let n: Vec<f64> = ball.split(' ').flat_map(str::parse).collect();
                    let off = p - DVec3::new(n[0], n[1], n[2]);
                    n[4] * (1.0 - off.length_squared() / (n[3] * n[3]))
                        .max(0.0)
                        .powi(2)
                });
                balls.sum::<f64>() - 0.5
            }),
        ),
        (
            "quaternions, of a function",
            built("julia", vec![("iterations", Value::Integer(3))]),
            Box::new(|p: DVec3| {
                let (mut a, mut v) = (p.x, DVec3::new(p.y, p.z, 0.0));
                for _ in 0..3 {
                    let real = a * a - v.length_squared() - 0.08;
                    v = 2.0 * a * v + DVec3::new(0.0, -0.83, -0.025);
                    a = real;
                }
                let box_depth = 1.5 - p.abs().max_element();
                (4.0 - a * a - v.length_squared()).min(box_depth)
            }),
        ),
        (
            "revolved circle of expressions, of a function",
            parametric("revolution", "1 + 0.4*cos(t)", "0.4*sin(t)"),
            Box::new(ring_depth),
        ),
        (
            "extruded ellipse of expressions, of a function",
            parametric("extrusion", "0.9*cos(t)", "-0.5*sin(t)"),
            Box::new(|p: DVec3| {
                let r = DVec2::new(p.x / 0.9, p.y / 0.5).length();
                (1.0 - r).min(p.z).min(1.0 - p.z)
            }),
        ),
        (
            "extruded eight of expressions without a ball, of a function",
            combine(
                Operation::Difference,
                vec![
                    parametric("extrusion", "sin(t)", "0.5*sin(2*t)"),
                    ball(0.0, 0.0, 1.0, 0.6),
                ],
            ),
            // Which turns one of its lobes inside out.
            Box::new(|p: DVec3| {
                let inside = p.x * p.x * (1.0 - p.x * p.x) - p.y * p.y;
                let end = p.z.min(1.0 - p.z);
                inside.min(end).min(-in_ball(p, 0.0, 0.0, 1.0, 0.6))
            }),
        ),
        (
            "revolved triangle, of a function",
            revolution("0.4 -0.5, 1.2 0.1, 0.5 0.7", "linear", true),
            Box::new(in_triangle),
        ),
        (
            "revolved parabola, of a function",
            revolution(dome, "bezier", false),
            Box::new(|p: DVec3| (1.0 - p.truncate().length_squared() - p.z).min(p.z)),
        ),
        (
            "profile of a torus, of a function",
            implicit("(x - 1)^2 + y^2 - 0.16", {
                let mut more = corner(1.5);
                more.push(("profile", Value::String("revolution".into())));
                more
            }),
            Box::new(ring_depth),
        ),
        (
            "implicit torus, of a function",
            implicit(ring, corner(1.5)),
            Box::new(ring_depth),
        ),
        (
            "marched torus, of a function",
            implicit(ring, marched()),
            Box::new(ring_depth),
        ),
        (
            "gyroid, of a function",
            implicit(gyroid_text, Vec::new()),
            Box::new(move |p| (-gyroid(p)).min(in_box(p, 1.0))),
        ),
        (
            "rough ball without a ball, of a function",
            combine(
                Operation::Difference,
                vec![
                    implicit(
                        "sqrt(x^2+y^2+z^2) - 0.8 + 0.2*noise(3*x, 3*y, 3*z)",
                        Vec::new(),
                    ),
                    ball(0.3, 0.2, 0.5, 0.5),
                ],
            ),
            Box::new(move |p| (-rough(p)).min(-in_ball(p, 0.3, 0.2, 0.5, 0.5))),
        ),
        (
            "a pole, of a function",
            implicit("0.3 / z + x*x - y", Vec::new()),
            Box::new(move |p| {
                let f = 0.3 / p.z + p.x * p.x - p.y;
                (-f * p.z.abs()).min(in_box(p, 1.0))
            }),
        ),
        (
            "not defined for negative x, of a function",
            implicit("0.3 - sqrt(x) - y", Vec::new()),
            Box::new(move |p| {
                let f = 0.3 - p.x.max(0.0).sqrt() - p.y;
                (-f).min(p.x).min(in_box(p, 1.0))
            }),
        ),
    ]
}
