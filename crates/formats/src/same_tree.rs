//! Whether two descriptions are the same but for their places, for tests of readers: what they make of a text against what the XML
//! that means the same becomes.

use crate::{Document, ReadOptions, mitsuba};
use etalon_params::{Node, SpectrumText, Value};
use std::fmt::Write;
use std::sync::Arc;

/// The document of an XML text, which stands within `<scene>`.
pub(crate) fn xml(text: &str) -> Document {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.xml");
    let whole = format!("<scene version=\"3.0.0\">{text}</scene>");
    std::fs::write(&path, whole).expect("written");
    let outcome = mitsuba::read(&path, &ReadOptions::default());
    assert_eq!(outcome.lines(), "");
    outcome.document.expect("a document")
}

/// Asserts that a description has, of the classes that the other has, the same objects.
#[track_caller]
pub(crate) fn assert_alike(found: &Document, expected: &Document) {
    let expected = children(&expected.root);
    let is_asked = |node: &&Arc<Node>| expected.iter().any(|other| other.class == node.class);
    let found: Vec<String> = (children(&found.root).iter().filter(is_asked))
        .map(|node| shown(node))
        .collect();
    let expected: Vec<String> = expected.iter().map(|node| shown(node)).collect();
    assert_eq!(found.join("\n"), expected.join("\n"));
}

/// The objects within a node.
pub(crate) fn children(node: &Node) -> Vec<Arc<Node>> {
    let objects = node.properties.iter().filter_map(|p| match &p.value {
        Value::Object(object) => Some(Arc::clone(object)),
        _ => None,
    });
    objects.collect()
}

/// A node as a text that knows no places: its properties in the order of their names, those without names in their own.
pub(crate) fn shown(node: &Node) -> String {
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

/// A value as such a text.
pub(crate) fn shown_value(value: &Value) -> String {
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

/// Numbers as a text.
pub(crate) fn numbers(list: &[f64]) -> String {
    let list: Vec<String> = list.iter().map(|x| number(*x)).collect();
    list.join(" ")
}

/// Seven digits, and no negative zero.
fn number(x: f64) -> String {
    let x = if x.abs() < 1e-12 { 0.0 } else { x };
    format!("{x:.6e}")
}
