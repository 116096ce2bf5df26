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
mod number;
mod object;
mod operation;
mod property;
mod reader;
mod references;
mod spectrum_file;
mod substitute;
mod syntax;
mod tags;
mod transform;
mod upgrade;
mod value;
mod version;

use crate::SearchPath;
use etalon_params::{Diagnostic, Node, Severity, Sources, Span};
use reader::Reader;
use std::path::{Path, PathBuf};
use std::sync::Arc;
pub use upgrade::underscored;

/// What may be said about a scene from outside of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// Values of `$name` parameters (`-D name=value`); they beat the scene's `<default>`s.
    pub defines: Vec<(String, String)>,
    /// A type for the innermost integrator in place of its own (`--integrator NAME`).
    pub integrator: Option<String>,
    /// The moment that the picture's shutter counts from (units of scene time).
    pub time: f64,
    /// Further folders to look for files in, after the scene's own.
    pub search: Vec<PathBuf>,
}

/// A file that the scene description was read from.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceFile {
    /// Where it was found.
    pub path: PathBuf,
    /// Its contents.
    pub bytes: Arc<Vec<u8>>,
}

/// A scene as it was described.
#[derive(Clone, Debug)]
pub struct Document {
    /// The `<scene>` node. An object that is referred to from several places is one `Arc`.
    pub root: Arc<Node>,
    /// Where the files that the scene refers to are looked for.
    pub search: SearchPath,
    /// The XML and spectrum files that the description consists of, in the order of reading.
    pub files: Vec<SourceFile>,
    /// The `<default>`s in the order of the file, with the values that count: those of the command line beat them.
    pub parameters: Vec<(String, String)>,
}

/// What came of reading a scene.
#[derive(Clone, Debug)]
pub struct ReadOutcome {
    /// The texts that all positions refer to.
    pub sources: Sources,
    /// Mistakes and notes, in the order of the files; last those that have no place.
    pub diagnostics: Vec<Diagnostic>,
    /// The scene. After mistakes it may still be there, with harmless values in place of the
    /// broken ones, so that further mistakes can be looked for in it; it must not be rendered.
    pub document: Option<Document>,
    /// The positions of such harmless values, and of plugins whose children are missing: further
    /// mistakes there are not reported (see [`etalon_params::Diagnostics::silent_about`]).
    pub stand_ins: Vec<Span>,
}

impl ReadOutcome {
    /// Whether there was any mistake.
    pub fn has_errors(&self) -> bool {
        self.diagnostics
            .iter()
            .any(|d| d.severity == Severity::Error)
    }

    /// The scene if there was no mistake.
    pub fn sound(&self) -> Option<&Document> {
        self.document.as_ref().filter(|_| !self.has_errors())
    }

    /// The diagnostics, each on a line of its own.
    pub fn lines(&self) -> String {
        let lines: Vec<String> = self
            .diagnostics
            .iter()
            .map(|d| d.one_line(&self.sources))
            .collect();
        lines.join("\n")
    }
}

/// Reads the scene file at `path`.
pub fn read(path: &Path, options: &ReadOptions) -> ReadOutcome {
    let mut reader = Reader::new(options);
    let document = document(&mut reader, path);
    let mut diagnostics = reader.diagnostics;
    diagnostics.sort_by_key(|d| (d.span.is_none(), d.span.map(|s| (s.file, s.start))));
    ReadOutcome {
        sources: reader.sources,
        diagnostics,
        document,
        stand_ins: reader.stand_ins,
    }
}

fn document(reader: &mut Reader<'_>, path: &Path) -> Option<Document> {
    let real = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    reader.chain.push((real, None));
    // As in Mitsuba, the current folder is searched after the scene's own.
    let search = SearchPath::new(
        std::iter::once(PathBuf::new()).chain(reader.options.search.iter().cloned()),
    );
    let root = include::read(reader, path, &search, None, 0)?;
    if reader.is_full() {
        return None;
    }
    references::resolve(reader);
    mitsuba06::invisible_surfaces(reader);
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
    })
}
