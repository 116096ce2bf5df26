//! Surfaces as nets of triangles: how far they are off, and what is said of mistakes.

use crate::description::make;
use crate::files::good_patch;
use crate::things::{Random, geometry_of};
use etalon_params::Value;
use etalon_transport::{Ray, ShapeId, Shapes};
use glam::Vec3;

fn text(name: &'static str, value: &str) -> (&'static str, Value) {
    (name, Value::String(value.into()))
}

/// The patch's control points are evenly spaced in x and y, so that its height is a polynomial of both: with
/// x = 3u, y = 3v it is (Bernstein's form of i j − 3 i + j²) x y − 3 x + y + 6 v²; the net is off by M/(4n²) at most.
#[test]
fn a_patch_is_its_polynomial() {
    let height = |x: f64, y: f64| x * y - 3.0 * x + y + 6.0 * (y / 3.0).powi(2);
    let mut before = f64::INFINITY;
    for steps in [4, 16, 64] {
        let (shape, messages) = make(
            "bicubic",
            vec![
                text("points", &good_patch()),
                ("steps", Value::Integer(steps)),
            ],
        );
        let geometry = geometry_of([shape.unwrap_or_else(|| panic!("{messages}"))]);
        let mut random = Random(3);
        let (mut off, mut turned) = (0.0_f64, 0.0_f64);
        for _ in 0..2000 {
            let place = (random.point() + 1.0) * 1.5;
            let ray = Ray::new(Vec3::new(place.x, place.y, 40.0), Vec3::NEG_Z, 0.0);
            let hit = geometry.intersect(&ray).expect("it is over the square");
            let vertex = geometry.vertex(&ray, &hit);
            let [x, y, z] = vertex.position.as_dvec3().to_array();
            off = off.max((z - height(x, y)).abs());
            let normal = glam::DVec3::new(3.0 - y, -x - 1.0 - 12.0 * y / 9.0, 1.0).normalize();
            turned = turned.max(vertex.shading.n.as_dvec3().angle_between(normal));
            assert!((vertex.uv.as_dvec2() * 3.0 - glam::DVec2::new(x, y)).length() < 1e-4);
        }
        // Second derivatives by u and v: 9 and 12 at most.
        let bound = 21.0 / (4.0 * f64::from(steps as i32).powi(2));
        assert!(
            off <= bound + 1e-5 && off < before / 8.0,
            "{steps}: {off} {bound}"
        );
        assert!(turned < 2.0 / f64::from(steps as i32), "{steps}: {turned}");
        before = off;
    }
}

/// Of three by two pixels, the first row above.
#[test]
fn a_picture_is_heights() {
    let file = text("filename", "picture");
    let (shape, messages) = make("heightfield", vec![file, ("height", Value::Float(2.0))]);
    let geometry = geometry_of([shape.unwrap_or_else(|| panic!("{messages}"))]);
    let wanted = [
        (-1.0, 1.0, 0x00),
        (0.0, 1.0, 0x80),
        (1.0, -1.0, 0x99),
        (-1.0, -1.0, 0x33),
    ];
    for (x, y, value) in wanted {
        let inside = Vec3::new(x, y, 0.0) * 0.9999;
        let ray = Ray::new(inside + Vec3::Z * 9.0, Vec3::NEG_Z, 0.0);
        let hit = geometry.intersect(&ray).expect("it is over the square");
        let height = 2.0 * value as f32 / 255.0;
        assert!(
            (9.0 - hit.t - height).abs() < 1e-3,
            "{x} {y}: {} {height}",
            9.0 - hit.t
        );
        assert!(geometry.vertex(&ray, &hit).normal.z > 0.0);
    }
    assert!(Shapes::area(&geometry, ShapeId(0), 0.0) > 4.0);
}

#[test]
fn mistakes() {
    let messages = |plugin: &str, properties| make(plugin, properties).1;
    assert!(messages("bicubic", vec![text("points", "1 2 3")]).contains("has 3 numbers"));
    let none = vec![text("points", &good_patch()), ("steps", Value::Integer(0))];
    assert!(messages("bicubic", none).contains("from 1 to 1024"));
    assert!(
        messages("heightfield", vec![text("filename", "line")]).contains("less than two pixels")
    );
    assert!(messages("heightfield", vec![text("filename", "words")]).contains("words"));
    assert!(messages("heightfield", Vec::new()).contains("filename"));
    assert!(messages("sdfgrid", vec![text("filename", "flat")]).contains("change their sign"));
    assert!(messages("sdfgrid", vec![text("filename", "words")]).contains("header"));
    assert!(messages("blob", vec![text("balls", "1 2 3")]).contains("five numbers"));
    assert!(messages("julia", vec![text("c", "1 2 3")]).contains("four numbers"));
    assert!(messages("superellipsoid", vec![("e", Value::Float(0.0))]).contains("0.05"));
}
