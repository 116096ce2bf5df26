//! Shapes from their descriptions: what is accepted, and what is said of the rest.

use crate::curve_files::curve_file;
use crate::files::{Files, ONE_BALL, good_patch};
use crate::things::{Random, geometry_of};
use etalon_geometry::Shape;
use etalon_params::{
    Class, DMat4, DVec3, Diagnostics, FileId, Node, Params, Property, Span, Spanned, Value,
};
use etalon_transport::{
    Assets, Build, LightSampleContext, Ray, ShapeId, Shapes, Shutter, SpectrumKind, TextureId,
};
use glam::Vec3;
use std::sync::Arc;

const HERE: Span = Span {
    file: FileId(0),
    start: 0,
    end: 1,
};

struct Scene;

impl Build for Scene {
    fn assets(&self) -> &dyn Assets {
        &Files
    }

    fn shutter(&self) -> Shutter {
        Shutter::default()
    }
    fn texture(&mut self, _: &Params<'_>, _: &str, _: Option<f64>, _: SpectrumKind) -> TextureId {
        TextureId::NONE
    }
    fn volume(
        &mut self,
        params: &Params<'_>,
        name: &str,
        default: Option<f64>,
        role: SpectrumKind,
    ) -> TextureId {
        self.texture(params, name, default, role)
    }

    fn nested_texture(&mut self, _: &Arc<Node>, _: SpectrumKind) -> TextureId {
        TextureId::NONE
    }
    fn varies(&self, _: &str) -> bool {
        false
    }

    fn resolution(&self, _: TextureId) -> [u32; 2] {
        [1; 2]
    }

    fn spectrum(&mut self, _: etalon_spectrum::Spectrum) -> TextureId {
        TextureId::NONE
    }
}

/// The shape, and every message in one string.
pub(crate) fn make(plugin: &str, properties: Vec<(&str, Value)>) -> (Option<Shape>, String) {
    let property = |(name, value): (&str, Value)| Property::new(name, HERE, value, HERE);
    let node = Node {
        class: Class::Shape,
        plugin: Spanned {
            value: plugin.into(),
            span: HERE,
        },
        id: None,
        span: HERE,
        properties: properties.into_iter().map(property).collect(),
    };
    let diagnostics = Diagnostics::new();
    let params = Params::new(&node, &diagnostics);
    let shape = Shape::from_params(&params, &mut Scene);
    params.finish();
    let messages = diagnostics.into_sorted().into_iter();
    let text = messages.map(|d| format!("{}; {}\n", d.message, d.help.unwrap_or_default()));
    (shape, text.collect())
}

fn file(name: &str) -> (&str, Value) {
    ("filename", Value::String(name.into()))
}

fn function(text: &str) -> (&'static str, Value) {
    ("function", Value::String(text.into()))
}

fn scale(x: f64, y: f64, z: f64) -> (&'static str, Value) {
    let matrix = DMat4::from_scale(DVec3::new(x, y, z));
    ("to_world", Value::Transform(matrix))
}

fn flag(name: &str, value: bool) -> (&str, Value) {
    (name, Value::Boolean(value))
}

#[test]
fn every_plugin_takes_its_parameters() {
    for plugin in Shape::plugins() {
        let mut properties = vec![
            scale(2.0, 2.0, 2.0),
            flag("flip_normals", true),
            ("silhouette_sampling_weight", Value::Float(0.5)),
        ];
        match plugin {
            "serialized" => properties.extend([
                file("good"),
                flag("face_normals", true),
                ("shape_index", Value::Integer(2)),
            ]),
            "obj" | "ply" => properties.extend([
                file("good"),
                flag("face_normals", true),
                flag("flip_tex_coords", true),
            ]),
            "sphere" => properties.extend([
                ("center", Value::Vector(DVec3::ONE)),
                ("radius", Value::Float(3.0)),
            ]),
            "cylinder" => properties.extend([
                ("p0", Value::Vector(DVec3::ONE)),
                ("p1", Value::Vector(DVec3::X)),
                ("radius", Value::Integer(3)),
            ]),
            "linearcurve" | "bsplinecurve" | "beziercurve" | "hair" => {
                // Which are seen from outside only.
                properties.remove(1);
                properties.push(file(curve_file(plugin)));
            }
            "ellipsoids" | "ellipsoidsmesh" => {
                properties.remove(1);
                properties.extend([
                    file(ONE_BALL),
                    ("scale_factor", Value::Float(0.5)),
                    ("extent", Value::Float(2.0)),
                ]);
            }
            "bicubic" => properties.extend([
                ("points", Value::String(good_patch())),
                flag("face_normals", true),
                ("steps", Value::Integer(5)),
            ]),
            "heightfield" => properties.extend([
                file("picture"),
                flag("face_normals", true),
                ("height", Value::Float(0.5)),
            ]),
            "sdfgrid" => properties.push(file("volume")),
            "blob" => properties.push(("balls", Value::String("0 0 0 1 1".into()))),
            "cube" | "rectangle" => properties.push(flag("face_normals", true)),
            "revolution" | "extrusion" => {
                properties.push(("profile", Value::String("0.5 0, 0.7 1".into())))
            }
            "implicit" => properties.extend([function("x^2 + y^2 - z"), flag("open", true)]),
            "curve" => properties.extend([
                ("points", Value::String("0 0 0, 1 1 1, 2 0 1".into())),
                ("width", Value::String("0.1 + 0.1*u".into())),
                flag("face_normals", true),
                flag("closed", true),
            ]),
            _ => {}
        }
        let (shape, messages) = make(plugin, properties);
        assert!(
            shape.is_some() && messages.is_empty(),
            "{plugin}: {messages}"
        );
    }
    assert!(make("teapot", vec![]).0.is_none());
}

/// What is true of every shape of the list: the points that it gives are on it, within its box, with normals in its
/// cone, and the density toward a receiver is that of the sample. Mutant refused: a density by area of
/// a point that was chosen by solid angle.
#[test]
fn every_plugin_answers_alike() {
    for plugin in Shape::plugins() {
        let properties = match plugin {
            "serialized" | "obj" | "ply" => vec![file("good")],
            "linearcurve" | "bsplinecurve" | "beziercurve" | "hair" => {
                vec![file(curve_file(plugin))]
            }
            "ellipsoids" | "ellipsoidsmesh" => vec![file(ONE_BALL)],
            "bicubic" => vec![("points", Value::String(good_patch()))],
            "heightfield" => vec![file("picture")],
            "sdfgrid" => vec![file("volume")],
            "blob" => vec![("balls", Value::String("0 0 0 1 1".into()))],
            "revolution" | "extrusion" => vec![("profile", Value::String("0.5 0, 0.7 1".into()))],
            "implicit" => vec![function("x^2 + y^2 + z^2 - 1")],
            // Facets of a thin tube are slivers, which single precision places less well.
            "curve" => vec![
                ("points", Value::String("0 0 0, 1 1 1".into())),
                ("width", Value::Float(0.2)),
            ],
            _ => Vec::new(),
        };
        let (shape, messages) = make(plugin, properties);
        let geometry = geometry_of([shape.unwrap_or_else(|| panic!("{plugin}: {messages}"))]);
        let id = ShapeId(0);
        if !geometry.shape(id).can_emit() {
            // Whose points are not sampled: see `solids`.
            assert!(
                matches!(
                    plugin,
                    "bilinear"
                        | "bsplinecurve"
                        | "beziercurve"
                        | "hair"
                        | "linearcurve"
                        | "plane"
                        | "blob"
                        | "julia"
                        | "superellipsoid"
                        | "sdfgrid"
                        | "quadric"
                        | "ellipsoid"
                        | "ellipsoids"
                        | "implicit"
                ),
                "{plugin}"
            );
            continue;
        }
        let (mut random, [min, max]) = (Random(5), Shapes::bounds(&geometry, id));
        let cone = geometry.normals(id);
        for _ in 0..200 {
            let on = geometry.sample_area(id, random.square(), 0.0);
            assert!(
                (on.density * geometry.area(id, 0.0) - 1.0).abs() < 1e-5,
                "{plugin}"
            );
            let from = LightSampleContext::in_space(random.direction() * 3.0);
            let toward = geometry.sample_toward(id, &from, random.square());
            for point in toward
                .iter()
                .map(|sampled| &sampled.point)
                .chain([&on.point])
            {
                let (p, n) = (point.position, point.normal);
                let slack = Vec3::splat(1e-5);
                assert!(
                    p.cmpge(min - slack).all() && p.cmple(max + slack).all(),
                    "{plugin}"
                );
                assert!(cone.axis.dot(n.as_dvec3()) >= cone.cos - 1e-6, "{plugin}");
                let ray = Ray::new(p + n * 0.01, -n, 0.0);
                let hit = geometry.intersect(&ray).expect("it is on the shape");
                assert!((hit.t - 0.01).abs() < 1e-5, "{plugin}: {}", hit.t);
                let vertex = geometry.vertex(&ray, &hit);
                assert!(vertex.normal.dot(n) > 0.999, "{plugin}");
            }
            if let Some(sampled) = toward {
                let again = geometry.density_toward(id, &from, &sampled.point);
                assert!((again / sampled.density - 1.0).abs() < 2e-3, "{plugin}");
            }
        }
    }
}

/// A file may ask for face normals itself, and its notes are handed on.
#[test]
fn files_have_wishes() {
    let (shape, messages) = make("serialized", vec![file("faceted")]);
    assert_eq!(messages, "`faceted`: it is odd; \n");
    let geometry = crate::things::geometry_of(shape);
    let ray = Ray::new(Vec3::new(0.2, 0.2, 1.0), -Vec3::Z, 0.0);
    let hit = geometry.intersect(&ray).expect("it is below");
    assert_eq!(geometry.vertex(&ray, &hit).shading.n, Vec3::Z);
}

#[test]
fn mistakes_are_told() {
    let refused = |plugin: &str, properties, needles: &[&str]| {
        let (shape, messages) = make(plugin, properties);
        assert!(shape.is_none(), "{plugin}");
        for needle in needles {
            assert!(messages.contains(needle), "{messages}");
        }
    };
    refused("sphere", vec![scale(1.0, 1.0, 2.0)], &["must stay round"]);
    refused("cylinder", vec![scale(1.0, 2.0, 1.0)], &["right circular"]);
    refused(
        "disk",
        vec![scale(1.0, 0.0, 1.0)],
        &["cannot be undone", "invertible"],
    );
    refused(
        "cylinder",
        vec![("p1", Value::Vector(DVec3::ZERO))],
        &["must differ"],
    );
    refused("obj", vec![], &["`obj` needs the parameter `filename`"]);
    refused(
        "ply",
        vec![file("nothing")],
        &["no file `nothing`", "try `good`"],
    );
    refused(
        "ply",
        vec![file("nan")],
        &["`nan` cannot be used", "vertex 1", "NaN"],
    );
    let (_, messages) = make(
        "serialized",
        vec![file("good"), ("shape_index", Value::Integer(-1))],
    );
    assert!(
        messages.starts_with("parameter `shape_index` of `serialized` cannot be -1")
            && messages.lines().count() == 1,
        "{messages}"
    );
    refused("ply", vec![file("index")], &["triangle 0", "only 3"]);
    // A value that is refused is told, though reading goes on with the default.
    let (_, messages) = make("sphere", vec![("radius", Value::Float(0.0))]);
    assert!(messages.contains("cannot be 0"), "{messages}");
    let (_, messages) = make("cylinder", vec![("radius", Value::Float(-1.0))]);
    assert!(
        messages.contains("cannot be -1") && messages.contains("positive"),
        "{messages}"
    );
    let (_, messages) = make("cube", vec![flag("face_normal", true)]);
    assert!(
        messages.contains("no parameter `face_normal`"),
        "{messages}"
    );
    // No triangles: worth saying, no mistake.
    let (shape, messages) = make("ply", vec![file("empty")]);
    assert!(
        shape.is_some() && messages.contains("no triangles"),
        "{messages}"
    );
}
