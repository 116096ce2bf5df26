//! Tests of the mapping: a text of pbrt against the XML that means the same.

mod entities;
mod forms;
mod grids;
mod hostile;
mod lights;
mod materials;
mod mistakes;
mod scenes;
mod settings;
mod shapes;
mod textures;
mod written;

use crate::{Document, ReadOptions, ReadOutcome, mitsuba, pbrt};
use etalon_params::{Node, SpectrumText, Value};
use std::fmt::Write;
use std::sync::Arc;

/// Reads a text of pbrt.
fn read(text: &str) -> ReadOutcome {
    pbrt::read_text("a.pbrt", text, &ReadOptions::default())
}

/// Reads what stands in a world.
fn world(text: &str) -> ReadOutcome {
    read(&format!("WorldBegin\n{text}"))
}

/// The document of a text without mistakes and notes.
fn sound(text: &str) -> Document {
    let outcome = read(text);
    assert_eq!(outcome.lines(), "");
    outcome.document.expect("a document")
}

/// The document of an XML text, which stands within `<scene>`.
fn xml(text: &str) -> Document {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.xml");
    let whole = format!("<scene version=\"3.0.0\">{text}</scene>");
    std::fs::write(&path, whole).expect("written");
    let outcome = mitsuba::read(&path, &ReadOptions::default());
    assert_eq!(outcome.lines(), "");
    outcome.document.expect("a document")
}

/// Asserts that a pbrt text has, of the classes that the XML has, the same objects.
#[track_caller]
fn assert_same(pbrt: &str, mitsuba: &str) {
    let (found, expected) = (sound(pbrt), xml(mitsuba));
    assert_alike(&found, &expected);
}

#[track_caller]
fn assert_alike(found: &Document, expected: &Document) {
    let expected = children(&expected.root);
    let is_asked = |node: &&Arc<Node>| expected.iter().any(|other| other.class == node.class);
    let found: Vec<String> = (children(&found.root).iter().filter(is_asked))
        .map(|node| shown(node))
        .collect();
    let expected: Vec<String> = expected.iter().map(|node| shown(node)).collect();
    assert_eq!(found.join("\n"), expected.join("\n"));
}

/// The same of what stands in a world.
#[track_caller]
fn assert_same_world(pbrt: &str, mitsuba: &str) {
    assert_same(&format!("WorldBegin\n{pbrt}"), mitsuba);
}

fn children(node: &Node) -> Vec<Arc<Node>> {
    let objects = node.properties.iter().filter_map(|p| match &p.value {
        Value::Object(object) => Some(Arc::clone(object)),
        _ => None,
    });
    objects.collect()
}

/// A node as a text that knows no places: its properties in the order of their names, those without names in their own.
fn shown(node: &Node) -> String {
    let mut properties: Vec<(&str, String)> = (node.properties.iter())
        .map(|property| (property.name.as_str(), shown_value(&property.value)))
        .collect();
    properties.sort_by_key(|(name, _)| *name);
    let mut text = format!("{} {} {{", node.class.name(), node.plugin.value);
    for (name, value) in properties {
        for (i, line) in value.lines().enumerate() {
            let begin = if i == 0 {
                format!("{name}: ")
            } else {
                String::new()
            };
            let _ = write!(text, "\n    {begin}{line}");
        }
    }
    text + "\n}"
}

fn shown_value(value: &Value) -> String {
    match value {
        Value::Float(x) => format!("float {}", number(*x)),
        Value::Integer(i) => format!("integer {i}"),
        Value::Boolean(b) => format!("boolean {b}"),
        Value::String(s) => format!("string {s}"),
        Value::Vector(v) => format!("vector {}", numbers(&v.to_array())),
        Value::Rgb(v) => format!("rgb {}", numbers(&v.to_array())),
        Value::Spectrum(SpectrumText::Uniform(x)) => format!("spectrum {}", number(*x)),
        Value::Spectrum(SpectrumText::Samples(pairs)) => {
            let pairs: Vec<f64> = pairs.iter().flat_map(|(nm, x)| [*nm, *x]).collect();
            format!("spectrum {}", numbers(&pairs))
        }
        Value::Transform(m) => format!("transform {}", numbers(&m.to_cols_array())),
        Value::Animation { motion, middle } => {
            let at = [0.0, 0.3, 1.0].map(|time| numbers(&motion.at(time).to_cols_array()));
            format!("animation {} {at:?}", numbers(&middle.to_cols_array()))
        }
        Value::Object(node) => shown(node),
    }
}

fn numbers(list: &[f64]) -> String {
    let list: Vec<String> = list.iter().map(|x| number(*x)).collect();
    list.join(" ")
}

/// Seven digits, and no negative zero.
fn number(x: f64) -> String {
    let x = if x.abs() < 1e-12 { 0.0 } else { x };
    format!("{x:.6e}")
}
