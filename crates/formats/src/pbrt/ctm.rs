//! Directives that change the current transformation matrices.

use super::number::excerpt;
use super::placement::{self, Active};
use super::reader::Reader;
use super::statement::Statement;
use etalon_params::{DMat4, DVec3, Diagnostic, Span};
use std::sync::Arc;

pub(crate) fn identity(reader: &mut Reader<'_>, statement: Statement) {
    change(reader, statement.span, |_| DMat4::IDENTITY);
}

/// The numbers of a matrix are its columns, one after the other.
pub(crate) fn transform(reader: &mut Reader<'_>, statement: Statement) {
    let matrix = DMat4::from_cols_array(&statement.numbers());
    change(reader, statement.span, |_| matrix);
}

pub(crate) fn concat_transform(reader: &mut Reader<'_>, statement: Statement) {
    let matrix = DMat4::from_cols_array(&statement.numbers());
    change(reader, statement.span, |ctm| ctm * matrix);
}

pub(crate) fn translate(reader: &mut Reader<'_>, statement: Statement) {
    let matrix = DMat4::from_translation(statement.numbers().into());
    change(reader, statement.span, |ctm| ctm * matrix);
}

pub(crate) fn scale(reader: &mut Reader<'_>, statement: Statement) {
    let matrix = DMat4::from_scale(statement.numbers().into());
    change(reader, statement.span, |ctm| ctm * matrix);
}

pub(crate) fn rotate(reader: &mut Reader<'_>, statement: Statement) {
    let [degrees, x, y, z] = statement.numbers();
    match placement::rotate(degrees, DVec3::new(x, y, z)) {
        Some(matrix) => change(reader, statement.span, |ctm| ctm * matrix),
        None => {
            let message = "the axis of a rotation cannot be zero";
            reader.report(Diagnostic::error(statement.span, message));
        }
    }
}

pub(crate) fn look_at(reader: &mut Reader<'_>, statement: Statement) {
    let [ex, ey, ez, tx, ty, tz, ux, uy, uz] = statement.numbers();
    let (eye, target) = (DVec3::new(ex, ey, ez), DVec3::new(tx, ty, tz));
    match placement::look_at(eye, target, DVec3::new(ux, uy, uz)) {
        Some(matrix) => change(reader, statement.span, |ctm| ctm * matrix),
        None => {
            let message = match eye == target {
                true => "`LookAt` looks at the point that it stands at",
                false => "the up vector of `LookAt` is zero or parallel to the direction of view",
            };
            reader.report(Diagnostic::error(statement.span, message));
        }
    }
}

pub(crate) fn active_transform(reader: &mut Reader<'_>, statement: Statement) {
    reader.state.active = match statement.name(0).value.as_str() {
        "StartTime" => Active::StartTime,
        "EndTime" => Active::EndTime,
        _ => Active::All,
    };
}

pub(crate) fn transform_times(reader: &mut Reader<'_>, statement: Statement) {
    let times: [f64; 2] = statement.numbers();
    if times[0] < times[1] {
        Arc::make_mut(&mut reader.state.ctm).times = times;
    } else {
        let message = "the second of the `TransformTimes` must be later than the first";
        reader.report(Diagnostic::error(statement.span, message));
    }
}

/// Names both matrices.
pub(crate) fn coordinate_system(reader: &mut Reader<'_>, statement: Statement) {
    let name = statement.name(0).value;
    let systems = &mut reader.coordinate_systems;
    let before = systems
        .placements
        .insert(name.clone(), reader.state.ctm.clone());
    if reader.files.is_importing() {
        systems.replaced.push((name, before));
    }
}

/// Takes both matrices, whichever are active.
pub(crate) fn coord_sys_transform(reader: &mut Reader<'_>, statement: Statement) {
    let name = statement.name(0);
    if let Some(placement) = reader.coordinate_systems.placements.get(&name.value) {
        reader.state.ctm = placement.clone();
        return;
    }
    let known = reader
        .coordinate_systems
        .placements
        .keys()
        .map(String::as_str);
    let message = format!("there is no coordinate system `{}`", excerpt(&name.value));
    let mistake = Diagnostic::error(name.span, message);
    reader.report(super::definitions::suggested(mistake, &name.value, known));
}

/// Changes the active matrices, unless that overflows.
fn change(reader: &mut Reader<'_>, span: Span, change: impl Fn(DMat4) -> DMat4) {
    let active = reader.state.active;
    let mut changed = *reader.state.ctm;
    changed.change(active, change);
    if changed.is_finite() {
        reader.state.ctm = Arc::new(changed);
    } else {
        reader.report(Diagnostic::error(span, "the transform overflows"));
    }
}
