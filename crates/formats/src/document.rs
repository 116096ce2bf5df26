//! A scene as it was described, whatever the language, and what came of reading it.

use crate::SearchPath;
use etalon_params::{Diagnostic, Node, Severity, Sources, Span};
use etalon_transport::MeshData;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

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
    /// A picture of the surroundings, which light a scene of glTF (`--environment FILE`); other scenes have their own.
    pub environment: Option<PathBuf>,
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
    /// The node of the scene. An object that is referred to from several places is one `Arc`.
    pub root: Arc<Node>,
    /// Where the files that the scene refers to are looked for.
    pub search: SearchPath,
    /// The files that the description consists of, in the order of reading; not meshes and pictures.
    pub files: Vec<SourceFile>,
    /// The parameters that the scene lets one choose (Mitsuba's `<default>`s), in the order of the file, with the values that count:
    /// those of the command line beat them.
    pub parameters: Vec<(String, String)>,
    /// Meshes that stand in the scene file itself: a `ply` has [`mesh_name`] for the name of its file.
    pub meshes: Vec<Arc<MeshData>>,
    /// Files that stand in the scene file itself (pictures, curves, grids), by number: they are asked for by [`embedded_name`].
    pub embedded: BTreeMap<usize, Arc<Vec<u8>>>,
}

/// The name of a mesh in [`Document::meshes`], for shapes and messages.
pub fn mesh_name(index: usize) -> String {
    format!("mesh {index} of the scene file")
}

/// The name of a file in [`Document::embedded`].
pub fn embedded_name(index: usize) -> String {
    format!("file {index} of the scene file")
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
