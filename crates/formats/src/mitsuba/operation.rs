//! The operations in a `<transform>`.

use super::attribute::{Attributes, tag_span};
use super::reader::{File, Reader};
use super::tags::OPERATIONS;
use super::value::no_children;
use super::version::is_old;
use super::{number, transform};
use etalon_params::{DMat4, DVec3, Diagnostic};
use roxmltree::Node;

/// The product of the operations in a `<transform>`.
pub(crate) fn operations(
    reader: &mut Reader<'_>,
    file: &File,
    node: Node<'_, '_>,
) -> Option<DMat4> {
    let mut product = Some(DMat4::IDENTITY);
    for child in node.children().filter(Node::is_element) {
        no_children(reader, file, child);
        let operation = operation(reader, file, child);
        product = product.zip(operation).map(|(before, m)| m * before);
    }
    if let Some(matrix) = product
        && !matrix.as_mat4().is_finite()
    {
        let span = tag_span(file.id, node);
        reader.report(Diagnostic::error(span, "the transform overflows"));
        return None;
    }
    product
}

fn operation(reader: &mut Reader<'_>, file: &File, node: Node<'_, '_>) -> Option<DMat4> {
    let written = node.tag_name().name();
    // Mitsuba 0.x wrote `lookAt`, and scenes that were carried over still do.
    let known = |(name, _): &&(&str, _)| name.eq_ignore_ascii_case(written);
    let Some(&(name, accepted)) = OPERATIONS.iter().find(known) else {
        reader.report(
            Diagnostic::error(
                tag_span(file.id, node),
                format!("`<{written}>` is not an operation of a transform"),
            )
            .suggest(written, OPERATIONS.iter().map(|(known, _)| *known)),
        );
        return None;
    };
    let attributes = Attributes::read(reader, file.id, node, accepted)?;
    match name {
        "translate" => attributes
            .vector(reader, name, 0.0)
            .map(|(offset, _)| DMat4::from_translation(offset)),
        "scale" => attributes
            .vector(reader, name, 1.0)
            .map(|(factors, _)| DMat4::from_scale(factors)),
        "rotate" => rotation(reader, file, &attributes),
        "lookat" => look_at(reader, &attributes),
        _ => matrix(reader, &attributes),
    }
}

/// The matrix of 16 numbers, whose last row must be a multiple of 0 0 0 1, or of 9.
///
/// Points are homogeneous: M and M/w map them alike.
fn matrix(reader: &mut Reader<'_>, attributes: &Attributes<'_>) -> Option<DMat4> {
    /// How far the last row may be off by its rounding in the file.
    const ROUNDING: f64 = 1e-5;
    let mut numbers = attributes.list(reader, "value", &[9, 16])?;
    if let Some(&[x, y, z, w]) = numbers.get(12..) {
        let is_affine = [x, y, z].iter().all(|a| a.abs() <= ROUNDING * w.abs());
        if w == 0.0 || !is_affine {
            let value = attributes.required("value");
            let written: Vec<String> = numbers[12..].iter().map(f64::to_string).collect();
            let tokens = number::tokens(&value.text).map(|(range, _)| range);
            let place = tokens.skip(12).reduce(|all, next| all.start..next.end);
            let message = format!(
                "the last row of the matrix is `{}`: this is no affine map, but one with a perspective",
                written.join(" ")
            );
            let place = place.unwrap_or(0..value.text.len());
            reader.report(
                value
                    .error(place, message)
                    .help("the last row must be `0 0 0 1` or a multiple of it; matrices are written row by row"),
            );
            return None;
        }
        if (w - 1.0).abs() > ROUNDING {
            numbers.iter_mut().for_each(|number| *number /= w);
        }
        numbers[12..].copy_from_slice(&[0.0, 0.0, 0.0, 1.0]);
    }
    transform::matrix(&numbers)
}

fn rotation(reader: &mut Reader<'_>, file: &File, attributes: &Attributes<'_>) -> Option<DMat4> {
    let angle = attributes.float(reader, "angle");
    let (mut axis, span) = attributes.vector(reader, "rotate", 0.0)?;
    if axis == DVec3::ZERO {
        reader.report(Diagnostic::error(
            span,
            "the axis of a rotation cannot be zero",
        ));
        return None;
    }
    if is_old(file.version) {
        // Mitsuba 0.x divided by the length.
        axis = axis.normalize();
    }
    if !transform::is_unit(axis) {
        reader.report(
            Diagnostic::note(
                span,
                format!(
                    "the axis has length {:.4}; as in Mitsuba 3, this shears",
                    axis.length()
                ),
            )
            .help("a rotation needs an axis of length 1"),
        );
    }
    angle.map(|angle| transform::rotate(axis, angle))
}

fn look_at(reader: &mut Reader<'_>, attributes: &Attributes<'_>) -> Option<DMat4> {
    let mut point = |name: &str| {
        attributes
            .list(reader, name, &[3])
            .map(|numbers| DVec3::from_slice(&numbers))
    };
    let (origin, target) = (point("origin"), point("target"));
    let up = match attributes.get("up") {
        Some(up) if !up.text.trim().is_empty() => Some(point("up")?),
        _ => None,
    };
    let (origin, target) = origin.zip(target)?;
    let matrix = transform::look_at(origin, target, up);
    if matrix.is_none() {
        let (culprit, message) = match attributes.get("up") {
            Some(up) if origin != target => (up, "`up` is parallel to the direction of view"),
            _ => (
                attributes.required("target"),
                "`target` and `origin` are the same point",
            ),
        };
        reader.report(culprit.error_whole(message));
    }
    matrix
}
