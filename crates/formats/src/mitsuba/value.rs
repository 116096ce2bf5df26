//! Values in the attributes of `<float>`, `<rgb>`, `<spectrum>` and their like.

use super::attribute::{Attributes, tag_span};
use super::reader::{File, Reader};
use super::tags::Tag;
use super::{colour, number, spectrum_file};
use etalon_params::{DVec3, Diagnostic, Span, SpectrumText, Value};
use etalon_spectrum::spd::check_unit;
use roxmltree::Node;

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
        (None, Some(_)) => spectrum_file::read(reader, file, attributes),
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
