//! Properties: `<float>`, `<rgb>`, `<spectrum>`, `<transform>` and their like.
//!
//! After a mistake in a value, the property gets a harmless one of the same type, so that no
//! plugin complains a second time that it is missing.

use super::attribute::{Attributes, tag_span};
use super::draft::{DraftProperty, DraftValue, ObjectId};
use super::number;
use super::reader::{File, Reader};
use super::tags::{OPERATIONS, Tag};
use super::{animation, colour, transform, upgrade};
use etalon_params::{DMat4, DVec3, Diagnostic, Span, SpectrumText, Value};
use etalon_spectrum::spd::check_unit;
use roxmltree::Node;

/// Reads a property and adds it to the object `parent`.
pub(crate) fn property(
    reader: &mut Reader<'_>,
    file: &File,
    parent: ObjectId,
    tag: Tag,
    node: Node<'_, '_>,
) {
    let Some(attributes) = Attributes::read(reader, file.id, node, tag.attributes()) else {
        if let Some(property) = stand_in(file, tag, node) {
            reader.stand_ins.push(property.span);
            reader.draft.objects[parent].properties.push(property);
        }
        return;
    };
    let name = attributes.required("name");
    if name.text.trim().is_empty() {
        let tag_name = node.tag_name().name();
        reader.report(name.error_whole(format!("`<{tag_name}>` needs a name")));
        return;
    }
    let mistakes = reader.mistakes();
    let (value, span) = if tag == Tag::Transform {
        let matrix = operations(reader, file, node).unwrap_or(DMat4::IDENTITY);
        (
            DraftValue::Plain(Value::Transform(matrix)),
            attributes.tag_span,
        )
    } else if tag == Tag::Animation {
        let animation = animation::read(reader, file, node, &attributes);
        let value = animation.map_or(
            DraftValue::Plain(Value::Transform(DMat4::IDENTITY)),
            DraftValue::Animation,
        );
        (value, attributes.tag_span)
    } else {
        no_children(reader, file, node);
        let (value, span) = value(reader, file, tag, node, &attributes);
        (DraftValue::Plain(value), span)
    };
    if reader.mistakes() > mistakes {
        reader.stand_ins.push(span);
    }
    reader.draft.objects[parent].properties.push(DraftProperty {
        name: name.text.clone().into_owned(),
        name_span: name.span,
        value,
        span,
        excused: false,
    });
}

/// The value in a tag's attributes, with its place.
pub(crate) fn value(
    reader: &mut Reader<'_>,
    file: &File,
    tag: Tag,
    node: Node<'_, '_>,
    attributes: &Attributes<'_>,
) -> (Value, Span) {
    let span = attributes
        .get("value")
        .or_else(|| attributes.get("filename"))
        .or_else(|| attributes.get("temperature"))
        .map_or(attributes.tag_span, |a| a.span);
    let value = match tag {
        Tag::Float => Value::Float(attributes.float(reader, "value").unwrap_or(1.0)),
        Tag::Integer => Value::Integer(attributes.integer(reader, "value").unwrap_or(1)),
        Tag::Boolean => {
            let attribute = attributes.required("value");
            let value = number::boolean(&attribute.text);
            if value.is_none() {
                reader.report(
                    attribute
                        .error_whole(format!(
                            "`{}` is not a boolean",
                            number::excerpt(&attribute.text)
                        ))
                        .help("accepted: true, false"),
                );
            }
            Value::Boolean(value.unwrap_or(false))
        }
        Tag::Vector => {
            let name = node.tag_name().name();
            if attributes.get("value").is_none()
                && let Some(axis) = ["x", "y", "z"]
                    .into_iter()
                    .find(|axis| !node.has_attribute(*axis))
            {
                reader.report(
                    Diagnostic::error(
                        attributes.tag_span,
                        format!("`<{name}>` needs the attribute `{axis}`"),
                    )
                    .help("accepted: value=\"x, y, z\", or x, y and z"),
                );
            }
            let vector = attributes.vector(reader, name, 0.0);
            let (vector, span) = vector.unwrap_or((DVec3::Z, span));
            return (Value::Vector(vector), span);
        }
        Tag::Rgb => {
            Value::Rgb(colour::rgb(reader, attributes, file.version).unwrap_or(DVec3::splat(0.5)))
        }
        Tag::Srgb => Value::Rgb(colour::srgb(reader, attributes).unwrap_or(DVec3::splat(0.5))),
        Tag::Blackbody => Value::Spectrum(
            colour::blackbody(reader, attributes).unwrap_or(SpectrumText::Uniform(0.5)),
        ),
        Tag::Spectrum => {
            let old = colour::spectrum_without_wavelengths(reader, attributes, file.version);
            old.unwrap_or_else(|| {
                let spectrum = spectrum(reader, file, attributes);
                Value::Spectrum(spectrum.unwrap_or(SpectrumText::Uniform(0.5)))
            })
        }
        _ => Value::String(attributes.required("value").text.clone().into_owned()),
    };
    (value, span)
}

/// A property in place of one whose attributes are broken, if at least its name is sound.
fn stand_in(file: &File, tag: Tag, node: Node<'_, '_>) -> Option<DraftProperty> {
    let name = node.attribute_node("name")?;
    let value = match tag {
        Tag::Float => Value::Float(1.0),
        Tag::Integer => Value::Integer(1),
        Tag::Boolean => Value::Boolean(false),
        Tag::Vector => Value::Vector(DVec3::Z),
        Tag::Rgb | Tag::Srgb => Value::Rgb(DVec3::splat(0.5)),
        Tag::Spectrum | Tag::Blackbody => Value::Spectrum(SpectrumText::Uniform(0.5)),
        Tag::Transform | Tag::Animation => Value::Transform(DMat4::IDENTITY),
        _ => Value::String(String::new()),
    };
    let place = |attribute: roxmltree::Attribute<'_, '_>| {
        let range = attribute.range_value();
        Span {
            file: file.id,
            start: range.start as u32,
            end: range.end as u32,
        }
    };
    let written = ["value", "filename"]
        .into_iter()
        .find_map(|attribute| node.attribute_node(attribute));
    let is_sound = !name.value().trim().is_empty() && !name.value().contains('$');
    is_sound.then(|| DraftProperty {
        name: name.value().to_owned(),
        name_span: place(name),
        value: DraftValue::Plain(value),
        span: written.map_or_else(|| tag_span(file.id, node), place),
        excused: false,
    })
}

/// Elements that only have attributes.
pub(crate) fn no_children(reader: &mut Reader<'_>, file: &File, node: Node<'_, '_>) {
    for child in node.children().filter(Node::is_element) {
        reader.report(Diagnostic::error(
            tag_span(file.id, child),
            format!(
                "`<{}>` cannot stand in `<{}>`",
                child.tag_name().name(),
                node.tag_name().name()
            ),
        ));
    }
}

fn spectrum(
    reader: &mut Reader<'_>,
    file: &File,
    attributes: &Attributes<'_>,
) -> Option<SpectrumText> {
    let given = |name| attributes.get(name).filter(|a| !a.text.trim().is_empty());
    match (given("value"), given("filename")) {
        (Some(_), None) => spectrum_text(reader, attributes),
        (None, Some(_)) => super::spectrum_file::read(reader, file, attributes),
        (both, _) => {
            let found = if both.is_some() { "both" } else { "neither" };
            reader.report(
                Diagnostic::error(
                    attributes.tag_span,
                    format!("`<spectrum>` needs `value` or `filename`, found {found}"),
                )
                .help("a spectrum plugin is written `<spectrum type=\"…\">`"),
            );
            None
        }
    }
}

/// One number, or pairs `wavelength:value` in ascending order.
fn spectrum_text(reader: &mut Reader<'_>, attributes: &Attributes<'_>) -> Option<SpectrumText> {
    let attribute = attributes.required("value");
    if !attribute.text.contains(':') && number::tokens(&attribute.text).count() == 1 {
        return attributes
            .list(reader, "value", &[1])
            .map(|numbers| SpectrumText::Uniform(numbers[0]));
    }
    let mut samples: Vec<(f64, f64)> = Vec::new();
    for (range, token) in number::tokens(&attribute.text) {
        let pair = token
            .split_once(':')
            .map(|(wavelength, value)| (number::float(wavelength), number::float(value)));
        let Some((Ok(wavelength), Ok(value))) = pair else {
            reader.report(
                attribute
                    .error(
                        range,
                        format!(
                            "`{}` is not a pair `wavelength:value`",
                            number::excerpt(token)
                        ),
                    )
                    .help("a spectrum is one number, or pairs such as `400:0.1, 700:0.8` (nm)"),
            );
            return None;
        };
        if let Some((previous, _)) = samples.last()
            && wavelength <= *previous
        {
            reader.report(attribute.error(
                range,
                format!("wavelengths must ascend, but {wavelength} nm follows {previous} nm"),
            ));
            return None;
        }
        samples.push((wavelength, value));
    }
    if samples.len() < 2 {
        reader.report(
            attribute
                .error_whole("a spectrum of pairs needs at least two")
                .help("a constant spectrum is one number without a wavelength"),
        );
        return None;
    }
    let wavelengths: Vec<f64> = samples.iter().map(|(wavelength, _)| *wavelength).collect();
    if let Err(message) = check_unit(&wavelengths) {
        reader.report(attribute.error_whole(message));
        return None;
    }
    Some(SpectrumText::Samples(samples))
}

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
    if upgrade::is_old(file.version) {
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
