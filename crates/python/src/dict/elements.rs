//! A tree of objects as elements of XML, one in a line.

use super::arrays;
use super::file_arrays::FileArray;
use super::mistakes::Mistakes;
use super::object::{self, Entry, Ids, Object};
use super::{Keys, NAME, SceneDict, mesh, plugins, values};
use etalon_formats::mitsuba::{self, SceneInMemory};
use etalon_formats::{embedded_name, ply};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::fmt::Display;
use std::sync::Arc;

/// The text so far.
pub(super) struct Elements<'a, 'py> {
    ids: Ids<'a, 'py>,
    with_arrays: bool,
    text: String,
    keys: Vec<String>,
    files: Vec<Arc<Vec<u8>>>,
    mistakes: Mistakes,
}

impl<'a, 'py> Elements<'a, 'py> {
    pub(super) fn new(ids: Ids<'a, 'py>, with_arrays: bool) -> Self {
        Self {
            ids,
            with_arrays,
            text: String::new(),
            keys: Vec::new(),
            files: Vec::new(),
            mistakes: Mistakes::default(),
        }
    }

    /// The text, or an exception with all mistakes.
    pub(super) fn finish(self) -> PyResult<SceneDict> {
        self.mistakes.raise()?;
        Ok(SceneDict {
            scene: SceneInMemory {
                name: NAME.to_owned(),
                text: self.text,
                files: self.files,
            },
            keys: Keys(self.keys),
        })
    }

    pub(super) fn scene(&mut self, root: &'a Object<'py>) -> PyResult<()> {
        self.line("", 0, "<scene version=\"3.0.0\">");
        for (key, entry) in &root.entries {
            let path = root.path_of(key);
            match entry {
                // Colours in a scene are there to be referred to, and are written where they are.
                Entry::Object(object) if object.is_colour() => {
                    self.colour(object, &path, ("name", key));
                }
                Entry::Object(object) => self.object(object, &path, key, 1)?,
                Entry::Value(value) => self.value(value, &path, ("name", key), 1)?,
            }
        }
        self.line("", 0, "</scene>");
        Ok(())
    }

    fn line(&mut self, path: &str, depth: usize, element: &str) {
        self.text += &"    ".repeat(depth);
        self.text += element;
        self.text.push('\n');
        self.keys.push(path.to_owned());
    }

    /// What the key `key` at `path` stands for.
    fn object(
        &mut self,
        object: &'a Object<'py>,
        path: &str,
        key: &str,
        depth: usize,
    ) -> PyResult<()> {
        if object.is_colour() {
            let element = self.colour(object, path, ("name", key));
            element.inspect(|element| self.line(path, depth, element));
            return Ok(());
        }
        match object.kind.as_str() {
            "ref" => self.reference(object, path, key, depth),
            "resources" => {
                if let Some(folder) = self.only(object, &["path"]) {
                    match values::text(folder)? {
                        Some(folder) => {
                            self.line(path, depth, &element("path", &[("value", &folder)]));
                        }
                        None => self.mistakes.add(path, "`path` is a string or a path"),
                    }
                }
            }
            "animation" => return self.animation(object, path, key, depth),
            _ => return self.plugin(object, path, key, depth),
        }
        Ok(())
    }

    /// The only entry that an object has, which is a value of one of these keys.
    fn only<'o>(
        &mut self,
        object: &'o Object<'py>,
        keys: &[&str],
    ) -> Option<&'o Bound<'py, PyAny>> {
        match &object.entries[..] {
            [(key, Entry::Value(value))] if keys.contains(&key.as_str()) => Some(value),
            entries => {
                let found: Vec<&str> = entries.iter().map(|(key, _)| key.as_str()).collect();
                let (kind, wanted) = (&object.kind, keys.join("` or `"));
                let message = match &found[..] {
                    [] => format!("`{kind}` has a `{wanted}` besides its type"),
                    found => format!(
                        "`{kind}` has a single `{wanted}` besides its type, not `{}`",
                        found.join("`, `")
                    ),
                };
                self.mistakes.add(&object.path, message);
                None
            }
        }
    }

    /// The element of an `rgb` or a `spectrum`, unless it has a mistake.
    fn colour(&mut self, object: &Object<'py>, path: &str, label: Label<'_>) -> Option<String> {
        let is_rgb = object.kind == "rgb";
        let keys: &[&str] = if is_rgb {
            &["value"]
        } else {
            &["value", "filename"]
        };
        let value = self.only(object, keys)?;
        if let (false, Some(file)) = (is_rgb, object.value("filename")) {
            let file = values::text(file).ok().flatten();
            if file.is_none() {
                self.mistakes.add(path, "`filename` is a string or a path");
            }
            return file.map(|file| element("spectrum", &[label, ("filename", &file)]));
        }
        let written = match is_rgb {
            true => values::rgb(value),
            false => values::spectrum(value),
        };
        match written {
            Ok(text) => Some(element(&object.kind, &[label, ("value", &text)])),
            Err(reason) => {
                self.mistakes
                    .add(path, format!("the value of `{}` {reason}", object.kind));
                None
            }
        }
    }

    fn reference(&mut self, object: &'a Object<'py>, path: &str, key: &str, depth: usize) {
        // `id` was taken for the object's own.
        let (Some(id), []) = (&object.id, &object.entries[..]) else {
            self.mistakes.add(
                path,
                "a `ref` has an `id` besides its type, and nothing else",
            );
            return;
        };
        let found = self.ids.find(id);
        if let Some(colour) = found.filter(|found| found.is_colour()) {
            let element = self.colour(colour, path, ("name", key));
            element.inspect(|element| self.line(path, depth, element));
            return;
        }
        let name = found.and_then(|found| self.ids.name(found)).unwrap_or(id);
        self.line(path, depth, &element("ref", &[("name", key), ("id", name)]));
    }

    fn plugin(
        &mut self,
        object: &'a Object<'py>,
        path: &str,
        key: &str,
        depth: usize,
    ) -> PyResult<()> {
        let is_mesh = object.kind == "mesh";
        let kind = if is_mesh { "ply" } else { object.kind.as_str() };
        let has_filename = object.value("filename").is_some();
        let Some(class) = plugins::class(kind, has_filename) else {
            self.mistakes
                .push(&object.path_of("type"), plugins::unknown(kind));
            return Ok(());
        };
        let mut attributes = vec![("type", kind), ("name", key)];
        attributes.extend(self.ids.name(object).map(|id| ("id", id)));
        let (tag, start) = (class.name(), element(class.name(), &attributes));
        if object.entries.is_empty() {
            self.line(path, depth, &start);
            return Ok(());
        }
        self.line(path, depth, &start.replace("/>", ">"));
        if is_mesh {
            match mesh::of_object(object)? {
                Ok(mesh) => self.file(ply::write(&mesh), path, depth + 1),
                Err((key, reason)) => self.mistakes.add(&object.path_of(&key), reason),
            }
        }
        for (key, entry) in &object.entries {
            let path = object.path_of(key);
            match entry {
                Entry::Value(_) if is_mesh && mesh::is_part(key) => {}
                Entry::Value(value) => match FileArray::of_key(kind, key) {
                    Some(kind) => match arrays::file(kind, value, None)? {
                        Ok(file) => self.file(file, &path, depth + 1),
                        Err(reason) => self.mistakes.add(&path, reason),
                    },
                    None => self.value(value, &path, ("name", key), depth + 1)?,
                },
                Entry::Object(object) => self.object(object, &path, key, depth + 1)?,
            }
        }
        self.line(path, depth, &format!("</{tag}>"));
        Ok(())
    }

    /// The `filename` of an array.
    fn file(&mut self, contents: Vec<u8>, path: &str, depth: usize) {
        if !self.with_arrays {
            let message = "an array does not stand in a text";
            self.mistakes.add_with_help(
                path,
                message,
                "write it to a file, and give its `filename`",
            );
        }
        let name = embedded_name(self.files.len());
        self.files.push(Arc::new(contents));
        self.line(
            path,
            depth,
            &element("string", &[("name", "filename"), ("value", &name)]),
        );
    }

    fn value(
        &mut self,
        value: &Bound<'py, PyAny>,
        path: &str,
        label: Label<'_>,
        depth: usize,
    ) -> PyResult<()> {
        match values::value(value, label == ("name", "to_uv"))? {
            Ok(values::Written::Attribute(tag, text)) => {
                self.line(path, depth, &element(tag, &[label, ("value", &text)]));
            }
            Ok(values::Written::Matrix(numbers)) => {
                let label = attribute(label.0, label.1);
                let matrix = element("matrix", &[("value", &numbers)]);
                let transform = format!("<transform{label}>{matrix}</transform>");
                self.line(path, depth, &transform);
            }
            Err(reason) => self.mistakes.add(path, reason),
        }
        Ok(())
    }

    /// An `animation`: `keys` are pairs of a time and a value, as `interpolation` says between.
    fn animation(
        &mut self,
        object: &Object<'py>,
        path: &str,
        key: &str,
        depth: usize,
    ) -> PyResult<()> {
        let mut attributes = vec![("name", key.to_owned())];
        let mut keys = None;
        for (key, entry) in &object.entries {
            let path = object.path_of(key);
            match (key.as_str(), entry) {
                ("keys", Entry::Value(value)) => {
                    let pairs = value.extract::<Vec<(f64, Bound<'py, PyAny>)>>();
                    let wrong = "the keys of an animation are pairs (time, value)";
                    keys = pairs.map_err(|_| self.mistakes.add(&path, wrong)).ok();
                }
                ("interpolation", Entry::Value(value)) => match values::text(value)? {
                    Some(text) => attributes.push(("interpolation", text)),
                    None => self.mistakes.add(&path, "it is a string"),
                },
                _ => {
                    let message =
                        "an animation has `keys` and an `interpolation`, and nothing else";
                    self.mistakes.add(&path, message);
                }
            }
        }
        let start = element("animation", &attributes).replace("/>", ">");
        self.line(path, depth, &start);
        for (time, value) in keys.unwrap_or_default() {
            let time = format!("{time:?}");
            let label = ("time", time.as_str());
            match value.cast::<PyDict>() {
                Ok(dict) => {
                    let (path, open) = (path.to_owned(), &mut Vec::new());
                    let read = object::read(dict, path.clone(), open, &mut self.mistakes)?;
                    let element = match read {
                        Some(colour) if colour.is_colour() => self.colour(&colour, &path, label),
                        _ => {
                            let message = "the values of an animation are no objects";
                            self.mistakes.add(&path, message);
                            None
                        }
                    };
                    element.inspect(|element| self.line(&path, depth + 1, element));
                }
                Err(_) => self.value(&value, path, label, depth + 1)?,
            }
        }
        self.line(path, depth, "</animation>");
        Ok(())
    }
}

/// The attribute that says what a value is for: its `name`, or in an animation its `time`.
type Label<'k> = (&'static str, &'k str);

fn element(tag: &str, attributes: &[(&str, impl Display)]) -> String {
    let attributes = attributes.iter();
    let attributes = attributes.map(|(name, text)| attribute(name, text));
    format!("<{tag}{}/>", attributes.collect::<String>())
}

/// An attribute that is read as this text: nothing in a dict is a `$parameter`.
fn attribute(name: &str, text: impl Display) -> String {
    let text = text.to_string().replace('$', r"\$");
    format!(" {name}=\"{}\"", mitsuba::escaped(&text))
}
