//! Mitsuba 3 scene files.
//!
//! [`read`] turns an XML file, with everything it includes, into the description tree of
//! `etalon_params`. It knows the language (tags, attributes, transforms, `$parameters`,
//! references, versions before 2.0) and nothing of plugins: what a `<bsdf type="…">` may contain
//! is for the plugin to say. Every node, name and value keeps its place, and reading goes on
//! after a mistake, so that one run reports all of them.

mod animation;
mod animation_key;
mod attribute;
mod colour;
mod decoded;
mod draft;
mod include;
mod integrator;
mod markup;
mod mitsuba06;
mod multichannel;
mod number;
mod object;
mod operation;
mod property;
mod reader;
mod references;
mod spectrum_file;
mod substitute;
mod syntax;
pub mod tags;
pub mod transform;
mod upgrade;
mod value;
mod version;
mod write;

use crate::SearchPath;
use crate::document::{Document, ReadOptions, ReadOutcome, SourceFile, embedded_name};
use include::Root;
use reader::Reader;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
pub use upgrade::underscored;
pub use write::{WrittenScene, escaped, write};

/// The name of a scene that is in no file, for messages.
pub const TEXT: &str = "<string>";

/// Reads the scene file at `path`.
pub fn read(path: &Path, options: &ReadOptions) -> ReadOutcome {
    outcome(path, options, |reader, search| {
        include::read(reader, path, search, None, 0)
    })
}

/// Reads a scene from a text, which has the name [`TEXT`]. Its files are looked for in the current folder.
pub fn read_text(text: &str, options: &ReadOptions) -> ReadOutcome {
    let path = Path::new(TEXT);
    outcome(path, options, |reader, search| {
        include::parse(reader, path, text.into(), search, None, 0)
    })
}

/// A scene that is in no file, with the contents of files that are nowhere else.
#[derive(Clone, Debug, Default)]
pub struct SceneInMemory {
    /// What the text is called in messages.
    pub name: String,
    /// Mitsuba's XML.
    pub text: String,
    /// The files, for which the text has the [`embedded_name`]s of their indices; meshes are binary PLY.
    pub files: Vec<Arc<Vec<u8>>>,
}

/// As [`read_text`], with files in memory.
pub fn read_in_memory(scene: &SceneInMemory, options: &ReadOptions) -> ReadOutcome {
    let path = Path::new(&scene.name);
    let mut read = outcome(path, options, |reader, search| {
        include::parse(reader, path, scene.text.clone().into(), search, None, 0)
    });
    if let Some(document) = &mut read.document {
        document.embedded = scene.files.iter().cloned().enumerate().collect();
        // They are part of what tells one scene from another.
        let sources = scene.files.iter().enumerate();
        document
            .files
            .extend(sources.map(|(index, bytes)| SourceFile {
                path: embedded_name(index).into(),
                bytes: Arc::clone(bytes),
            }));
    }
    read
}

fn outcome(
    path: &Path,
    options: &ReadOptions,
    root: impl FnOnce(&mut Reader<'_>, &SearchPath) -> Option<Root>,
) -> ReadOutcome {
    let mut reader = Reader::new(options);
    let document = document(&mut reader, path, root);
    let mut diagnostics = reader.diagnostics;
    diagnostics.sort_by_key(|d| (d.span.is_none(), d.span.map(|s| (s.file, s.start))));
    ReadOutcome {
        sources: reader.sources,
        diagnostics,
        document,
        stand_ins: reader.stand_ins,
    }
}

fn document(
    reader: &mut Reader<'_>,
    path: &Path,
    root: impl FnOnce(&mut Reader<'_>, &SearchPath) -> Option<Root>,
) -> Option<Document> {
    let real = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    reader.chain.push((real, None));
    // As in Mitsuba, the current folder is searched after the scene's own.
    let search = SearchPath::new(
        std::iter::once(PathBuf::new()).chain(reader.options.search.iter().cloned()),
    );
    let root = root(reader, &search)?;
    if reader.is_full() {
        return None;
    }
    references::resolve(reader);
    mitsuba06::invisible_surfaces(reader);
    multichannel::upgrade(reader);
    if let Some(name) = &reader.options.integrator {
        integrator::replace(reader, root.object, name);
    }
    integrator::stand_in(reader);
    reader.report_unused_parameters();
    let order = references::order(reader, root.object)?;
    let mut search = root.search;
    for folder in std::mem::take(&mut reader.included_folders) {
        search.append(folder);
    }
    Some(Document {
        root: references::build(reader, &order)?,
        search,
        files: std::mem::take(&mut reader.files),
        parameters: reader.parameters.values(),
        meshes: Vec::new(),
        embedded: BTreeMap::new(),
    })
}
