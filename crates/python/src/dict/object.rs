//! A dict as a tree of objects, with its form checked.

use super::mistakes::Mistakes;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use std::collections::HashMap;

/// How deep dicts may nest, as elements of XML.
const MOST_LEVELS: usize = 128;

/// A dict with a `type`.
pub(super) struct Object<'py> {
    /// The keys that lead to it, with points between.
    pub(super) path: String,
    /// Its `type`.
    pub(super) kind: String,
    /// Its `id`, if it has one besides its key.
    pub(super) id: Option<String>,
    /// All other keys with what they stand for.
    pub(super) entries: Vec<(String, Entry<'py>)>,
}

/// What a key stands for.
pub(super) enum Entry<'py> {
    Object(Object<'py>),
    Value(Bound<'py, PyAny>),
}

impl<'py> Object<'py> {
    /// The path of one of its keys.
    pub(super) fn path_of(&self, key: &str) -> String {
        join(&self.path, key)
    }

    /// The value of a key, if it has one.
    pub(super) fn value(&self, key: &str) -> Option<&Bound<'py, PyAny>> {
        self.entries.iter().find_map(|(name, entry)| match entry {
            Entry::Value(value) if name == key => Some(value),
            _ => None,
        })
    }

    pub(super) fn objects(&self) -> impl Iterator<Item = &Object<'py>> {
        self.entries.iter().filter_map(|(_, entry)| match entry {
            Entry::Object(object) => Some(object),
            Entry::Value(_) => None,
        })
    }

    /// Whether it is no plugin, but a colour or spectrum.
    pub(super) fn is_colour(&self) -> bool {
        matches!(self.kind.as_str(), "rgb" | "spectrum")
    }

    /// It and all objects within.
    fn all<'a>(&'a self, found: &mut Vec<&'a Self>) {
        found.push(self);
        self.objects().for_each(|object| object.all(found));
    }
}

fn join(path: &str, key: &str) -> String {
    match path {
        "" => key.to_owned(),
        path => format!("{path}.{key}"),
    }
}

/// The objects of a tree by what they are called: an `id`, or else a path of keys, as in Mitsuba.
pub(super) struct Ids<'a, 'py> {
    given: HashMap<&'a str, &'a Object<'py>>,
    paths: HashMap<&'a str, &'a Object<'py>>,
}

impl<'a, 'py> Ids<'a, 'py> {
    pub(super) fn of(root: &'a Object<'py>) -> Self {
        let mut all = Vec::new();
        root.all(&mut all);
        // What a `ref` has for an `id` is another's.
        all.retain(|object| object.kind != "ref");
        let given = all.iter().filter_map(|o| Some((o.id.as_deref()?, *o)));
        Self {
            given: given.collect(),
            paths: all.iter().map(|o| (o.path.as_str(), *o)).collect(),
        }
    }

    pub(super) fn find(&self, id: &str) -> Option<&'a Object<'py>> {
        self.given.get(id).or_else(|| self.paths.get(id)).copied()
    }

    /// What an object is called in XML, which has one space of names; none if another has its path for an `id`.
    pub(super) fn name<'o>(&self, object: &'o Object<'py>) -> Option<&'o str> {
        let path = Some(object.path.as_str()).filter(|path| !self.given.contains_key(path));
        object.id.as_deref().or(path)
    }
}

/// Reads a dict with all dicts in it; `None` if it has no type. `open` are those that it is in.
pub(super) fn read<'py>(
    dict: &Bound<'py, PyDict>,
    path: String,
    open: &mut Vec<Bound<'py, PyDict>>,
    mistakes: &mut Mistakes,
) -> PyResult<Option<Object<'py>>> {
    if open.iter().any(|other| other.is(dict)) {
        mistakes.add(&path, "the dict contains itself");
        return Ok(None);
    }
    if open.len() >= MOST_LEVELS {
        let message = format!("dicts are nested more than {MOST_LEVELS} levels deep");
        mistakes.add(&path, message);
        return Ok(None);
    }
    let mut object = Object {
        path,
        kind: String::new(),
        id: None,
        entries: Vec::new(),
    };
    let mut has_kind = false;
    open.push(dict.clone());
    for (key, value) in dict.iter() {
        let Ok(key) = key.cast::<PyString>().map(|key| key.to_string()) else {
            let message = format!("the key {} is no string", key.repr()?);
            mistakes.add(&object.path, message);
            continue;
        };
        let path = object.path_of(&key);
        if key == "type" || key == "id" {
            match value.cast::<PyString>() {
                Ok(text) if key == "type" => object.kind = text.to_string().to_ascii_lowercase(),
                Ok(text) => object.id = Some(text.to_string()),
                Err(_) => mistakes.add(&path, format!("it is a string, not {}", named(&value))),
            }
            has_kind |= key == "type";
        } else if let Ok(dict) = value.cast::<PyDict>() {
            if key.contains('.') {
                let message = "a key of an object has no point, which stands between keys";
                mistakes.add_with_help(&path, message, "write an underscore");
                continue;
            }
            let nested = read(dict, path, open, mistakes)?;
            object
                .entries
                .extend(nested.map(|object| (key, Entry::Object(object))));
        } else {
            object.entries.push((key, Entry::Value(value)));
        }
    }
    open.pop();
    if !has_kind {
        let keys = dict.keys().iter().map(|key| key.to_string());
        let keys: Vec<String> = keys.take(6).collect();
        let message = match keys.join(", ").as_str() {
            "" => "the empty dict has no `type`".to_owned(),
            keys => format!("the dict with the keys {keys} has no `type`"),
        };
        mistakes.add_with_help(&object.path, message, "such as 'type': 'sphere'");
        return Ok(None);
    }
    Ok(Some(object))
}

/// What a value is, for messages: `a set`, `None`.
pub(super) fn named(value: &Bound<'_, PyAny>) -> String {
    if value.is_none() {
        return "None".to_owned();
    }
    let kind = value.get_type().name().map(|name| name.to_string());
    let kind = kind.unwrap_or_else(|_| "object".to_owned());
    let vowel = kind.starts_with(['a', 'e', 'i', 'o', 'u', 'A', 'E', 'I', 'O', 'U']);
    format!("{} {kind}", if vowel { "an" } else { "a" })
}
