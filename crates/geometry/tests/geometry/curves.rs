//! Curves from files against dense sampling: of the balls of a polyline, and of the circles of a spline.

use crate::curve_files::{curve_file, good_curves};
use crate::description::make;
use crate::things::{Random, geometry_of};
use etalon_geometry::Shape;
use etalon_params::Value;
use etalon_transport::Ray;
use glam::DVec3;

fn file(plugin: &str) -> Shape {
    let (shape, messages) = make(
        plugin,
        vec![("filename", Value::String(curve_file(plugin).into()))],
    );
    shape.unwrap_or_else(|| panic!("{messages}"))
}

/// The control points of the curves: position and radius.
fn control_points() -> Vec<Vec<(DVec3, f64)>> {
    let number = |word: &str| word.parse::<f64>().expect("a number");
    let point = |line: &str| {
        let n: Vec<f64> = line.split(' ').map(number).collect();
        (DVec3::new(n[0], n[1], n[2]), n[3])
    };
    (good_curves().split("\n\n"))
        .map(|curve| curve.lines().map(point).collect())
        .collect()
}

/// How far a point is outside of the balls of polylines.
fn outside_of_balls(p: DVec3) -> f64 {
    let mut nearest = f64::INFINITY;
    for curve in control_points() {
        for pair in curve.windows(2) {
            for k in 0..=400 {
                let v = f64::from(k) / 400.0;
                let (c, r) = (
                    pair[0].0.lerp(pair[1].0, v),
                    pair[0].1 + v * (pair[1].1 - pair[0].1),
                );
                nearest = nearest.min(p.distance(c) - r);
            }
        }
    }
    nearest
}

/// How far a point is outside of the circles of splines; infinite where it is across none.
fn outside_of_circles(p: DVec3) -> f64 {
    let mut nearest = f64::INFINITY;
    for curve in control_points() {
        for four in curve.windows(4) {
            let weights = |u: f64| {
                let rest = 1.0 - u;
                [
                    rest.powi(3),
                    3.0 * u.powi(3) - 6.0 * u * u + 4.0,
                    3.0 * rest.powi(3) - 6.0 * rest * rest + 4.0,
                    u.powi(3),
                ]
            };
            let at = |u: f64| {
                let w = weights(u);
                let c: DVec3 = (0..4).map(|i| four[i].0 * (w[i] / 6.0)).sum();
                let r: f64 = (0..4).map(|i| four[i].1 * (w[i] / 6.0)).sum();
                (c, r)
            };
            let across = |u: f64| {
                let (a, b) = (at(u - 1e-5).0, at(u + 1e-5).0);
                (p - at(u).0).dot(b - a)
            };
            for k in 0..200 {
                let [u, v] = [k, k + 1].map(|k| f64::from(k) / 200.0);
                let (a, b) = (across(u), across(v));
                if (a < 0.0) != (b < 0.0) {
                    let (c, r) = at(u + (v - u) * a / (a - b));
                    nearest = nearest.min(p.distance(c) - r);
                }
            }
        }
    }
    nearest
}

/// 300 rays each, looked at every 5 mm. A ray is judged unless it comes near a silhouette. Mutants refused: an end's
/// ball left out, a normal without the radius's slope, the farther side of a circle.
#[test]
fn first_entries_are_found() {
    type Outside = fn(DVec3) -> f64;
    let kinds: [(&str, Outside); 3] = [
        ("linearcurve", outside_of_balls),
        ("bsplinecurve", outside_of_circles),
        ("beziercurve", outside_of_circles),
    ];
    for (plugin, outside) in kinds {
        let geometry = geometry_of([file(plugin)]);
        let mut random = Random(2);
        let mut judged = 0;
        for index in 0..300 {
            let origin = random.point() * 1.2;
            let target = random.point() * 0.4;
            let direction = if index % 5 == 0 {
                glam::Vec3::new(-0.0, 1.0, -0.0)
            } else {
                (target - origin).normalize()
            };
            let ray = Ray::new(origin, direction, 0.0);
            let (o, d) = (origin.as_dvec3(), direction.as_dvec3());
            let step = 0.005;
            let looks: Vec<f64> = (0..500)
                .map(|k| outside(o + d * (f64::from(k) * step)))
                .collect();
            let sure = 0.01;
            if looks[0] < sure {
                continue;
            }
            let entered = looks.iter().position(|depth| *depth < 0.0);
            let until = entered.unwrap_or(looks.len());
            // Whether it goes in for sure, and does not only come near.
            let deep = looks[until..].iter().take(6).any(|depth| *depth < -sure);
            let near = looks[..until.saturating_sub(6)]
                .iter()
                .any(|depth| *depth < sure);
            // Through an end, which is open.
            let jumps = until > 0 && entered.is_some() && looks[until - 1] > 3.0 * step;
            if near || jumps || (entered.is_some() && !deep) {
                continue;
            }
            judged += 1;
            let hit = geometry.intersect(&ray);
            let Some(entered) = entered else {
                assert!(
                    hit.is_none_or(|hit| hit.t > 2.49),
                    "{plugin}: {ray:?} {hit:?}"
                );
                continue;
            };
            let hit = hit.unwrap_or_else(|| panic!("{plugin}: {ray:?} {entered}"));
            let t = f64::from(hit.t);
            assert!(
                t <= entered as f64 * step + 1e-3 && t >= (entered as f64 - 6.0) * step,
                "{plugin}: {ray:?} {t} {entered}"
            );
            let vertex = geometry.vertex(&ray, &hit);
            assert!(vertex.normal.dot(direction) < 0.0);
            let p = vertex.position.as_dvec3();
            let off = outside(p);
            assert!(off.abs() < 2e-4, "{plugin}: {ray:?} {off}");
            // Along the normal the surface is left behind, across it is not.
            let n = vertex.normal.as_dvec3();
            let gain = outside(p + n * 1e-3) - off;
            let side = n.any_orthonormal_vector();
            let sideways = outside(p + side * 1e-3) - outside(p - side * 1e-3);
            assert!(
                gain > 5e-4 && sideways.abs() < 4e-4,
                "{plugin}: {ray:?} {gain} {sideways}"
            );
            // The next ray does not meet what it leaves.
            let leaving = vertex.spawn(vertex.normal);
            let again = geometry.intersect(&leaving);
            assert!(
                again.is_none_or(|again| again.t > 1e-3),
                "{plugin}: {ray:?}"
            );
        }
        assert!(judged > 100, "{plugin}: {judged}");
    }
}

#[test]
fn mistakes() {
    let messages = |plugin: &str, file: &str| {
        let (shape, messages) = make(plugin, vec![("filename", Value::String(file.into()))]);
        assert!(shape.is_none());
        messages
    };
    assert!(messages("linearcurve", "short").contains("line 5"));
    assert!(messages("linearcurve", "words").contains("line 1: `0 0 zero 1`"));
    assert!(messages("bsplinecurve", "three").contains("4 or more"));
    assert!(messages("beziercurve", "good").contains("it takes 4 and 3 for each further piece"));
    assert!(messages("bsplinecurve", "absent").contains("no file `absent`"));
    let (shape, messages) = make("linearcurve", Vec::new());
    assert!(shape.is_none() && messages.contains("filename"));
}

/// Coordinates along each of three pieces are the usual ones in other order, of a piece instead of all.
///
/// Mutants refused: u along all pieces, ∂p/∂u around.
#[test]
fn coordinates_may_run_along_each_piece() {
    let bezier = |coordinates: &str| {
        let properties = vec![
            ("filename", Value::String("bezier".into())),
            ("coordinates", Value::String(coordinates.into())),
        ];
        let (shape, messages) = make("beziercurve", properties);
        geometry_of([shape.unwrap_or_else(|| panic!("{messages}"))])
    };
    let [around, along] = ["around", "along"].map(bezier);
    let mut random = Random(5);
    let mut seen = [0; 3];
    for _ in 0..2000 {
        let origin = random.point() * 1.2;
        let ray = Ray::new(origin, (random.point() * 0.4 - origin).normalize(), 0.0);
        let (Some(a), Some(b)) = (around.intersect(&ray), along.intersect(&ray)) else {
            continue;
        };
        let (a, b) = (around.vertex(&ray, &a), along.vertex(&ray, &b));
        let whole = 3.0 * a.uv.y;
        if (whole - whole.round()).abs() < 1e-4 {
            continue;
        }
        seen[whole as usize] += 1;
        assert!(
            (b.uv.x - whole.fract()).abs() < 1e-5 && b.uv.y == a.uv.x,
            "{} {}",
            a.uv,
            b.uv
        );
        assert!(b.dp_dv == a.dp_du && (b.dp_du * 3.0 - a.dp_dv).length() < 1e-4 * a.dp_dv.length());
    }
    assert!(seen.iter().all(|count| *count > 10), "{seen:?}");
}
