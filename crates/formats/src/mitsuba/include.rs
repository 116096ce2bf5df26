//! XML files: the scene's own and those it includes.
//!
//! The root of an included file is a `<scene>`, whose children take the place of the
//! `<include>`, or a single object. Relative names in it are looked for beside it first.

use super::attribute::{Attributes, tag_span};
use super::draft::{DraftProperty, ObjectId};
use super::number::excerpt;
use super::object::object;
use super::reader::{File, MOST_FILES, Reader};
use super::tags::Tag;
use super::{decoded, markup, syntax, version};
use crate::SearchPath;
use crate::document::SourceFile;
use etalon_params::{Class, Diagnostic, FileId, Span};
use roxmltree::{Document, Node, ParsingOptions};
use std::path::Path;
use std::sync::Arc;

/// How deep files may include files, as in Mitsuba.
const MOST_NESTED_FILES: usize = 15;

/// The largest XML file that is read.
const MOST_BYTES: u64 = 1 << 30;

/// The most nodes of one XML file.
const MOST_NODES: u32 = 50_000_000;

/// A file's root object, and the path along which its references are looked for.
pub(crate) struct Root {
    pub(crate) object: ObjectId,
    pub(crate) search: SearchPath,
    property: DraftProperty,
}

/// Reads an `<include>`.
pub(crate) fn include(
    reader: &mut Reader<'_>,
    file: &File,
    parent: ObjectId,
    node: Node<'_, '_>,
    level: usize,
) {
    super::value::no_children(reader, file, node);
    let accepted = Tag::Include.attributes();
    let Some(attributes) = Attributes::read(reader, file.id, node, accepted) else {
        return;
    };
    let filename = attributes.required("filename");
    let name = excerpt(&filename.text);
    let Some(path) = file.search.find(&filename.text) else {
        reader.report(
            filename
                .error_whole(format!("the included file `{name}` was not found"))
                .help(file.search.why_not(&filename.text)),
        );
        return;
    };
    let real = path.canonicalize().unwrap_or_else(|_| path.clone());
    let mistake = if let Some(first) = reader.chain.iter().position(|(p, _)| *p == real) {
        let mut names: Vec<String> = reader.chain[first..]
            .iter()
            .map(|(path, _)| file_name(path))
            .collect();
        names.push(file_name(&real));
        Some(format!("files include each other: {}", names.join(" → ")))
    } else if reader.chain.len() > MOST_NESTED_FILES {
        Some(format!(
            "files are included more than {MOST_NESTED_FILES} levels deep"
        ))
    } else if reader.files.len() >= MOST_FILES {
        Some(format!("the scene includes more than {MOST_FILES} files"))
    } else {
        None
    };
    if let Some(mistake) = mistake {
        let chain = reader.chain.iter().filter_map(|(_, span)| *span);
        let diagnostic = chain.fold(filename.error_whole(mistake), |diagnostic, span| {
            diagnostic.related(span, "included from here")
        });
        reader.report(diagnostic);
        return;
    }
    reader.chain.push((real, Some(filename.span)));
    let root = read(reader, &path, &file.search, Some(filename.span), level);
    reader.chain.pop();
    let Some(root) = root else {
        return;
    };
    if let Some(folder) = path.parent() {
        reader.included_folders.push(folder.to_owned());
    }
    if reader.draft.objects[root.object].class == Class::Scene {
        let properties = std::mem::take(&mut reader.draft.objects[root.object].properties);
        reader.draft.objects[parent].properties.extend(properties);
    } else {
        let mut property = root.property;
        if let Some(name) = attributes.get("name").filter(|n| !n.text.is_empty()) {
            property.name = name.text.clone().into_owned();
            property.name_span = name.span;
        }
        reader.draft.objects[parent].properties.push(property);
    }
}

fn file_name(path: &Path) -> String {
    path.file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy()
        .into_owned()
}

/// Reads an XML file, named by the scene at `place` unless it is the scene itself.
pub(crate) fn read(
    reader: &mut Reader<'_>,
    path: &Path,
    search: &SearchPath,
    place: Option<Span>,
    level: usize,
) -> Option<Root> {
    let name = path.to_string_lossy();
    let bytes = match crate::read_bounded(path, MOST_BYTES) {
        Ok(bytes) => bytes,
        Err(reason) => {
            let message = format!("cannot read `{name}`: {reason}");
            reader.report(match place {
                Some(span) => Diagnostic::error(span, message),
                None => Diagnostic::error_nowhere(message),
            });
            return None;
        }
    };
    parse(reader, path, bytes, search, place, level)
}

/// The same from the contents of a file.
pub(crate) fn parse(
    reader: &mut Reader<'_>,
    path: &Path,
    bytes: Vec<u8>,
    search: &SearchPath,
    place: Option<Span>,
    level: usize,
) -> Option<Root> {
    let name = path.to_string_lossy();
    let decoded = decoded::decode(&bytes);
    let text: Arc<str> = decoded.text.into();
    let id = reader.sources.add(name, text.clone());
    reader.files.push(SourceFile {
        path: path.to_owned(),
        bytes: Arc::new(bytes),
    });
    if let Some(offset) = decoded.broken_at {
        let span = Span {
            file: id,
            start: offset as u32,
            end: offset as u32,
        };
        reader.report(
            Diagnostic::error(span, "the file is not UTF-8 text from here on")
                .help("a scene is an XML file"),
        );
        return None;
    }
    let options = ParsingOptions {
        nodes_limit: MOST_NODES,
        ..ParsingOptions::default()
    };
    let tolerated = match markup::tolerated(&text, id) {
        Ok(tolerated) => tolerated,
        Err(diagnostic) => {
            reader.report(diagnostic);
            return None;
        }
    };
    let document = match Document::parse_with_options(&tolerated, options) {
        Ok(document) => document,
        Err(error) => {
            reader.report(syntax::diagnose(&error, id, &text));
            return None;
        }
    };
    let mut search = search.clone();
    search.prepend(path.parent().unwrap_or(Path::new("")).to_owned());
    root(
        reader,
        id,
        document.root_element(),
        search,
        level,
        place.is_some(),
    )
}

fn root(
    reader: &mut Reader<'_>,
    id: FileId,
    node: Node<'_, '_>,
    search: SearchPath,
    level: usize,
    is_included: bool,
) -> Option<Root> {
    let name = node.tag_name().name();
    let class = match Tag::of(name) {
        Some(Tag::Object(class)) if is_included || class == Class::Scene => class,
        _ => {
            let diagnostic = Diagnostic::error(
                tag_span(id, node),
                format!("the outermost element must be `<scene>`, not `<{name}>`"),
            );
            reader.report(diagnostic.help("a scene begins with `<scene version=\"3.0.0\">`"));
            return None;
        }
    };
    let version = version(reader, id, node);
    if version::is_old(version) {
        reader.old_files.push(id);
    }
    let mut file = File {
        id,
        version,
        search,
    };
    let (object, property) = object(reader, &mut file, class, node, level, true)?;
    Some(Root {
        object,
        search: file.search,
        property,
    })
}

/// The version of a file. The first ones wrote none, and named things as no later one does.
fn version(reader: &mut Reader<'_>, file: FileId, node: Node<'_, '_>) -> version::Version {
    const CURRENT: version::Version = [3, 0, 0];
    const FIRST: version::Version = [0, 2, 0];
    let Some(attribute) = node.attribute_node("version") else {
        let is_first = node
            .children()
            .any(|child| matches!(child.tag_name().name(), "camera" | "luminaire"));
        let (version, words) = match is_first {
            true => (FIRST, "0.2"),
            false => (CURRENT, "3.0"),
        };
        reader.report(
            Diagnostic::note(
                tag_span(file, node),
                format!("without a version, this is read as a file of version {words}"),
            )
            .help("write `<scene version=\"…\">`"),
        );
        return version;
    };
    version::version(attribute.value()).unwrap_or_else(|| {
        let range = attribute.range_value();
        let span = Span {
            file,
            start: range.start as u32,
            end: range.end as u32,
        };
        reader.report(
            Diagnostic::error(
                span,
                format!("`{}` is not a version", excerpt(attribute.value())),
            )
            .help("a version is up to three numbers, such as 3.0.0"),
        );
        CURRENT
    })
}
