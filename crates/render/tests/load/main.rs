//! What loading a scene refuses, and what it remarks upon.

mod bad_files;
mod bad_scenes;
mod frames;
mod objections;

use etalon_render::pipeline::{LoadOptions, load};
use std::path::Path;
use std::time::{Duration, Instant};

/// What loading a scene came to.
pub(crate) struct Said {
    /// Whether it cannot be rendered.
    pub(crate) refused: bool,
    /// All messages, a line each.
    pub(crate) text: String,
}

impl Said {
    /// Loads a scene file, which takes less than a second whatever is wrong with it.
    pub(crate) fn of_file(path: &Path) -> Self {
        let timed = || {
            let start = Instant::now();
            let loaded = load(path, &LoadOptions::default());
            (start.elapsed() < Duration::from_secs(1), loaded)
        };
        // The quickest of some: other work on the machine is no fault of ours.
        let quick = (0..5).map(|_| timed()).find(|(quick, _)| *quick);
        let (refused, messages, sources) = match quick.expect("it is quick").1 {
            Ok(loaded) => (false, loaded.notes, loaded.sources),
            Err(refusal) => (true, refusal.diagnostics, refusal.sources),
        };
        let lines = messages.iter().map(|d| d.one_line(&sources) + "\n");
        Self {
            refused,
            text: lines.collect(),
        }
    }

    /// Loads a scene `a.xml` with further files beside it.
    pub(crate) fn of(scene: &str, files: &[(&str, &[u8])]) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let write = |name: &str, bytes: &[u8]| {
            std::fs::write(folder.path().join(name), bytes).expect("written");
        };
        write("a.xml", scene.as_bytes());
        files.iter().for_each(|(name, bytes)| write(name, bytes));
        Self::of_file(&folder.path().join("a.xml"))
    }

    /// The lines of errors.
    pub(crate) fn errors(&self) -> Vec<&str> {
        let lines = self.text.lines();
        lines.filter(|line| line.contains(": error: ")).collect()
    }
}
