//! Mitsuba 0.6's `multichannel`: the pictures of several integrators in one file, as an `aov` of nested integrators.
//!
//! What its film calls them (`channelNames`) become the names of the integrators, with which those of an `aov`'s
//! channels begin.

use super::draft::{DraftProperty, DraftValue, ObjectId};
use super::integrator::nested;
use super::reader::Reader;
use etalon_params::{Class, Diagnostic, Value};

/// Replaces the `multichannel` of a scene.
pub(crate) fn upgrade(reader: &mut Reader<'_>) {
    for id in 0..reader.draft.objects.len() {
        let object = &reader.draft.objects[id];
        let is_old = reader.old_files.contains(&object.span.file);
        if is_old && object.class == Class::Integrator && object.plugin.value == "multichannel" {
            as_aov(reader, id);
        }
    }
}

fn as_aov(reader: &mut Reader<'_>, id: ObjectId) {
    let parts = nested(reader, id);
    let span = reader.draft.objects[id].plugin.span;
    if parts.is_empty() {
        let message = "`multichannel` needs integrators, whose pictures it puts into one file";
        reader.report(Diagnostic::error(span, message));
    }
    name_parts(reader, id, parts.len());
    let object = &mut reader.draft.objects[id];
    object.plugin.value = "aov".to_owned();
    object.properties.push(DraftProperty {
        name: "aovs".to_owned(),
        name_span: span,
        value: DraftValue::Plain(Value::String(String::new())),
        span,
        excused: false,
    });
    let message = "`multichannel` is read as an `aov`: the file has the channels R, G, B and A of each of its integrators, whatever `pixelFormat` says";
    reader.report(Diagnostic::note(span, message));
}

/// Gives the integrators of a `multichannel` the names that the scene's first film lists.
fn name_parts(reader: &mut Reader<'_>, id: ObjectId, count: usize) {
    let objects = &mut reader.draft.objects;
    let films = objects.iter_mut().filter(|o| o.class == Class::Film);
    let mut properties = films.flat_map(|film| &mut film.properties);
    let Some(list) = properties.find(|p| p.name == "channel_names") else {
        return;
    };
    let DraftValue::Plain(Value::String(text)) = &list.value else {
        return;
    };
    list.excused = true;
    let names: Vec<String> = text.split(',').map(|name| name.trim().to_owned()).collect();
    if names.len() != count {
        let message = format!(
            "`channelNames` has {} names for the {count} integrators of a `multichannel`",
            names.len()
        );
        let diagnostic = Diagnostic::error(list.span, message);
        reader.report(diagnostic);
        return;
    }
    let is_integrator: Vec<bool> = objects
        .iter()
        .map(|o| o.class == Class::Integrator)
        .collect();
    let parts = objects[id].properties.iter_mut();
    let parts =
        parts.filter(|p| matches!(p.value, DraftValue::Object(part) if is_integrator[part]));
    for (part, name) in parts.zip(names) {
        part.name = name;
    }
}
