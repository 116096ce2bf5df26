//! Where a scene comes from, to be compiled again with other options or values.

use crate::dict::{Keys, SceneDict};
use crate::listing::{Change, changed};
use etalon_formats::{ReadOutcome, mitsuba};
use etalon_params::Diagnostic;
use etalon_render::pipeline::{self, LoadError, LoadOptions, Loaded};
use etalon_render::scene_hash;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use std::time::Instant;

/// What a scene is read from.
pub(crate) enum Text {
    File(PathBuf),
    Xml(String),
    Dict(SceneDict),
}

/// A scene as it was read, with the files that it refers to.
struct Kept {
    read: ReadOutcome,
    files: HashMap<String, Arc<Vec<u8>>>,
    /// The scene's hash without changes.
    hash: String,
}

/// What a scene is read from, and what is changed in it.
#[derive(Clone)]
pub(crate) struct Origin {
    text: Arc<Text>,
    changes: Vec<Change>,
    /// From the first change on.
    kept: Arc<OnceLock<Kept>>,
}

impl Origin {
    pub(crate) fn new(text: Text) -> Self {
        Self {
            text: Arc::new(text),
            changes: Vec::new(),
            kept: Arc::default(),
        }
    }

    /// The same with further changes.
    pub(crate) fn with(&self, changes: Vec<Change>) -> Self {
        let paths: HashSet<&str> = changes.iter().map(|(path, _)| path.as_str()).collect();
        let old = self.changes.iter();
        let old = old.filter(|(path, _)| !paths.contains(path.as_str()));
        let mut changes: Vec<Change> = old.chain(&changes).cloned().collect();
        // The same changes are the same scene, however they came about.
        changes.sort_by(|a, b| a.0.cmp(&b.0));
        Self {
            changes,
            ..self.clone()
        }
    }

    /// Reads and compiles. What was kept is not read again if it would be the same as with the options `before`.
    pub(crate) fn load(
        &self,
        options: &LoadOptions,
        before: &LoadOptions,
    ) -> Result<Loaded, LoadError> {
        let start = Instant::now();
        let is_same = options.reading() == before.reading();
        let kept = self.kept.get().filter(|_| is_same);
        let read = kept.map_or_else(|| self.read(options), |kept| kept.read.clone());
        let mut assets = pipeline::assets(&read);
        if let Some(kept) = kept {
            assets = assets.holding(kept.files.clone());
        }
        let changed = self.changed(read.clone())?;
        let mut loaded = pipeline::compile(changed, &assets, self.path(), options, start)?;
        if self.changes.is_empty() {
            return Ok(loaded);
        }
        let changes = format!("{:?}", self.changes);
        loaded.hash = match kept {
            Some(kept) if options.framing == before.framing => {
                scene_hash::changed(&kept.hash, &changes)
            }
            Some(kept) => {
                scene_hash::changed(&kept.hash, &format!("{changes} {}", options.framing))
            }
            None => {
                if is_same && let Ok(files) = assets.contents() {
                    let hash = loaded.hash.clone();
                    let _ = self.kept.set(Kept { read, files, hash });
                }
                scene_hash::changed(&loaded.hash, &changes)
            }
        };
        Ok(loaded)
    }

    fn read(&self, options: &LoadOptions) -> ReadOutcome {
        let options = options.reading();
        match &*self.text {
            Text::File(path) => etalon_formats::read(path, &options),
            Text::Xml(text) => mitsuba::read_text(text, &options),
            Text::Dict(dict) => mitsuba::read_in_memory(&dict.scene, &options),
        }
    }

    fn changed(&self, mut read: ReadOutcome) -> Result<ReadOutcome, LoadError> {
        let Some(document) = read.document.as_mut().filter(|_| !self.changes.is_empty()) else {
            return Ok(read);
        };
        match changed(&document.root, &self.changes) {
            Ok(root) => document.root = root,
            Err(lost) => {
                let message =
                    |path| format!("the scene has nothing at `{path}` with these options");
                let lost = lost.into_iter().map(message);
                return Err(LoadError {
                    diagnostics: lost.map(Diagnostic::error_nowhere).collect(),
                    sources: read.sources,
                });
            }
        }
        Ok(read)
    }

    fn path(&self) -> &Path {
        match &*self.text {
            Text::File(path) => path,
            Text::Xml(_) => Path::new(mitsuba::TEXT),
            Text::Dict(dict) => Path::new(&dict.scene.name),
        }
    }

    /// The keys for the lines of its text: none but for a dict.
    pub(crate) fn keys(&self) -> Keys {
        match &*self.text {
            Text::Dict(dict) => dict.keys.clone(),
            Text::File(_) | Text::Xml(_) => Keys::default(),
        }
    }
}
