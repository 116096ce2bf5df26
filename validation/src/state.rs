//! The batches of a full run so far, so that it can resume after an interruption.
//!
//! Every batch of replicates is kept as an EXR file with its tile means, in a folder that belongs
//! to one build of the program, one seed and one choice or part of claims. A batch is taken up again only if
//! its scene, plan, seed and estimator are those asked for. The verdicts are recomputed from the batches:
//! they, too, are the same as without the interruption.

use crate::program;
use crate::tasks::Options;
use etalon_film::{RenderedImage, read_developed};
use etalon_integrators::RenderPlan;
use etalon_render::pipeline::Loaded;
use std::hash::{DefaultHasher, Hasher};
use std::path::{Path, PathBuf};

/// A folder with finished batches.
pub struct State {
    folder: PathBuf,
}

impl State {
    /// The batches of this build, seed and choice of claims below `folder`, which is made if it is
    /// not there.
    ///
    /// # Errors
    /// If the program cannot be read or the folder cannot be made.
    pub fn open(folder: &Path, options: &Options) -> Result<Self, String> {
        let mut hasher = DefaultHasher::new();
        hasher.write(program::fingerprint()?.as_bytes());
        let part = options.part.map(|part| part.to_string());
        for choice in [&options.only, &part] {
            hasher.write(choice.as_deref().unwrap_or_default().as_bytes());
        }
        let folder = folder.join(format!("{:016x}-{}", hasher.finish(), options.seed));
        std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        Ok(Self { folder })
    }

    /// Where the batches are.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// How many batches there are.
    pub fn len(&self) -> usize {
        std::fs::read_dir(&self.folder).map_or(0, Iterator::count)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A batch, if it is there, whole, and the one that is asked for.
    pub fn read(&self, name: &str, plan: &RenderPlan, loaded: &Loaded) -> Option<RenderedImage> {
        let batch = read_developed(&self.path(name)).ok()?;
        let facts = batch.metadata.as_ref()?;
        let spp = u64::from(plan.replicates) * u64::from(plan.samples_per_replicate);
        let same = facts.scene_hash == loaded.hash
            && facts.seed == plan.seed
            && facts.replicates == plan.replicates
            && facts.replicate_kind == plan.replicate_kind
            && facts.spp == spp;
        same.then_some(batch)
    }

    /// Keeps a batch.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(&self, name: &str, batch: &RenderedImage) -> Result<(), String> {
        let path = self.path(name);
        batch.write_exr(&path).map_err(|e| e.to_string())
    }

    /// Forgets everything: the run has ended.
    ///
    /// # Errors
    /// If the folder cannot be removed.
    pub fn finish(self) -> Result<(), String> {
        std::fs::remove_dir_all(&self.folder).map_err(|e| format!("{}: {e}", self.folder.display()))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.exr"))
    }
}
