//! Shells of triangles around ellipsoids.

use crate::description::make;
use crate::ellipsoids::{COLUMNS, Row, cloud, file};
use crate::solids::{built, number, vector};
use crate::things::{Random, geometry_of};
use etalon_geometry::Shape;
use etalon_geometry::shapes::mesh::Mesh;
use etalon_params::{Class, DMat4, FileId, Node, Property, Span, Spanned, Value};
use etalon_transport::Ray;
use glam::{DAffine3, DVec3, Vec3};
use std::sync::Arc;

fn shells(properties: Vec<(&str, Value)>) -> Shape {
    built("ellipsoidsmesh", properties)
}

fn mesh(shape: &Shape) -> &Mesh {
    match shape {
        Shape::Mesh(mesh) => mesh,
        _ => panic!("no mesh"),
    }
}

/// The planes of an icosahedron touch the ellipsoid, those of the others are as far as their middles are; all are closed and
/// turned outward, mirrored or not.
#[test]
fn shells_go_around() {
    // A unit sphere; volumes by the divergence theorem.
    let unit = || file(COLUMNS, &["0 0 0 0 0 0 1 0 0 0".to_owned()]);
    // The circumscribed icosahedron: 10 (7 − 3 √5) √3, as its inradius is φ² / (2 √3) of an edge.
    let around = 10.0 * (7.0 - 3.0 * 5.0_f64.sqrt()) * 3.0_f64.sqrt();
    // Of a cube the middles of half faces, at √11/3 of half an edge, are on the sphere.
    let cube = (6.0 / 11.0_f64.sqrt()).powi(3);
    let cases = [
        ("ico_sphere", 20, around),
        ("box", 12, cube),
        ("uv_sphere", 72, f64::NAN),
    ];
    for (name, triangles, volume) in cases {
        for scale in [1.0, -1.0] {
            let matrix = DMat4::from_scale(DVec3::new(scale, 1.0, 1.0));
            let shape = shells(vec![
                unit(),
                number("extent", 1.0),
                ("shell", Value::String(name.into())),
                ("to_world", Value::Transform(matrix)),
            ]);
            assert!(!shape.is_open(), "{name}");
            let mesh = mesh(&shape);
            assert_eq!(mesh.triangle_count(), triangles, "{name}");
            let (mut found, mut nearest) = (0.0, f64::INFINITY);
            for i in 0..triangles as u32 {
                let [a, b, c] = mesh.corners(i).map(Vec3::as_dvec3);
                found += a.dot(b.cross(c)) / 6.0;
                nearest = nearest.min(((a + b + c) / 3.0).length());
            }
            assert!((nearest - 1.0).abs() < 1e-6, "{name}: {nearest}");
            let exact = volume.is_nan() || (found - volume).abs() < 1e-5;
            // Between the ball's and that of a cube around it.
            assert!(exact && (4.18..8.0).contains(&found), "{name}: {found}");
            // The outside is outside.
            let geometry = geometry_of([shape]);
            let mut random = Random(3);
            for _ in 0..50 {
                let ray = Ray::new(Vec3::ZERO, random.direction(), 0.0);
                let hit = geometry.intersect(&ray).expect("from within");
                assert!(geometry.vertex(&ray, &hit).normal.dot(ray.direction) > 0.0);
            }
        }
    }
}

/// A shell around an ellipsoid is that around the unit sphere, mapped.
#[test]
fn shells_are_mapped() {
    let row = Row {
        center: [0.3, -0.2, 0.5],
        scale: [-1.0, -2.0, -3.0],
        rotation: [0.3, 0.5, -0.4, 0.8],
    };
    let unit = file(COLUMNS, &["0 0 0 0 0 0 1 0 0 0".to_owned()]);
    let of_unit = shells(vec![unit, number("extent", 1.0)]);
    let mapped = shells(vec![cloud(&[row, row])]);
    let (center, axes) = row.axes(3.0, &DAffine3::IDENTITY);
    for i in 0..40 {
        let wanted = mesh(&of_unit).corners(i % 20).map(|v| {
            let v = v.as_dvec3();
            center + axes[0] * v.x + axes[1] * v.y + axes[2] * v.z
        });
        for (found, wanted) in mesh(&mapped).corners(i).into_iter().zip(wanted) {
            assert!((found.as_dvec3() - wanted).length() < 1e-6);
        }
    }
}

fn nested(plugin: &str, properties: Vec<(&str, Value)>) -> (&'static str, Value) {
    const HERE: Span = Span {
        file: FileId(0),
        start: 0,
        end: 1,
    };
    let properties = properties.into_iter();
    let node = Node {
        class: Class::Shape,
        plugin: Spanned {
            value: plugin.into(),
            span: HERE,
        },
        id: None,
        span: HERE,
        properties: properties
            .map(|(name, value)| Property::new(name, HERE, value, HERE))
            .collect(),
    };
    ("shell", Value::Object(Arc::new(node)))
}

/// A mesh of the scene's is a shell; what is none, or does not go around the origin, is refused.
#[test]
fn meshes_are_shells() {
    let unit = || file(COLUMNS, &["0 0 0 0 0 0 1 0 0 0".to_owned()]);
    let cube = shells(vec![unit(), nested("cube", vec![]), number("extent", 1.0)]);
    let geometry = geometry_of([cube]);
    let ray = Ray::new(Vec3::new(0.1, 0.2, 5.0), -Vec3::Z, 0.0);
    let t = geometry.intersect(&ray).expect("a cube").t;
    let half = 3.0 / 11.0_f32.sqrt();
    assert!((t - 5.0 + half).abs() < 1e-5, "{t}");
    let refused = |shell: (&'static str, Value), needle: &str| {
        let (shape, messages) = make("ellipsoidsmesh", vec![unit(), shell]);
        assert!(shape.is_none() && messages.contains(needle), "{messages}");
    };
    refused(nested("sphere", vec![]), "`sphere` is no mesh");
    refused(nested("spere", vec![]), "did you mean `sphere`");
    refused(
        nested("ply", vec![("filename", Value::String("empty".into()))]),
        "a shell goes around the origin",
    );
    refused(
        nested("ply", vec![("filename", Value::String("good".into()))]),
        "a shell goes around the origin",
    );
    let (_, messages) = make(
        "ellipsoidsmesh",
        vec![
            unit(),
            nested("cube", vec![vector("center", 0.0, 0.0, 1.0)]),
        ],
    );
    assert!(messages.contains("no parameter `center`"), "{messages}");
    let (_, messages) = make("ellipsoids", vec![unit(), nested("cube", vec![])]);
    assert!(
        messages.contains("`ellipsoids` has no parameter `shell`"),
        "{messages}"
    );
    let bad = ("shell", Value::String("ball".into()));
    let (_, messages) = make("ellipsoidsmesh", vec![unit(), bad]);
    assert!(
        messages.contains("`ball`") && messages.contains("uv_sphere"),
        "{messages}"
    );
}
