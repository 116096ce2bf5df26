//! What stands before `WorldBegin`: the camera, the film and how to render.

use super::kinds::{self, Kinds};
use super::placement::Active;
use super::reader::Reader;
use super::scene::{Camera, Entity};
use super::state::Inherited;
use super::statement::Statement;
use etalon_params::{Diagnostic, Span};
use std::sync::Arc;

/// The settings so far.
#[derive(Debug, Default)]
pub(crate) struct Settings {
    pub(crate) camera: Option<Camera>,
    pub(crate) film: Option<Entity>,
    pub(crate) sampler: Option<Entity>,
    pub(crate) filter: Option<Entity>,
    pub(crate) integrator: Option<Entity>,
    pub(crate) accelerator: Option<Entity>,
    /// Whether it was said what `TransformBegin` means.
    pub(crate) said_transform_begin: bool,
}

/// The CTM is the transform from the world to the camera; its inverse is named `camera`.
pub(crate) fn camera(reader: &mut Reader<'_>, statement: Statement) {
    let word = statement.word;
    let Some(entity) = entity(reader, &kinds::CAMERA, statement) else {
        return;
    };
    let placement = reader.state.ctm.clone();
    match placement.inverse() {
        Some(inverse) => {
            let systems = &mut reader.coordinate_systems.placements;
            systems.insert("camera".to_owned(), Arc::new(inverse));
        }
        None => {
            let message = "the transform of the camera flattens space";
            reader.report(Diagnostic::error(word, message));
        }
    }
    let before = reader.settings.camera.replace(Camera {
        entity,
        placement,
        medium: reader.state.outside,
    });
    note_replaced(reader, "Camera", word, before.map(|camera| camera.entity));
}

pub(crate) fn film(reader: &mut Reader<'_>, statement: Statement) {
    set(reader, "Film", &kinds::FILM, statement, |s| &mut s.film);
}

pub(crate) fn sampler(reader: &mut Reader<'_>, statement: Statement) {
    set(reader, "Sampler", &kinds::SAMPLER, statement, |s| {
        &mut s.sampler
    });
}

pub(crate) fn filter(reader: &mut Reader<'_>, statement: Statement) {
    set(reader, "PixelFilter", &kinds::FILTER, statement, |s| {
        &mut s.filter
    });
}

pub(crate) fn integrator(reader: &mut Reader<'_>, statement: Statement) {
    set(reader, "Integrator", &kinds::INTEGRATOR, statement, |s| {
        &mut s.integrator
    });
}

pub(crate) fn accelerator(reader: &mut Reader<'_>, statement: Statement) {
    set(reader, "Accelerator", &kinds::ACCELERATOR, statement, |s| {
        &mut s.accelerator
    });
}

/// The transforms begin anew; everything else in the graphics state stays.
pub(crate) fn world_begin(reader: &mut Reader<'_>, statement: Statement) {
    reader.world = Some(statement.word);
    let ctm = Arc::make_mut(&mut reader.state.ctm);
    ctm.change(Active::All, |_| etalon_params::DMat4::IDENTITY);
    reader.state.active = Active::All;
    let systems = &mut reader.coordinate_systems.placements;
    systems.insert("world".to_owned(), reader.state.ctm.clone());
}

fn set(
    reader: &mut Reader<'_>,
    word: &str,
    kinds: &Kinds,
    statement: Statement,
    setting: impl Fn(&mut Settings) -> &mut Option<Entity>,
) {
    let place = statement.word;
    let Some(entity) = entity(reader, kinds, statement) else {
        return;
    };
    let before = setting(&mut reader.settings).replace(entity);
    note_replaced(reader, word, place, before);
}

fn entity(reader: &mut Reader<'_>, kinds: &Kinds, statement: Statement) -> Option<Entity> {
    let kind = reader.kind(kinds, &statement.name(0))?;
    Some(reader.entity(kind, statement, &Inherited::default()))
}

/// As in pbrt the last one counts, which is worth saying.
fn note_replaced(reader: &mut Reader<'_>, word: &str, place: Span, before: Option<Entity>) {
    if let Some(before) = before {
        let message = format!("`{word}` is given again; this one counts");
        let note = Diagnostic::note(place, message);
        reader.report(note.related(before.span, "this one does not count"));
    }
}
