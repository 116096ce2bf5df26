//! Clouds of ellipsoids against quadratic equations.

use crate::description::make;
use crate::solids::{built, number};
use crate::things::{Random, geometry_of};
use etalon_geometry::Shape;
use etalon_math::float64::{exp, ln};
use etalon_params::{DMat4, Value};
use etalon_transport::{Ray, ShapeId, Shapes};
use glam::{DAffine3, DVec3, Vec2, Vec3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

pub(crate) const COLUMNS: &str = "vertex_scale:3,vertex_rot:4";

/// A row of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub(crate) center: [f32; 3],
    /// Logarithms.
    pub(crate) scale: [f32; 3],
    /// The real part first; of any length.
    pub(crate) rotation: [f32; 4],
}

fn row() -> impl Strategy<Value = Row> {
    let rotation = prop::array::uniform4(-1.0_f32..1.0);
    let long = |q: &[f32; 4]| q.iter().map(|x| x * x).sum::<f32>() > 0.01;
    let numbers = (
        prop::array::uniform3(-1.0_f32..1.0),
        prop::array::uniform3(-4.0_f32..-1.0),
        rotation.prop_filter("a rotation", long),
    );
    numbers.prop_map(|(center, scale, rotation)| Row {
        center,
        scale,
        rotation,
    })
}

fn text(numbers: &[f32]) -> String {
    let words: Vec<String> = numbers.iter().map(f32::to_string).collect();
    words.join(" ")
}

pub(crate) fn file(columns: &str, rows: &[String]) -> (&'static str, Value) {
    let contents = format!("{columns}|{}", rows.join(";"));
    ("filename", Value::String(contents))
}

pub(crate) fn cloud(rows: &[Row]) -> (&'static str, Value) {
    let text = |r: &Row| text(&[&r.center[..], &r.scale, &r.rotation].concat());
    file(COLUMNS, &rows.iter().map(text).collect::<Vec<_>>())
}

/// v turned by the quaternion w + u.
fn turned(rotation: [f32; 4], v: DVec3) -> DVec3 {
    let [w, x, y, z] = rotation.map(f64::from);
    let length = (w * w + x * x + y * y + z * z).sqrt();
    let (w, u) = (w / length, DVec3::new(x, y, z) / length);
    v + 2.0 * w * u.cross(v) + 2.0 * u.cross(u.cross(v))
}

impl Row {
    /// Its centre and the ends of its half axes.
    pub(crate) fn axes(&self, factor: f64, to_world: &DAffine3) -> (DVec3, [DVec3; 3]) {
        let axis = |i: usize| {
            let own = DVec3::AXES[i] * exp(f64::from(self.scale[i])) * factor;
            to_world.transform_vector3(turned(self.rotation, own))
        };
        let center = DVec3::from(self.center.map(f64::from));
        (
            to_world.transform_point3(center),
            [axis(0), axis(1), axis(2)],
        )
    }
}

/// Where p is in the coordinates of three axes: Cramer's rule.
fn coordinates([a, b, c]: [DVec3; 3], p: DVec3) -> DVec3 {
    let whole = a.dot(b.cross(c));
    DVec3::new(p.dot(b.cross(c)), a.dot(p.cross(c)), a.dot(b.cross(p))) / whole
}

/// Where a ray goes into an ellipsoid, and how far from grazing it is: the roots of A t² + 2 B t + C.
fn entry(ray: &Ray, center: DVec3, axes: [DVec3; 3]) -> (Option<f64>, f64) {
    let o = coordinates(axes, ray.origin.as_dvec3() - center);
    let d = coordinates(axes, ray.direction.as_dvec3());
    let (a, b, c) = (d.dot(d), o.dot(d), o.dot(o) - 1.0);
    let discriminant = b * b - a * c;
    let first = (-b - discriminant.sqrt()) / a;
    let clear = (discriminant / a).abs().min(c.abs());
    ((discriminant > 0.0 && first > 0.0).then_some(first), clear)
}

fn random_ray(random: &mut Random) -> Ray {
    let origin = random.point() * 2.0;
    let direction = (random.point() - origin).normalize();
    Ray::new(origin, direction, 0.0)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 200,
        rng_seed: RngSeed::Fixed(17),
        ..ProptestConfig::default()
    })]

    /// The nearest entry of any of them, from outside; its point, and its normal, the gradient of |coordinates|². A mutant
    /// that takes the quaternion's last number as its real part, or exp s for s, or the farther root, is refused.
    #[test]
    fn the_first_entry_is_found(
        rows in prop::collection::vec(row(), 1..6),
        extent in 0.5_f64..4.0,
        scale_factor in 0.5_f64..1.5,
        angle in 0.0..6.0_f64,
        stretch in prop::array::uniform3(0.5_f64..1.5),
        mirror in any::<bool>(),
        seed in any::<u64>(),
    ) {
        let stretch = DVec3::from(stretch) * if mirror { -1.0 } else { 1.0 };
        let matrix = DMat4::from_translation(DVec3::new(0.1, -0.2, 0.3))
            * DMat4::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), angle)
            * DMat4::from_scale(stretch);
        let shape = built("ellipsoids", vec![
            cloud(&rows),
            number("extent", extent),
            number("scale_factor", scale_factor),
            ("to_world", Value::Transform(matrix)),
        ]);
        let to_world = DAffine3::from_mat4(matrix);
        let all: Vec<_> = rows.iter().map(|r| r.axes(extent * scale_factor, &to_world)).collect();
        let geometry = geometry_of([shape]);
        let mut random = Random(seed);
        for _ in 0..100 {
            let ray = random_ray(&mut random);
            let entries: Vec<_> = all.iter().map(|(c, axes)| entry(&ray, *c, *axes)).collect();
            // Not decided by rounding.
            if entries.iter().any(|(_, clear)| *clear < 1e-4) {
                continue;
            }
            let nearest = (0..).zip(&entries).filter_map(|(i, (t, _))| Some((i, (*t)?)));
            let nearest = nearest.min_by(|a, b| a.1.total_cmp(&b.1));
            let hit = geometry.intersect(&ray);
            prop_assert_eq!(hit.is_some(), nearest.is_some(), "{:?}", ray);
            let (Some(hit), Some((index, t))) = (hit, nearest) else {
                prop_assert!(!geometry.occluded(&ray));
                continue;
            };
            prop_assert!(geometry.occluded(&ray));
            prop_assert!((f64::from(hit.t) - t).abs() < 1e-5, "{} {t}", hit.t);
            let vertex = geometry.vertex(&ray, &hit);
            prop_assert_eq!(vertex.primitive, index);
            let (center, axes) = all[index as usize];
            let p = vertex.position.as_dvec3();
            let outside = |p: DVec3| coordinates(axes, p - center).length();
            prop_assert!((outside(p) - 1.0).abs() < 1e-4);
            let slope = |e: DVec3| outside(p + e * 1e-6) - outside(p - e * 1e-6);
            let gradient = DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z));
            let aligned = gradient.normalize().dot(vertex.normal.as_dvec3());
            prop_assert!(aligned > 1.0 - 1e-6, "{aligned}");
            prop_assert!(vertex.normal.dot(ray.direction) < 0.0);
            for tangent in [vertex.dp_du, vertex.dp_dv] {
                prop_assert!(tangent.dot(vertex.normal).abs() < 1e-4 * tangent.length());
            }
        }
    }

    /// The box of one touches it on all six sides: c ± the root of the sum of the squares of the axes' coordinates.
    #[test]
    fn boxes_are_tight(row in row()) {
        let bounds = built("ellipsoids", vec![cloud(&[row])]).bounds();
        let (center, axes) = row.axes(3.0, &DAffine3::IDENTITY);
        let squares: DVec3 = axes.iter().map(|a| *a * *a).sum();
        let reach = DVec3::from(squares.to_array().map(f64::sqrt));
        let off = |a: Vec3, b: DVec3| (a.as_dvec3() - b).abs().max_element();
        prop_assert!(off(bounds.min, center - reach) < 2e-6);
        prop_assert!(off(bounds.max, center + reach) < 2e-6);
    }
}

/// The radius of a ball around the origin, seen along x.
fn radius(shape: Shape) -> Option<f64> {
    let geometry = geometry_of([shape]);
    let hit = geometry.intersect(&Ray::new(Vec3::X * 10.0, -Vec3::X, 0.0));
    hit.map(|hit| 10.0 - f64::from(hit.t))
}

/// Those that no Gaussian is seen of are left out, with their attributes; and a file of splats has logits.
#[test]
fn extents_follow_opacities() {
    let ball = |rest: &str| format!("0 0 0 0 0 0 1 0 0 0 {rest}");
    let adaptive = ("extent_adaptive_clamping", Value::Boolean(true));
    let plain = format!("{COLUMNS},vertex_opacities:1");
    let extent = |alpha: f64| 0.5 * (2.0 * ln(alpha / 0.01)).sqrt();
    let one = |columns: &str, rest: &str| {
        let properties = vec![
            file(columns, &[ball(rest)]),
            adaptive.clone(),
            number("extent", 1.5),
        ];
        radius(built("ellipsoids", properties)).expect("seen")
    };
    assert!((one(&plain, "0.7") - extent(0.7)).abs() < 1e-5);
    let splats = format!("{COLUMNS},vertex_opacity:1,vertex_f_dc:3");
    let alpha = 1.0 / (1.0 + exp(-0.4));
    assert!((one(&splats, "0.4 0 0 0") - extent(alpha)).abs() < 1e-5);
    // Two of three are left; what each of them has goes with it.
    let rows = ["0.5", "0.01", "0.9"].map(ball);
    let (shape, messages) = make("ellipsoids", vec![file(&plain, &rows), adaptive.clone()]);
    assert!(
        messages.contains("1 of its 3 ellipsoids have an opacity of 0.01 or less"),
        "{messages}"
    );
    let shape = shape.expect("a cloud");
    assert_eq!(shape.attributes()[0].values, [0.5, 0.9]);
    // Nothing is left.
    let (shape, _) = make(
        "ellipsoids",
        vec![file(&plain, &rows[1..2]), adaptive.clone()],
    );
    assert_eq!(radius(shape.expect("an empty cloud")), None);
    let (shape, messages) = make("ellipsoids", vec![file(COLUMNS, &[ball("")]), adaptive]);
    assert!(messages.contains("there are no `opacities`"), "{messages}");
    assert!((radius(shape.expect("a cloud")).expect("seen") - 3.0).abs() < 1e-5);
}

/// Where rays meet the second of two, both kinds have its attributes, under the names of a mesh's vertices.
#[test]
fn attributes_are_of_the_ellipsoid() {
    let columns = format!("{COLUMNS},vertex_color:3,vertex_vertex_heat:1");
    let rows = [
        "0 0 0 -2 -2 -2 1 0 0 0 0.1 0.2 0.3 7".to_owned(),
        "2 0 0 -2 -2 -2 1 0 0 0 0.4 0.5 0.6 8".to_owned(),
    ];
    for plugin in ["ellipsoids", "ellipsoidsmesh"] {
        let geometry = geometry_of([built(plugin, vec![file(&columns, &rows)])]);
        let of = |x: f32, name: &str| {
            let ray = Ray::new(Vec3::new(x, 0.03, 5.0), -Vec3::Z, 0.0);
            let hit = geometry.intersect(&ray).expect("in the way");
            let vertex = geometry.vertex(&ray, &hit);
            let (primitive, at) = (vertex.primitive, vertex.parameters);
            geometry.attribute(ShapeId(0), name, primitive, at, [0.0, 100.0])
        };
        let close = |found: Option<Vec3>, wanted: Vec3| {
            let found = found.expect("stored");
            assert!((found - wanted).length() < 1e-5, "{plugin}: {found}");
        };
        close(of(0.0, "vertex_color"), Vec3::new(0.1, 0.2, 0.3));
        close(of(2.0, "vertex_color"), Vec3::new(0.4, 0.5, 0.6));
        close(of(2.0, "vertex_heat"), Vec3::splat(8.0));
        assert_eq!(of(2.0, "vertex_cold"), None);
    }
}

#[test]
fn mistakes() {
    let refused = |properties: Vec<(&str, Value)>, needle: &str| {
        for plugin in ["ellipsoids", "ellipsoidsmesh"] {
            let (shape, messages) = make(plugin, properties.clone());
            assert!(shape.is_none() && messages.contains(needle), "{messages}");
        }
    };
    let row = |columns: &str, row: &str| vec![file(columns, &[row.to_owned()])];
    refused(vec![], "needs the parameter `filename`");
    refused(
        vec![("filename", Value::String("absent".into()))],
        "no file `absent`",
    );
    refused(
        row("vertex_rot:4", "0 0 0 1 0 0 0"),
        "its vertices need the properties `scale_0` to `scale_2`",
    );
    refused(
        row("vertex_scale:3,vertex_rot:3", "0 0 0 0 0 0 1 0 0"),
        "its vertices need the properties `rot_0` to `rot_3`",
    );
    let two = ["0 0 0 0 0 0 1 0 0 0", "0 0 0 0 0 0 0 0 0 0"].map(str::to_owned);
    refused(
        vec![file(COLUMNS, &two)],
        "ellipsoid 1, counted from 0: its rotation 0 0 0 0 is no quaternion",
    );
    refused(row(COLUMNS, "0 0 0 0 0 0 NaN 0 0 0"), "is no quaternion");
    refused(row(COLUMNS, "0 0 0 0 NaN 0 1 0 0 0"), "its scale 0 NaN 0");
    refused(row(COLUMNS, "0 0 0 0 100 0 1 0 0 0"), "its scale 0 100 0");
    let far = DMat4::from_translation(DVec3::X * 1e39);
    let mut properties = row(COLUMNS, "0 0 0 0 0 0 1 0 0 0");
    properties.push(("to_world", Value::Transform(far)));
    refused(properties, "it lies too far away");
    for (name, value) in [("extent", 0.0), ("scale_factor", f64::INFINITY)] {
        let mut properties = row(COLUMNS, "0 0 0 0 0 0 1 0 0 0");
        properties.push((name, Value::Float(value)));
        let (_, messages) = make("ellipsoids", properties);
        assert!(
            messages.contains(name) && messages.contains("a finite number above 0"),
            "{messages}"
        );
    }
}

/// A radius so small counts as 10⁻⁶.
fn flat() -> (&'static str, Value) {
    file(COLUMNS, &["0 0 0 -300 0 0 1 0 0 0".to_owned()])
}

#[test]
fn radii_have_a_least() {
    let found = radius(built("ellipsoids", vec![flat()])).expect("seen");
    assert!((found - 3e-6).abs() < 1e-6, "{found}");
    let vertex = |x: f32| {
        let geometry = geometry_of([built("ellipsoids", vec![flat()])]);
        let ray = Ray::new(Vec3::new(x, 0.5, 0.5), -Vec3::X * x.signum(), 0.0);
        let hit = geometry.intersect(&ray).expect("a thin plate");
        geometry.vertex(&ray, &hit)
    };
    assert_eq!(vertex(5.0).normal.x, -vertex(-5.0).normal.x);
    assert!(vertex(5.0).uv.cmpge(Vec2::ZERO).all());
}
