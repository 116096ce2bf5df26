//! Objects and their children.

use super::attribute::{Attributes, tag_span};
use super::draft::{DraftObject, DraftProperty, DraftValue, ObjectId};
use super::number::excerpt;
use super::property::property;
use super::reader::{File, MOST_LEVELS, Reader};
use super::tags::{TAGS, Tag};
use super::value::no_children;
use super::version::is_old;
use super::{include, upgrade};
use etalon_params::{Class, Diagnostic, Span, Spanned};
use roxmltree::Node;
use std::collections::HashMap;

/// Reads an object with everything in it. `is_root` objects have a `version` and may lack a
/// `type`. `None` if its own attributes are broken; its children have been read nevertheless.
pub(crate) fn object(
    reader: &mut Reader<'_>,
    file: &mut File,
    class: Class,
    node: Node<'_, '_>,
    level: usize,
    is_root: bool,
) -> Option<(ObjectId, DraftProperty)> {
    let accepted: &[&str] = match (is_root, class) {
        (true, Class::Scene) => &["version", "type", "id", "name"],
        (true, _) => &["version", "!type", "id", "name"],
        _ => Tag::Object(class).attributes(),
    };
    let attributes = Attributes::read(reader, file.id, node, accepted);
    let tag = tag_span(file.id, node);
    let plugin = attributes.as_ref().and_then(|a| a.get("type"));
    let plugin = match plugin {
        Some(plugin) if plugin.text.trim().is_empty() => {
            reader.report(plugin.error_whole(format!("`<{}>` needs a type", class.name())));
            None
        }
        // All plugins are called in lower case; where names are those of files, `Rectangle` may
        // have been found all the same.
        Some(plugin) => Some(Spanned {
            value: plugin.text.trim().to_ascii_lowercase(),
            span: plugin.span,
        }),
        None => attributes.as_ref().map(|_| Spanned {
            value: "scene".to_owned(),
            span: tag,
        }),
    };
    let id = attributes.as_ref().and_then(|a| a.get("id"));
    let range = node.range();
    let this = reader.draft.objects.len();
    let sound = plugin.is_some();
    reader.draft.objects.push(DraftObject {
        class,
        plugin: plugin.unwrap_or(Spanned {
            value: String::new(),
            span: tag,
        }),
        id: id.map(|id| id.text.clone().into_owned()),
        span: Span {
            file: file.id,
            start: range.start as u32,
            end: range.end as u32,
        },
        properties: Vec::new(),
    });
    if let Some(id) = id {
        register(reader, &id.text, id.span, this);
    } else if let Some(id) = node.attribute_node("id") {
        // Broken attributes: references to the object are sound all the same.
        let range = id.range_value();
        let span = Span {
            file: file.id,
            start: range.start as u32,
            end: range.end as u32,
        };
        register(reader, id.value(), span, this);
    }
    children(reader, file, this, node, level, is_root);
    finish(reader, file, this);
    let name = attributes
        .as_ref()
        .and_then(|a| a.get("name"))
        .filter(|name| !name.text.is_empty());
    let property = DraftProperty {
        name: name.map_or_else(String::new, |n| n.text.clone().into_owned()),
        name_span: name.map_or(tag, |n| n.span),
        value: DraftValue::Object(this),
        span: reader.draft.objects[this].plugin.span,
        excused: false,
    };
    sound.then_some((this, property))
}

/// Registers the `id` of an object.
fn register(reader: &mut Reader<'_>, id: &str, span: Span, object: ObjectId) {
    if let Some(&(_, first)) = reader.draft.ids.get(id) {
        reader.report(
            Diagnostic::error(span, format!("the id `{}` is given twice", excerpt(id)))
                .related(first, "first given here"),
        );
        return;
    }
    reader.draft.ids.insert(id.to_owned(), (object, span));
}

/// Upgrades an object of an old file and reports names given twice.
fn finish(reader: &mut Reader<'_>, file: &File, object: ObjectId) {
    if is_old(file.version) {
        let object = &mut reader.draft.objects[object];
        if let Some(diagnostic) = upgrade::upgrade(object, file.version) {
            reader.report(diagnostic);
        }
    }
    let duplicates = duplicates(&reader.draft.objects[object].properties);
    for &(later, first) in duplicates.iter().rev() {
        let properties = &mut reader.draft.objects[object].properties;
        let before = properties[first].name_span;
        let property = properties.remove(later);
        reader.report(
            Diagnostic::error(
                property.name_span,
                format!("the property `{}` is given twice", excerpt(&property.name)),
            )
            .related(before, "first given here"),
        );
    }
}

/// The properties whose name was given before, each with the property that had it first.
fn duplicates(properties: &[DraftProperty]) -> Vec<(usize, usize)> {
    /// Up to this many, looking at each pair is quicker than a map.
    const FEW: usize = 12;
    let named = || {
        properties
            .iter()
            .enumerate()
            .filter(|(_, p)| !p.name.is_empty())
    };
    if properties.len() <= FEW {
        return named()
            .filter_map(|(later, property)| {
                let first = properties.iter().position(|p| p.name == property.name)?;
                (first < later).then_some((later, first))
            })
            .collect();
    }
    let mut firsts: HashMap<&str, usize> = HashMap::new();
    named()
        .filter_map(|(later, property)| {
            let first = *firsts.entry(&property.name).or_insert(later);
            (first < later).then_some((later, first))
        })
        .collect()
}

/// Reads the children of an object.
fn children(
    reader: &mut Reader<'_>,
    file: &mut File,
    parent: ObjectId,
    node: Node<'_, '_>,
    level: usize,
    is_root: bool,
) {
    if level >= MOST_LEVELS {
        reader.report(Diagnostic::error(
            tag_span(file.id, node),
            format!("objects are nested more than {MOST_LEVELS} levels deep"),
        ));
        return;
    }
    for child in node.children() {
        if reader.is_full() {
            return;
        }
        if child.is_element() {
            element(reader, file, parent, child, level, is_root);
        } else if let Some(text) = child.text().filter(|_| child.is_text())
            && let trimmed = text.trim()
            && !trimmed.is_empty()
        {
            let written = &child.document().input_text()[child.range()];
            let start = child.range().start + (written.len() - written.trim_start().len());
            let span = Span {
                file: file.id,
                start: start as u32,
                end: (child.range().start + written.trim_end().len()) as u32,
            };
            reader.report(
                Diagnostic::note(span, "text between elements means nothing and is skipped")
                    .help("values are written as attributes, comments as `<!-- … -->`"),
            );
        }
    }
}

/// Reads one child of an object.
fn element(
    reader: &mut Reader<'_>,
    file: &mut File,
    parent: ObjectId,
    node: Node<'_, '_>,
    level: usize,
    in_root: bool,
) {
    let name = upgrade::tag(file.version, node.tag_name().name());
    let tag = match Tag::of(name) {
        // A spectrum with a type is a plugin of the texture family.
        Some(Tag::Spectrum) if node.has_attribute("type") => Tag::Object(Class::Texture),
        Some(tag) => tag,
        None => {
            let span = tag_span(file.id, node);
            let unknown = Diagnostic::error(span, format!("unknown element `<{name}>`"));
            reader.report(unknown.suggest(name, TAGS.iter().map(|(known, _)| *known)));
            // Its children are read all the same: their ids may be referred to.
            let aside = reader.draft.objects.len();
            let span = tag_span(file.id, node);
            reader.draft.objects.push(DraftObject {
                class: Class::Scene,
                plugin: Spanned {
                    value: String::new(),
                    span,
                },
                id: None,
                span,
                properties: Vec::new(),
            });
            children(reader, file, aside, node, level + 1, false);
            return;
        }
    };
    match tag {
        Tag::Object(class) => {
            if let Some((_, property)) = object(reader, file, class, node, level + 1, false) {
                reader.draft.objects[parent].properties.push(property);
            }
        }
        Tag::Reference => reference(reader, file, parent, node),
        Tag::Alias => alias(reader, file, node),
        Tag::Include => include::include(reader, file, parent, node, level),
        Tag::Default => default(reader, file, node),
        Tag::Path => path(reader, file, node, in_root),
        Tag::Operation => reader.report(
            Diagnostic::error(
                tag_span(file.id, node),
                format!("`<{name}>` can only stand in a `<transform>`"),
            )
            .help("for instance `<transform name=\"to_world\">`"),
        ),
        _ => property(reader, file, parent, tag, node),
    }
}

fn reference(reader: &mut Reader<'_>, file: &File, parent: ObjectId, node: Node<'_, '_>) {
    no_children(reader, file, node);
    let accepted = Tag::Reference.attributes();
    let Some(attributes) = Attributes::read(reader, file.id, node, accepted) else {
        return;
    };
    let id = attributes.required("id");
    let name = attributes.get("name").filter(|name| !name.text.is_empty());
    let property = DraftProperty {
        name: name.map_or_else(String::new, |n| n.text.clone().into_owned()),
        name_span: name.map_or(attributes.tag_span, |n| n.span),
        value: DraftValue::Reference(id.text.clone().into_owned()),
        span: id.span,
        excused: false,
    };
    reader.draft.objects[parent].properties.push(property);
}

fn alias(reader: &mut Reader<'_>, file: &File, node: Node<'_, '_>) {
    no_children(reader, file, node);
    let accepted = Tag::Alias.attributes();
    let Some(attributes) = Attributes::read(reader, file.id, node, accepted) else {
        return;
    };
    let [source, name] = ["id", "as"].map(|attribute| {
        let attribute = attributes.required(attribute);
        Spanned {
            value: attribute.text.clone().into_owned(),
            span: attribute.span,
        }
    });
    reader.draft.aliases.push((name, source));
}

fn default(reader: &mut Reader<'_>, file: &File, node: Node<'_, '_>) {
    no_children(reader, file, node);
    let accepted = Tag::Default.attributes();
    let Some(attributes) = Attributes::read(reader, file.id, node, accepted) else {
        // References to the name are not reported as mistakes.
        if let Some(name) = node.attribute("name").filter(|name| !name.is_empty()) {
            let span = tag_span(file.id, node);
            reader.parameters.add_default(name, None, span);
        }
        return;
    };
    let (name, value) = (attributes.required("name"), attributes.required("value"));
    if name.text.is_empty() {
        reader.report(name.error_whole("`<default>` needs a name"));
        return;
    }
    reader
        .parameters
        .add_default(&name.text, Some(&value.text), value.span);
}

fn path(reader: &mut Reader<'_>, file: &mut File, node: Node<'_, '_>, in_root: bool) {
    no_children(reader, file, node);
    let accepted = Tag::Path.attributes();
    let Some(attributes) = Attributes::read(reader, file.id, node, accepted) else {
        return;
    };
    let value = attributes.required("value");
    if !in_root {
        reader.report(Diagnostic::error(
            attributes.tag_span,
            "`<path>` can only stand in the outermost element",
        ));
        return;
    }
    match file.search.find(&value.text).filter(|path| path.is_dir()) {
        Some(folder) => file.search.prepend(folder),
        None => reader.report(
            value
                .error_whole(format!(
                    "the folder `{}` was not found",
                    excerpt(&value.text)
                ))
                .help(file.search.why_not(&value.text)),
        ),
    }
}
