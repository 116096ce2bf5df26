//! Properties of reading scenes: what is written is read, and nothing broken can do harm.

use etalon_formats::mitsuba::read;
use etalon_formats::{ReadOptions, ReadOutcome};
use etalon_params::{Class, DMat4, DVec3, Node, Sources, Span, SpectrumText, Value};
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::RngSeed;
use std::time::{Duration, Instant};

/// A value as a test writes it.
#[derive(Clone, Debug)]
enum Written {
    Float(f64),
    Integer(i64),
    Boolean(bool),
    Text(String),
    Vector(DVec3),
    Rgb(DVec3),
    Uniform(f64),
    Samples(Vec<(f64, f64)>),
    Translation(DVec3),
    Object(Tree),
}

/// An object as a test writes it.
#[derive(Clone, Debug)]
struct Tree {
    class: Class,
    plugin: String,
    properties: Vec<Written>,
}

const CLASSES: [Class; 6] = [
    Class::Bsdf,
    Class::Shape,
    Class::Texture,
    Class::Emitter,
    Class::Integrator,
    Class::Volume,
];

fn escaped(text: &str) -> String {
    let mut result = String::new();
    for c in text.chars() {
        match c {
            '&' => result.push_str("&amp;"),
            '<' => result.push_str("&lt;"),
            '"' => result.push_str("&quot;"),
            '$' => result.push_str(r"\$"),
            c => result.push(c),
        }
    }
    result
}

impl Tree {
    fn write(&self, name: &str, out: &mut String) {
        let (tag, plugin) = (self.class.name(), escaped(&self.plugin));
        out.push_str(&format!("<{tag} type=\"{plugin}\" name=\"{name}\">\n"));
        for (i, property) in self.properties.iter().enumerate() {
            let name = format!("p{i}");
            let mut element = |tag: &str, value: String| {
                out.push_str(&format!("\t<{tag} name='{name}' value=\"{value}\"/>\n"));
            };
            match property {
                Written::Float(x) => element("float", x.to_string()),
                Written::Integer(i) => element("integer", i.to_string()),
                Written::Boolean(b) => element("boolean", b.to_string()),
                Written::Text(t) => element("string", escaped(t)),
                Written::Vector(v) => element("vector", format!("{}, {} {}", v.x, v.y, v.z)),
                Written::Rgb(v) => element("rgb", format!("{},{},{}", v.x, v.y, v.z)),
                Written::Uniform(x) => element("spectrum", x.to_string()),
                Written::Samples(pairs) => {
                    let pairs: Vec<String> =
                        pairs.iter().map(|(l, v)| format!("{l}:{v}")).collect();
                    element("spectrum", pairs.join(", "));
                }
                Written::Translation(v) => out.push_str(&format!(
                    "<transform name='{name}'><translate x='{}' y='{}' z='{}'/></transform>",
                    v.x, v.y, v.z
                )),
                Written::Object(tree) => tree.write(&name, out),
            }
        }
        out.push_str(&format!("</{tag}>"));
    }

    fn assert_is(&self, node: &Node, sources: &Sources) {
        assert_eq!((node.class, &node.plugin.value), (self.class, &self.plugin));
        assert_eq!(node.properties.len(), self.properties.len());
        for (i, (property, written)) in node.properties.iter().zip(&self.properties).enumerate() {
            assert_eq!(property.name, format!("p{i}"));
            assert_eq!(at(sources, property.name_span), property.name);
            match (&property.value, written) {
                (Value::Float(a), Written::Float(b)) => {
                    assert_eq!(a, b);
                    assert_eq!(at(sources, property.span), b.to_string());
                }
                (Value::Integer(a), Written::Integer(b)) => assert_eq!(a, b),
                (Value::Boolean(a), Written::Boolean(b)) => assert_eq!(a, b),
                (Value::String(a), Written::Text(b)) => {
                    assert_eq!(a, b);
                    assert_eq!(at(sources, property.span), escaped(b));
                }
                (Value::Vector(a), Written::Vector(b)) | (Value::Rgb(a), Written::Rgb(b)) => {
                    assert_eq!(a, b);
                }
                (Value::Spectrum(SpectrumText::Uniform(a)), Written::Uniform(b)) => {
                    assert_eq!(a, b);
                }
                (Value::Spectrum(SpectrumText::Samples(a)), Written::Samples(b)) => {
                    assert_eq!(a, b);
                }
                (Value::Transform(a), Written::Translation(b)) => {
                    assert_eq!(*a, DMat4::from_translation(*b));
                }
                (Value::Object(a), Written::Object(b)) => b.assert_is(a, sources),
                (found, wanted) => panic!("{found:?} is not {wanted:?}"),
            }
        }
    }
}

fn at(sources: &Sources, span: Span) -> &str {
    &sources.text(span.file)[span.start as usize..span.end as usize]
}

fn number() -> impl Strategy<Value = f64> {
    let wide = prop::num::f32::NORMAL | prop::num::f32::ZERO;
    prop_oneof![-1e6..1e6, wide.prop_map(f64::from)]
}

fn vector() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(number()).prop_map(DVec3::from_array)
}

fn samples() -> impl Strategy<Value = Vec<(f64, f64)>> {
    prop::collection::vec((0.001..50.0, number()), 2..8).prop_map(|steps| {
        let mut wavelength = 361.0;
        let sum = |(step, value)| {
            wavelength += step;
            (wavelength, value)
        };
        steps.into_iter().map(sum).collect()
    })
}

fn tree() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        number().prop_map(Written::Float),
        any::<i64>().prop_map(Written::Integer),
        any::<bool>().prop_map(Written::Boolean),
        "[ -~é→]{0,12}".prop_map(Written::Text),
        vector().prop_map(Written::Vector),
        vector().prop_map(Written::Rgb),
        number().prop_map(Written::Uniform),
        samples().prop_map(Written::Samples),
        vector().prop_map(Written::Translation),
    ];
    let object = |property: BoxedStrategy<Written>| {
        (
            prop::sample::select(&CLASSES[..]),
            "[a-z&<]{1,8}",
            prop::collection::vec(property, 0..6),
        )
            .prop_map(|(class, plugin, properties)| Tree {
                class,
                plugin,
                properties,
            })
    };
    let property = leaf.prop_recursive(4, 40, 6, move |inner| {
        object(inner.boxed()).prop_map(Written::Object)
    });
    object(property.boxed())
}

fn read_bytes(bytes: &[u8]) -> ReadOutcome {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("scene.xml");
    std::fs::write(&path, bytes).expect("written");
    read(&path, &ReadOptions::default())
}

fn scene(tree: &Tree) -> String {
    let mut text = String::from("<?xml version='1.0'?>\n<scene version=\"3.0.0\">");
    tree.write("only", &mut text);
    text.push_str("</scene>\n");
    text
}

/// A scene that uses most of the language, to be broken.
const RICH: &str = r#"<scene version="0.6.0"><!-- rich -->
<default name="spp" value="16"/><default name="res" value="64"/>
<integrator type="path"><integer name="maxDepth" value="5"/></integrator>
<sensor type="perspective" id="cam"><float name="fov" value="45"/>
<transform name="toWorld"><scale value="2"/><rotate x="1" angle="30"/>
<lookat origin="0 0 0" target="0, 0, 1" up="0 1 0"/><translate x="1"/>
<matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"/></transform>
<sampler type="independent"><integer name="sampleCount" value="$spp"/></sampler>
<film type="hdrfilm"><integer name="width" value="$res"/></film></sensor>
<bsdf type="twosided" id="red"><bsdf type="diffuse"><rgb name="reflectance" value=".5 .1 .1"/>
</bsdf></bsdf><alias id="red" as="rot"/>
<shape type="sphere"><point name="center" x="0" y="1" z="2"/><ref id="rot"/>
<emitter type="area"><spectrum name="radiance" value="400:1, 500:2, 700:3"/></emitter></shape>
</scene>
"#;

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(3),
        ..ProptestConfig::with_cases(150)
    })]

    #[test]
    fn what_was_written_is_read(tree in tree()) {
        let outcome = read_bytes(scene(&tree).as_bytes());
        let document = outcome.sound();
        prop_assert!(document.is_some(), "{}", outcome.lines());
        let root = &document.expect("just looked").root;
        let Value::Object(node) = &root.properties[0].value else { panic!("an object") };
        tree.assert_is(node, &outcome.sources);
    }

    #[test]
    fn truncated_scenes_are_refused(cut in any::<Index>()) {
        let text = RICH.trim_end();
        let outcome = read_bytes(&text.as_bytes()[..cut.index(text.len())]);
        prop_assert!(outcome.has_errors());
        prop_assert!(outcome.document.is_none());
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(5),
        ..ProptestConfig::with_cases(1500)
    })]

    #[test]
    fn mutated_scenes_do_no_harm(
        edits in prop::collection::vec((any::<Index>(), any::<Index>(), 0u8..4, any::<u8>()), 1..6),
    ) {
        let mut bytes = RICH.as_bytes().to_vec();
        for (from, to, kind, byte) in edits {
            let (from, to) = (from.index(bytes.len()), to.index(bytes.len()));
            let (low, high) = (from.min(to), from.max(to).min(from.min(to) + 60));
            match kind {
                0 => bytes[from] = byte,
                1 => drop(bytes.drain(low..high)),
                2 => {
                    let copy = bytes[low..high].to_vec();
                    bytes.splice(to..to, copy);
                }
                _ => bytes[from] = b"<>/\"$ 0"[usize::from(byte) % 7],
            }
            if bytes.is_empty() {
                bytes.push(byte);
            }
        }
        let start = Instant::now();
        let outcome = read_bytes(&bytes);
        // Rendering a message looks up every position.
        let _ = outcome.lines();
        prop_assert!(start.elapsed() < Duration::from_secs(1));
        prop_assert!(outcome.document.is_some() || outcome.has_errors());
    }
}

#[test]
fn the_rich_scene_is_sound() {
    let outcome = read_bytes(RICH.as_bytes());
    assert!(outcome.sound().is_some(), "{}", outcome.lines());
}

#[test]
fn huge_and_strange_files_are_refused_quickly() {
    let deep = "<a>".repeat(1_000_000);
    let wide = format!("<scene version='3.0.0'>{}</scene>", "<x/>".repeat(300_000));
    let text = format!(
        "<scene version='3.0.0'>{}</scene>",
        "text <!-- -->".repeat(200_000)
    );
    let long = format!(
        "<scene version='3.0.0'><rgb name='a' value='{}'/><ref id='{0}'/></scene>",
        "9 ".repeat(200_000)
    );
    for bytes in [deep, wide, text, long] {
        let start = Instant::now();
        let outcome = read_bytes(bytes.as_bytes());
        assert!(outcome.lines().len() < 100_000);
        assert!(start.elapsed() < Duration::from_secs(5));
        assert!(!outcome.diagnostics.is_empty());
    }
}
