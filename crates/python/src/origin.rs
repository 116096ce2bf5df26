//! Where a scene comes from, to be compiled again with other options or values.

use crate::dict::{Keys, SceneDict};
use crate::listing::{Change, Contents, Listing, changed, file_name, split};
use etalon_formats::{FileAssets, ReadOutcome, mitsuba};
use etalon_params::{Diagnostic, Node, Value};
use etalon_render::pipeline::{self, LoadError, LoadOptions, Loaded};
use etalon_render::scene_hash;
use etalon_transport::Assets;
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
        let paths: HashSet<&str> = changes.iter().map(|change| change.path.as_str()).collect();
        let old = self.changes.iter();
        let old = old.filter(|change| !paths.contains(change.path.as_str()));
        let mut changes: Vec<Change> = old.chain(&changes).cloned().collect();
        // The same changes are the same scene, however they came about.
        changes.sort_by(|a, b| a.path.cmp(&b.path));
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
        let kept = self.kept(options, before);
        let (read, assets) = self.open(options, kept);
        let changed = self.changed(read.clone())?;
        let mut loaded = pipeline::compile(changed, &assets, self.path(), options, start)?;
        if self.changes.is_empty() {
            return Ok(loaded);
        }
        // The names of arrays are their hashes.
        let changes = self.changes.iter();
        let changes: Vec<_> = changes
            .map(|change| (&change.path, &change.value))
            .collect();
        let changes = format!("{changes:?}");
        loaded.hash = match kept {
            Some(kept) if options.framing == before.framing => {
                scene_hash::changed(&kept.hash, &changes)
            }
            Some(kept) => {
                scene_hash::changed(&kept.hash, &format!("{changes} {}", options.framing))
            }
            None => {
                if options.reading() == before.reading()
                    && let Ok(mut files) = assets.contents()
                {
                    self.arrays().for_each(|(name, _)| drop(files.remove(name)));
                    let hash = loaded.hash.clone();
                    let _ = self.kept.set(Kept { read, files, hash });
                }
                scene_hash::changed(&loaded.hash, &changes)
            }
        };
        Ok(loaded)
    }

    /// The files of the scene as it is.
    pub(crate) fn files(&self, options: &LoadOptions) -> FileAssets {
        self.open(options, self.kept(options, options)).1
    }

    /// What was kept, if it would be read the same with these options.
    fn kept(&self, options: &LoadOptions, before: &LoadOptions) -> Option<&Kept> {
        let is_same = options.reading() == before.reading();
        self.kept.get().filter(|_| is_same)
    }

    /// The scene without changes, and its files with the arrays that are in place of some.
    fn open(&self, options: &LoadOptions, kept: Option<&Kept>) -> (ReadOutcome, FileAssets) {
        let read = kept.map_or_else(|| self.read(options), |kept| kept.read.clone());
        let mut assets = pipeline::assets(&read);
        match (kept, &read.document) {
            (Some(kept), _) => assets = assets.holding(kept.files.clone()),
            (None, Some(document)) => self.count_replaced(&document.root, &assets),
            (None, None) => {}
        }
        for (name, contents) in self.arrays() {
            let name = name.to_owned();
            assets = match contents {
                Contents::Bytes(bytes) => assets.holding([(name, Arc::clone(bytes))]),
                Contents::Mesh(mesh) => assets.holding_meshes([(name, Arc::clone(mesh))]),
            };
        }
        (read, assets)
    }

    /// Has the files count as used that arrays are in place of: they are the scene's all the same, and may be asked for when they are gone.
    fn count_replaced(&self, root: &Arc<Node>, assets: &FileAssets) {
        if self.arrays().next().is_none() {
            return;
        }
        let listing = Listing::of(root);
        for change in self
            .changes
            .iter()
            .filter(|change| change.contents.is_some())
        {
            let object = split(&change.path).and_then(|(path, _)| listing.object(path));
            if let Some(name) = object.and_then(|node| file_name(node)) {
                // One that is not there is told of where it is needed.
                let _ = assets.open(name);
            }
        }
    }

    /// What is in place of files, by their names.
    fn arrays(&self) -> impl Iterator<Item = (&str, &Contents)> {
        self.changes
            .iter()
            .filter_map(|change| match &change.value {
                Value::String(name) => Some((name.as_str(), change.contents.as_ref()?)),
                _ => None,
            })
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
