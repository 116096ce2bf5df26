//! `--integrator NAME`: another integrator for a scene.
//!
//! The innermost integrator (inside of `aov` and `moment`) becomes one of the type `NAME`. Of its
//! properties only `max_depth`, `rr_depth` and `hide_emitters` are kept; an integrator that does
//! not know one of these leaves it unused without complaint. One that has the type already keeps
//! all. A scene without an integrator gets one.

use super::draft::{DraftObject, DraftProperty, DraftValue, ObjectId};
use super::reader::Reader;
use etalon_params::{Class, Span, Spanned};

/// The properties that survive the change.
const KEPT: [&str; 3] = ["max_depth", "rr_depth", "hide_emitters"];

/// Replaces the type of the innermost integrator of the scene `root`.
pub(crate) fn replace(reader: &mut Reader<'_>, root: ObjectId, name: &str) {
    let file = reader.sources.add("--integrator", name);
    let span = Span {
        file,
        start: 0,
        end: name.len() as u32,
    };
    let plugin = Spanned {
        value: name.to_owned(),
        span,
    };
    let innermost = innermost(reader, root);
    for &id in &innermost {
        let object = &mut reader.draft.objects[id];
        if object.plugin.value == name {
            continue;
        }
        object.plugin = plugin.clone();
        object.properties.retain_mut(|property| {
            property.excused = true;
            KEPT.contains(&property.name.as_str())
        });
    }
    if innermost.is_empty() {
        let id = reader.draft.objects.len();
        reader.draft.objects.push(DraftObject {
            class: Class::Integrator,
            plugin,
            id: None,
            span,
            properties: Vec::new(),
        });
        reader.draft.objects[root].properties.push(DraftProperty {
            name: String::new(),
            name_span: span,
            value: DraftValue::Object(id),
            span,
            excused: false,
        });
    }
}

/// The integrators under `root` that contain no other.
fn innermost(reader: &Reader<'_>, root: ObjectId) -> Vec<ObjectId> {
    let nested = |id: ObjectId| {
        let objects = &reader.draft.objects;
        objects[id]
            .properties
            .iter()
            .filter_map(|property| match property.value {
                DraftValue::Object(child) if objects[child].class == Class::Integrator => {
                    Some(child)
                }
                _ => None,
            })
            .collect::<Vec<_>>()
    };
    let mut found = Vec::new();
    let mut seen = Vec::new();
    let mut open = nested(root);
    while let Some(id) = open.pop() {
        if seen.contains(&id) {
            continue;
        }
        seen.push(id);
        let inner = nested(id);
        if inner.is_empty() {
            found.push(id);
        }
        open.extend(inner);
    }
    found
}
