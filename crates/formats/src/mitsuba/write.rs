//! Scenes out: the description tree as Mitsuba's XML, with what stands within a document as files beside it.
//!
//! An object that several others share is written where it is met first, with an `id`, and is a `<ref>` from then on. Numbers are written so
//! that the same ones are read. A motion along curves is written as 32 straight pieces for each.

use crate::document::{Document, embedded_name, mesh_name};
use crate::ply;
use etalon_params::{Class, DMat4, Node, Property, SpectrumText, Value};
use std::collections::{HashMap, HashSet};
use std::fmt::Write;
use std::sync::Arc;

/// Straight pieces of a curve.
const PIECES: usize = 32;

/// A scene as files.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenScene {
    /// The scene file.
    pub xml: String,
    /// The names of the files beside it, and what is in them.
    pub files: Vec<(String, Vec<u8>)>,
}

/// Writes a scene. The files beside it begin with `stem`; `place` says under which name another file is found from there.
pub fn write(document: &Document, stem: &str, place: &dyn Fn(&str) -> String) -> WrittenScene {
    let mut names = HashMap::new();
    let mut files = Vec::new();
    for (index, mesh) in document.meshes.iter().enumerate() {
        let name = format!("{stem}-mesh-{index}.ply");
        names.insert(mesh_name(index), name.clone());
        files.push((name, ply::write(mesh)));
    }
    for (&index, bytes) in &document.embedded {
        let name = format!("{stem}-file-{index}.{}", ending(bytes));
        names.insert(embedded_name(index), name.clone());
        files.push((name, bytes.to_vec()));
    }
    let mut writer = Writer {
        text: String::new(),
        shared: shared(&document.root),
        written: HashMap::new(),
        taken: ids(&document.root),
        names,
        place,
    };
    writer.line(0, "<scene version=\"3.0.0\">");
    for property in &document.root.properties {
        writer.property(property, 1);
    }
    writer.line(0, "</scene>");
    WrittenScene {
        xml: writer.text,
        files,
    }
}

/// What the name of a file with these bytes ends in.
fn ending(bytes: &[u8]) -> &'static str {
    match bytes {
        [b'V', b'O', b'L', ..] => "vol",
        [0x89, b'P', b'N', b'G', ..] => "png",
        [0xff, 0xd8, ..] => "jpg",
        _ => "txt",
    }
}

/// All nodes, each once.
fn nodes(root: &Arc<Node>) -> Vec<&Arc<Node>> {
    let mut seen = HashSet::new();
    let mut open = vec![root];
    let mut found = Vec::new();
    while let Some(node) = open.pop() {
        if seen.insert(Arc::as_ptr(node)) {
            found.push(node);
            open.extend(objects(node));
        }
    }
    found
}

fn objects(node: &Node) -> impl Iterator<Item = &Arc<Node>> {
    node.properties.iter().filter_map(|p| match &p.value {
        Value::Object(object) => Some(object),
        _ => None,
    })
}

/// The nodes that several others have.
fn shared(root: &Arc<Node>) -> HashSet<*const Node> {
    let mut met = HashSet::new();
    let all = nodes(root);
    let again = all.iter().flat_map(|node| objects(node)).map(Arc::as_ptr);
    again.filter(|node| !met.insert(*node)).collect()
}

fn ids(root: &Arc<Node>) -> HashSet<String> {
    let all = nodes(root);
    all.iter().filter_map(|node| node.id.clone()).collect()
}

struct Writer<'a> {
    text: String,
    shared: HashSet<*const Node>,
    /// The ids of shared nodes that stand already.
    written: HashMap<*const Node, String>,
    taken: HashSet<String>,
    /// Files within the document, by the names that the tree has for them.
    names: HashMap<String, String>,
    place: &'a dyn Fn(&str) -> String,
}

impl Writer<'_> {
    fn line(&mut self, depth: usize, text: &str) {
        // Writing into a string does not fail.
        let _ = writeln!(self.text, "{}{text}", "    ".repeat(depth));
    }

    fn property(&mut self, property: &Property, depth: usize) {
        let name = match property.name.as_str() {
            "" => String::new(),
            name => format!(" name=\"{}\"", escaped(name)),
        };
        let plain = |tag: &str, value: String| format!("<{tag}{name} value=\"{value}\"/>");
        let line = match &property.value {
            Value::Float(x) => plain("float", format!("{x:?}")),
            Value::Integer(i) => plain("integer", i.to_string()),
            Value::Boolean(b) => plain("boolean", b.to_string()),
            Value::String(text) => {
                let text = match property.name.as_str() {
                    "filename" => self.file(text),
                    _ => text.clone(),
                };
                plain("string", escaped(&text))
            }
            Value::Vector(v) => {
                format!(
                    "<vector{name} x=\"{:?}\" y=\"{:?}\" z=\"{:?}\"/>",
                    v.x, v.y, v.z
                )
            }
            Value::Rgb(c) => plain("rgb", numbers(&c.to_array())),
            Value::Spectrum(SpectrumText::Uniform(x)) => plain("spectrum", format!("{x:?}")),
            Value::Spectrum(SpectrumText::Samples(pairs)) => {
                let pairs = pairs.iter().map(|(nm, x)| format!("{nm:?}:{x:?}"));
                plain("spectrum", pairs.collect::<Vec<_>>().join(", "))
            }
            Value::Transform(matrix) => {
                self.transform(&format!("<transform{name}>"), matrix, depth);
                return;
            }
            Value::Animation { motion, .. } => {
                self.line(depth, &format!("<animation{name}>"));
                for (time, matrix) in motion.straight_keys(PIECES) {
                    let tag = format!("<transform time=\"{time:?}\">");
                    self.transform(&tag, &matrix, depth + 1);
                }
                self.line(depth, "</animation>");
                return;
            }
            Value::Object(node) => {
                self.object(&name, node, depth);
                return;
            }
        };
        self.line(depth, &line);
    }

    fn transform(&mut self, tag: &str, matrix: &DMat4, depth: usize) {
        self.line(depth, tag);
        let rows = numbers(&matrix.transpose().to_cols_array());
        self.line(depth + 1, &format!("<matrix value=\"{rows}\"/>"));
        self.line(depth, "</transform>");
    }

    fn object(&mut self, name: &str, node: &Arc<Node>, depth: usize) {
        let pointer = Arc::as_ptr(node);
        if let Some(id) = self.written.get(&pointer) {
            let reference = format!("<ref{name} id=\"{}\"/>", escaped(id));
            self.line(depth, &reference);
            return;
        }
        let tag = node.class.name();
        let id = match &node.id {
            Some(id) => Some(id.clone()),
            None if self.shared.contains(&pointer) => Some(self.free_id(node)),
            None => None,
        };
        let id_text = id.iter().map(|id| format!(" id=\"{}\"", escaped(id)));
        let id_text = id_text.collect::<String>();
        if let Some(id) = id {
            self.written.insert(pointer, id);
        }
        let start = format!(
            "<{tag} type=\"{}\"{name}{id_text}",
            escaped(&node.plugin.value)
        );
        if node.properties.is_empty() {
            self.line(depth, &format!("{start}/>"));
            return;
        }
        self.line(depth, &format!("{start}>"));
        for property in &node.properties {
            self.property(property, depth + 1);
        }
        self.line(depth, &format!("</{tag}>"));
    }

    /// An id that nothing has: `bsdf-3`.
    fn free_id(&mut self, node: &Node) -> String {
        let class = match node.class {
            Class::ReconstructionFilter => "filter",
            other => other.name(),
        };
        let mut number = self.written.len() + 1;
        loop {
            let id = format!("{class}-{number}");
            if self.taken.insert(id.clone()) {
                return id;
            }
            number += 1;
        }
    }

    fn file(&self, name: &str) -> String {
        match self.names.get(name) {
            Some(beside) => beside.clone(),
            None => (self.place)(name),
        }
    }
}

fn numbers(list: &[f64]) -> String {
    let list: Vec<String> = list.iter().map(|x| format!("{x:?}")).collect();
    list.join(" ")
}

/// A text as it stands in an attribute.
pub fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            '\n' | '\t' | '\r' => {
                let _ = write!(escaped, "&#{};", letter as u32);
            }
            other => escaped.push(other),
        }
    }
    escaped
}
