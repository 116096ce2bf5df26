//! What reading knows: the parsed file, what was loaded of it, and how to say what is wrong.

use super::materials::{MaterialKey, Surface};
use super::places::Places;
use super::shapes::Loaded;
use crate::SearchPath;
use crate::document::SourceFile;
use ::gltf::json::Root;
use etalon_params::{Diagnostic, Diagnostics, FileId, Span};
use etalon_transport::MeshData;
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

/// The longest excerpt of a value in a message (bytes).
const LONGEST_EXCERPT: usize = 60;

/// A file whose parts are becoming nodes.
pub(crate) struct Reader<'a> {
    pub(crate) root: &'a Root,
    text: &'a str,
    places: &'a Places,
    file: FileId,
    pub(crate) diagnostics: &'a Diagnostics,
    pub(crate) search: SearchPath,
    /// The buffer within a `.glb`.
    pub(crate) binary: Option<Arc<Vec<u8>>>,
    /// What was loaded so far; an inner `None` is after a mistake.
    /// How many bytes were read as numbers.
    pub(crate) decoded: u64,
    pub(crate) buffers: HashMap<usize, Option<Arc<Vec<u8>>>>,
    pub(crate) pictures: HashMap<usize, Option<String>>,
    pub(crate) materials: HashMap<MaterialKey, Option<Surface>>,
    pub(crate) primitives: HashMap<(usize, usize), Option<Loaded>>,
    /// What becomes part of the document.
    pub(crate) files: Vec<SourceFile>,
    pub(crate) meshes: Vec<Arc<MeshData>>,
    pub(crate) images: BTreeMap<usize, Arc<Vec<u8>>>,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(
        root: &'a Root,
        (text, places): (&'a str, &'a Places),
        file: FileId,
        diagnostics: &'a Diagnostics,
        search: SearchPath,
    ) -> Self {
        Self {
            root,
            text,
            places,
            file,
            diagnostics,
            search,
            binary: None,
            decoded: 0,
            buffers: HashMap::new(),
            pictures: HashMap::new(),
            materials: HashMap::new(),
            primitives: HashMap::new(),
            files: Vec::new(),
            meshes: Vec::new(),
            images: BTreeMap::new(),
        }
    }

    /// With the buffer of a `.glb`.
    pub(crate) fn with_binary(mut self, binary: Option<&[u8]>) -> Self {
        self.binary = binary.map(|bytes| Arc::new(bytes.to_vec()));
        self
    }

    /// The place of the value at a path.
    pub(crate) fn span(&self, path: &str) -> Span {
        let [start, end] = self.places.at(path);
        Span {
            file: self.file,
            start,
            end,
        }
    }

    /// A message about the value at a path, with what is written there if that is short.
    fn about(&self, path: &str, message: &str) -> String {
        let written = self.places.exactly_at(path).and_then(|[start, end]| {
            let value = self.text.get(start as usize..end as usize)?;
            (value.len() <= LONGEST_EXCERPT && !value.starts_with(['{', '['])).then_some(value)
        });
        match written {
            Some(value) => format!("`{path}` is `{value}`: {message}"),
            None => format!("`{path}`: {message}"),
        }
    }

    /// Says that something is wrong at a path.
    pub(crate) fn error(&self, path: &str, message: impl AsRef<str>) {
        let message = self.about(path, message.as_ref());
        self.diagnostics
            .push(Diagnostic::error(self.span(path), message));
    }

    /// The same with what would be accepted; `None` for the value that there is not.
    pub(crate) fn refuse<T>(
        &self,
        path: &str,
        message: impl AsRef<str>,
        help: impl Into<String>,
    ) -> Option<T> {
        let message = self.about(path, message.as_ref());
        let mistake = Diagnostic::error(self.span(path), message);
        self.diagnostics.push(mistake.help(help));
        None
    }

    /// Says what something became; notes of the same words are shown once.
    pub(crate) fn note(&self, path: &str, message: impl Into<String>) {
        self.diagnostics
            .push(Diagnostic::note(self.span(path), message));
    }
}
