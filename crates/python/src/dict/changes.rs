//! Values that replace those of a scene, given as in a dict.

use super::changed_files::ChangedFiles;
use super::elements::Elements;
use super::mistakes::Mistakes;
use super::object::{self, Entry, Ids, Object};
use super::{SceneDict, values};
use crate::errors::scene_error;
use crate::listing::{Change, FILE, Listing, split};
use etalon_formats::{FileAssets, ReadOptions, mitsuba};
use etalon_params::{Class, Diagnostic, Value};
use etalon_render::pipeline::LoadError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::collections::BTreeMap;

/// The changes in a dict from paths of keys to values, for a scene with these objects and files.
pub(crate) fn read(
    dict: &Bound<'_, PyDict>,
    scene: &Listing<'_>,
    files: &dyn Fn() -> FileAssets,
) -> PyResult<Vec<Change>> {
    let mut mistakes = Mistakes::default();
    let mut arrays = ChangedFiles::new(files);
    // A plugin that takes anything, in a scene: one for each object that has changes.
    let stand_in = |path: &str, kind: &str, entries| Object {
        path: path.to_owned(),
        kind: kind.to_owned(),
        id: None,
        entries,
    };
    let mut objects: BTreeMap<String, Vec<(String, Entry<'_>)>> = BTreeMap::new();
    for (path, value) in dict.iter() {
        let path: String = path.extract()?;
        let Some((object, key)) = split(&path) else {
            mistakes.add_with_help(&path, "this is no value", "such as `ball.radius`");
            continue;
        };
        let Some(node) = scene.object(object) else {
            let message = format!("the scene has no object `{object}`");
            let diagnostic = Diagnostic::error_nowhere(message);
            mistakes.push(&path, diagnostic.suggest(object, scene.paths()));
            continue;
        };
        let old = node.property(key).map(|property| &property.value);
        if arrays.take((object, node), key, &value, &mut mistakes)? {
            continue;
        }
        if key == FILE {
            mistakes.add_with_help(&path, "the file has been read", "load the scene again");
            continue;
        }
        if let Some(Value::Object(old)) = old
            && old.class != Class::Texture
        {
            let class = old.class.name();
            mistakes.add(&path, format!("this is an object ({class}) and no value"));
            continue;
        }
        let entry = match (value.cast::<PyDict>(), colour(&value, old)) {
            (Ok(dict), _) => {
                match object::read(dict, path.clone(), &mut Vec::new(), &mut mistakes)? {
                    Some(colour) if colour.is_colour() => Entry::Object(colour),
                    Some(_) => {
                        mistakes.add(&path, "objects cannot be replaced, only their values");
                        continue;
                    }
                    None => continue,
                }
            }
            (_, Some(kind)) => {
                let value = ("value".to_owned(), Entry::Value(value));
                Entry::Object(stand_in(&path, kind, vec![value]))
            }
            _ => Entry::Value(value),
        };
        let entries = objects.entry(object.to_owned()).or_default();
        entries.push((key.to_owned(), entry));
    }
    let mut changes = arrays.finish(&mut mistakes);
    mistakes.raise()?;
    let objects = objects.into_iter().map(|(path, entries)| {
        let object = stand_in(&path, "diffuse", entries);
        (String::new(), Entry::Object(object))
    });
    let root = stand_in("", "scene", objects.collect());
    let mut elements = Elements::new(Ids::of(&root), false);
    elements.scene(&root)?;
    changes.extend(values_of(&elements.finish()?, &root)?);
    Ok(changes)
}

/// What a value is written as that is a colour, in place of an old one.
fn colour(value: &Bound<'_, PyAny>, old: Option<&Value>) -> Option<&'static str> {
    let is_number = value.extract::<f64>().is_ok();
    match (values::shape(value).as_deref(), old) {
        (Some([3]), None | Some(Value::Vector(_))) => None,
        (Some([3]), _) => Some("rgb"),
        (Some([_, 2]), _) => Some("spectrum"),
        (None, Some(Value::Rgb(_))) if is_number => Some("rgb"),
        (None, Some(Value::Spectrum(_))) if is_number => Some("spectrum"),
        _ => None,
    }
}

/// The values as they are read from the text of stand-ins.
fn values_of(text: &SceneDict, root: &Object<'_>) -> PyResult<Vec<Change>> {
    let read = mitsuba::read_in_memory(&text.scene, &ReadOptions::default());
    let Some(document) = read.sound() else {
        let error = LoadError {
            diagnostics: read.diagnostics,
            sources: read.sources,
        };
        return Err(scene_error(&error, &text.keys));
    };
    let mut changes = Vec::new();
    for (property, object) in document.root.properties.iter().zip(root.objects()) {
        let Value::Object(node) = &property.value else {
            continue;
        };
        let values = node.properties.iter();
        changes.extend(values.map(|value| Change {
            path: object.path_of(&value.name),
            value: value.value.clone(),
            contents: None,
        }));
    }
    Ok(changes)
}
