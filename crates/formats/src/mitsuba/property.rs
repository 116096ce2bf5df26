//! Properties: `<float>`, `<rgb>`, `<spectrum>`, `<transform>` and their like.
//!
//! After a mistake in a value, the property gets a harmless one of the same type, so that no
//! plugin complains a second time that it is missing.

use super::animation_key;
use super::attribute::{Attributes, tag_span};
use super::draft::{DraftProperty, DraftValue, ObjectId};
use super::operation::operations;
use super::reader::{File, Reader};
use super::tags::Tag;
use super::value::{no_children, value};
use etalon_params::{DMat4, DVec3, Span, SpectrumText, Value};
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
        let animation = animation_key::read(reader, file, node, &attributes);
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
