//! `aov`, `moment`, `depth` and `field`: what they write, and under which names.

use crate::world::{Plane, Stack};
use etalon_integrators::AnyIntegrator;
use etalon_integrators::aov::Aov;
use etalon_integrators::depth::Depth;
use etalon_integrators::field::Field;
use etalon_integrators::moment::Moment;
use etalon_params::{Class, Diagnostics, FileId, Node, Params, Property, Span, Spanned, Value};
use etalon_sampling::{Independent, SampleId, Sampler};
use etalon_transport::{Channel, Integrator, PixelSample, Sink};
use glam::{DVec3, UVec2, Vec2};
use std::collections::HashMap;
use std::sync::Arc;

/// A place somewhere in a file.
const HERE: Span = Span {
    file: FileId(0),
    start: 0,
    end: 1,
};

fn node(plugin: &str, properties: Vec<(&str, Value)>) -> Node {
    Node {
        class: Class::Integrator,
        plugin: Spanned {
            value: plugin.into(),
            span: HERE,
        },
        id: None,
        span: HERE,
        properties: properties
            .into_iter()
            .map(|(name, value)| Property::new(name, HERE, value, HERE))
            .collect(),
    }
}

fn child(node: Node) -> Value {
    Value::Object(Arc::new(node))
}

/// One sample's channels by name, with `picture.R` and so on for the picture.
#[derive(Default)]
struct Written {
    names: Vec<String>,
    values: HashMap<String, f32>,
}

impl Written {
    fn put(&mut self, name: String, value: f32) {
        let before = self.values.insert(name.clone(), value);
        assert!(before.is_none(), "{name} was written twice");
    }
}

impl Sink for Written {
    fn radiance(&mut self, rgb: [f32; 3], alpha: f32) {
        let [r, g, b] = rgb;
        for (name, value) in ["R", "G", "B", "A"].into_iter().zip([r, g, b, alpha]) {
            self.put(format!("picture.{name}"), value);
        }
    }
    fn splat(&mut self, _: Vec2, _: [f32; 3]) {
        unreachable!("nothing here splats");
    }
    fn channel(&mut self, index: usize, value: f32) {
        self.put(self.names[index].clone(), value);
    }
}

fn sample<I: Integrator<State = ()>>(integrator: &I, world: &Stack, sample: u32) -> Written {
    let mut sampler = Independent::start(&SampleId {
        seed: 1,
        replicate: 0,
        pixel: (0, 0),
        sample,
        samples_per_replicate: 8,
        blocks: 1,
    });
    let site = PixelSample {
        pixel: UVec2::ZERO,
        raster: sampler.next_2d(),
        margin: 0.0,
        pixels: 1,
        spacing: 0.25,
        sample: 0,
    };
    let names = integrator.channels().into_iter().map(|Channel(name)| name);
    let mut written = Written {
        names: names.collect(),
        ..Written::default()
    };
    integrator.sample(world, &(), &site, &mut sampler, &mut written);
    written
}

fn read<I>(node: &Node, from: impl Fn(&Params<'_>) -> Option<I>) -> I {
    let diagnostics = Diagnostics::new();
    let params = Params::new(node, &diagnostics);
    let read = from(&params);
    params.finish();
    assert!(!diagnostics.has_errors(), "{:?}", diagnostics.into_sorted());
    read.expect("an integrator without mistakes")
}

/// A floor under a camera at height 2, or nothing.
fn floor(planes: Vec<Plane>) -> Stack {
    Stack::new(planes, |_| 1.0, 2.0, false)
}

#[test]
fn variables_describe_the_first_surface() {
    let list =
        "d:depth, p:position,g:geo_normal,n:sh_normal,u:uv,a:albedo,i:prim_index,s:shape_index";
    let path = node("path", vec![("max_depth", Value::Integer(2))]);
    let depth = node("depth", Vec::new());
    let aov = node(
        "aov",
        vec![
            ("aovs", Value::String(list.into())),
            ("first", child(path)),
            ("", child(depth)),
        ],
    );
    let aov = read(&aov, Aov::from_params);
    let seen = sample(
        &aov,
        &floor(vec![
            Plane::BLACK,
            Plane {
                height: -3.0,
                ..Plane::WHITE
            },
        ]),
        0,
    );
    // Every channel was written, once.
    assert_eq!(seen.values.len(), seen.names.len() + 4);
    let at = |name: &str| seen.values[name];
    // Down along (0.6, 0, −0.8) from height 2.
    assert!((at("d.T") - 2.5).abs() < 1e-5);
    assert_eq!([at("p.X"), at("p.Y"), at("p.Z")], [0.0; 3]);
    assert_eq!(
        [at("g.Z"), at("n.Z"), at("u.U"), at("i.I"), at("s.I")],
        [1.0, 1.0, 0.0, 0.0, 1.0]
    );
    assert_eq!([at("a.R"), at("a.G"), at("a.B")], [0.0; 3]);
    // The picture is the first nested integrator's; the second is called by its place.
    assert_eq!(at("picture.G"), at("first.G"));
    for c in ["R", "G", "B", "A"] {
        assert!(
            seen.names.contains(&format!("integrator1.{c}")),
            "{:?}",
            seen.names
        );
    }
    assert_eq!(at("integrator1.A"), 1.0);

    let missed = sample(&aov, &floor(Vec::new()), 0);
    for name in &missed.names {
        let kept = name.starts_with("first.") || name.starts_with("integrator1.");
        assert!(
            kept || !missed.values.contains_key(name),
            "{name} without a surface"
        );
    }
}

/// An albedo has the colour that daylight shows, and is a share of the light: what is grey is grey in every sample, and
/// nothing exceeds 1. Mutants rejected: the colour under even light; a value that is not held to 1.
#[test]
fn an_albedo_is_the_colour_under_daylight() {
    let list = ("aovs", Value::String("a:albedo".into()));
    let aov = read(&node("aov", vec![list]), Aov::from_params);
    let of = |reflectance: fn(f32) -> f32, i| {
        let plane = Plane {
            reflectance,
            ..Plane::WHITE
        };
        let seen = sample(&aov, &floor(vec![plane]), i);
        ["a.R", "a.G", "a.B"].map(|name| seen.values[name])
    };
    for i in 0..4 {
        for channel in of(|_| 0.5, i) {
            assert!((channel - 0.5).abs() < 1e-4, "{channel}");
        }
        assert!(
            of(|_| 28.0, i)
                .iter()
                .all(|channel| (channel - 1.0).abs() < 1e-4)
        );
        // More than the colours of the screen: held to them.
        let [r, g, b] = of(|nm| if nm < 500.0 { 0.9 } else { 0.0 }, i);
        assert!((0.0..0.3).contains(&r) && (0.0..0.3).contains(&g) && (0.5..=1.0).contains(&b));
    }
}

#[test]
fn moments_are_squares_of_single_samples() {
    let aov = node("aov", vec![("aovs", Value::String("d:depth".into()))]);
    let path = node("path", Vec::new());
    let moment = node("moment", vec![("p", child(path)), ("q", child(aov))]);
    let moment = read(&moment, Moment::from_params);
    let names: Vec<String> = moment.channels().into_iter().map(|Channel(n)| n).collect();
    let first = ["p.X", "p.Y", "p.Z", "q.d.T", "q.X", "q.Y", "q.Z"];
    assert_eq!(names[..7], first);
    assert!(
        names[7..]
            .iter()
            .zip(first)
            .all(|(n, f)| *n == format!("m2_{f}"))
    );

    let world = floor(vec![Plane {
        exponent: |nm| nm / 200.0,
        ..Plane::WHITE
    }]);
    let mut luminances = Vec::new();
    for i in 0..8 {
        let seen = sample(&moment, &world, i);
        for name in first {
            let (value, square) = (seen.values[name], seen.values[&format!("m2_{name}")]);
            assert_eq!(square, value * value, "{name}");
        }
        assert!((seen.values["q.d.T"] - 2.5).abs() < 1e-5);
        let picture = |c: &str| f64::from(seen.values[&format!("picture.{c}")]);
        // Rec.709's luminance.
        let y = 0.2126 * picture("R") + 0.7152 * picture("G") + 0.0722 * picture("B");
        assert!((f64::from(seen.values["p.Y"]) - y).abs() < 1e-3 * y);
        luminances.push(seen.values["p.Y"]);
    }
    luminances.dedup();
    assert!(luminances.len() > 1, "samples do not vary");
}

/// Distance is a number, and no light that has a colour. Mutant rejected: the colour of an even spectrum.
#[test]
fn depth_is_grey() {
    let world = floor(vec![Plane::WHITE]);
    for i in 0..4 {
        let seen = sample(&Depth, &world, i);
        for c in ["R", "G", "B"] {
            let value = seen.values[&format!("picture.{c}")];
            assert!((value - 2.5).abs() < 1e-5, "{c}: {value}");
        }
    }
    let missed = sample(&Depth, &floor(Vec::new()), 0);
    assert!(missed.values.values().all(|&v| v == 0.0));
}

/// Three numbers are a colour, one is grey, and where nothing is hit is what the scene says; the field of the same name in an
/// `aov` agrees, but for shapes, which Mitsuba 0.6 counted from 0.
#[test]
fn fields_are_pictures() {
    let undefined = || ("undefined", Value::Rgb(DVec3::new(-1.0, 2.0, 3.0)));
    let field = |name: &str| {
        let properties = vec![("field", Value::String(name.into())), undefined()];
        node("field", properties)
    };
    let list = "geoNormal:geo_normal,shNormal:sh_normal,position:position,albedo:albedo,\
                uv:uv,distance:depth,primIndex:prim_index,shapeIndex:shape_index";
    let aov = read(
        &node("aov", vec![("aovs", Value::String(list.into()))]),
        Aov::from_params,
    );
    let world = floor(vec![Plane::WHITE]);
    let wanted = sample(&aov, &world, 0);
    for entry in list.split(',') {
        let (name, _) = entry.split_once(':').expect("a pair");
        let field = read(&field(name), Field::from_params);
        let seen = sample(&field, &world, 0);
        let channel = |suffixes: [&str; 4], c: usize| {
            let full = |suffix| format!("{name}.{suffix}");
            wanted
                .values
                .get(&full(suffixes[c]))
                .or(wanted.values.get(&full(suffixes[3])))
        };
        for (c, channel_name) in ["R", "G", "B"].into_iter().enumerate() {
            let wanted = match name {
                "albedo" => channel(["R", "G", "B", ""], c),
                "uv" => channel(["U", "V", "", ""], c),
                "distance" | "primIndex" | "shapeIndex" => {
                    let suffix = if name == "distance" { "T" } else { "I" };
                    channel(["", "", "", suffix], c)
                }
                _ => channel(["X", "Y", "Z", ""], c),
            };
            let mut wanted = wanted.copied().unwrap_or_default();
            if name == "shapeIndex" {
                assert_eq!(wanted, 1.0);
                wanted = 0.0;
            }
            let found = seen.values[&format!("picture.{channel_name}")];
            assert_eq!(found, wanted, "{name} {channel_name}");
        }
        assert_eq!(seen.values["picture.A"], 1.0);
        let missed = sample(&field, &floor(Vec::new()), 0);
        let colour = ["R", "G", "B", "A"].map(|c| missed.values[&format!("picture.{c}")]);
        assert_eq!(colour, [-1.0, 2.0, 3.0, 0.0]);
    }
    // What `multichannel` is read as.
    let several = node(
        "aov",
        vec![
            ("aovs", Value::String(String::new())),
            ("color", child(node("path", Vec::new()))),
            ("normal", child(field("shNormal"))),
        ],
    );
    let seen = sample(&read(&several, Aov::from_params), &world, 0);
    assert_eq!(seen.values["picture.G"], seen.values["color.G"]);
    assert_eq!(
        ["R", "G", "B", "A"].map(|c| seen.values[&format!("normal.{c}")]),
        [0.0, 0.0, 1.0, 1.0]
    );
}

#[test]
fn mistakes_in_fields_are_told() {
    let said = |properties: Vec<(&str, Value)>| {
        let diagnostics = Diagnostics::new();
        let read = AnyIntegrator::from_node(&node("field", properties), &diagnostics);
        let all = diagnostics.into_sorted().into_iter();
        let text = all.map(|d| format!("{}; {}\n", d.message, d.help.unwrap_or_default()));
        (read.is_some(), text.collect::<String>())
    };
    let name = |name: &str| ("field", Value::String(name.into()));
    let (_, missing) = said(vec![]);
    assert!(missing.contains("needs the parameter `field`"), "{missing}");
    let (read, relative) = said(vec![name("relPosition")]);
    assert!(
        !read && relative.contains("`position` is that in the world"),
        "{relative}"
    );
    assert_eq!(relative.lines().count(), 1, "{relative}");
    let (_, misspelt) = said(vec![name("shnormals")]);
    assert!(misspelt.contains("did you mean `shNormal`"), "{misspelt}");
    let (read, endless) = said(vec![name("uv"), ("undefined", Value::Float(f64::INFINITY))]);
    assert!(
        !read && endless.contains("`undefined` must be"),
        "{endless}"
    );
    assert_eq!(
        said(vec![name("uv"), ("undefined", Value::Integer(-7))]),
        (true, String::new())
    );
}

#[test]
fn mistakes_in_nesting_are_reported() {
    let mistake = |node: Node| {
        let diagnostics = Diagnostics::new();
        let read = AnyIntegrator::from_node(&node, &diagnostics);
        assert_eq!(read.is_some(), !diagnostics.has_errors());
        read.is_none()
    };
    let list = || ("aovs", Value::String("d:depth".into()));
    assert!(!mistake(node("aov", vec![list()])));
    assert!(mistake(node("aov", Vec::new())));
    for wrong in ["depth", "d:depht", "d:depth,e"] {
        assert!(
            mistake(node("aov", vec![("aovs", Value::String(wrong.into()))])),
            "{wrong}"
        );
    }
    let light = || child(node("ptracer", Vec::new()));
    assert!(mistake(node("aov", vec![list(), ("", light())])));
    assert!(mistake(node("moment", vec![("", light())])));
    assert!(mistake(node("moment", Vec::new())));
    let deep = node(
        "moment",
        vec![("", child(node("aov", vec![list(), ("", light())])))],
    );
    assert!(mistake(deep));
    let wrong_inside = node("path", vec![("max_dept", Value::Integer(3))]);
    let diagnostics = Diagnostics::new();
    AnyIntegrator::from_node(
        &node("moment", vec![("", child(wrong_inside))]),
        &diagnostics,
    );
    assert!(diagnostics.has_errors());
}
