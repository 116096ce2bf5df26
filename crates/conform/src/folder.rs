//! The folder of a run: its plan, its scenes, its pictures, and what is known of questions without pictures.

use crate::job::Job;
use crate::judge::Verdict;
use crate::mode::Mode;
use crate::plan::Plan;
use crate::question::Question;
use crate::replicate::Replicate;
use crate::scene_format;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The file of the plan.
const PLAN: &str = "plan.json";

/// The file with what is known of questions without pictures.
const REFUSALS: &str = "refusals.json";

/// The folder of a run.
pub struct Folder(PathBuf);

impl Folder {
    /// The folder at a path.
    ///
    /// # Errors
    /// If there is no folder that the path could be relative to.
    pub(crate) fn at(path: &Path) -> Result<Self, String> {
        std::path::absolute(path)
            .map(Self)
            .map_err(|e| at(path, &e))
    }

    /// Its absolute path.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Makes the folder that of a plan, or finds that it is.
    ///
    /// # Errors
    /// If it is another plan's, or cannot be written.
    pub(crate) fn take(&self, plan: &Plan) -> Result<(), String> {
        let file = self.0.join(PLAN);
        // Parts of a run share a folder, which is judged as a whole.
        let whole = Plan {
            part: [1, 1],
            ..plan.clone()
        };
        if file.exists() {
            let before = self.plan()?;
            if before != whole {
                return Err(format!(
                    "{} holds another run ({} {}, tier {}, {} questions): give another folder",
                    self.0.display(),
                    before.title,
                    before.program_version,
                    before.tier.name(),
                    before.questions.len()
                ));
            }
        }
        for folder in ["scenes", "pictures"].map(|name| self.0.join(name)) {
            fs::create_dir_all(&folder).map_err(|e| at(&folder, &e))?;
        }
        let text = serde_json::to_string_pretty(&whole).expect("names and numbers");
        fs::write(&file, text).map_err(|e| at(&file, &e))
    }

    /// Its plan.
    ///
    /// # Errors
    /// If there is none, or it is of another version of this program.
    pub(crate) fn plan(&self) -> Result<Plan, String> {
        Plan::read(&self.0.join(PLAN))
    }

    /// Writes a question in a pose, as JSON and in the languages that can say it; not again if it is there.
    ///
    /// # Errors
    /// If the files cannot be written.
    pub(crate) fn write_scene(
        &self,
        question: &Question,
        pose: u32,
        suite_seed: u64,
        mode: Mode,
    ) -> Result<(), String> {
        let scenes = self.0.join("scenes");
        let name = Job::scene_of(question.name, pose);
        let json = scenes.join(format!("{name}.json"));
        if json.is_file() {
            return Ok(());
        }
        let (scene, _) = question.posed(suite_seed, pose);
        let mut files = Vec::new();
        for format in scene_format::ALL {
            files.extend((format.write)(&scene, &name, mode).unwrap_or_default());
        }
        let files = files
            .into_iter()
            .map(|(file, bytes)| (scenes.join(file), bytes));
        // The JSON last: where it is, all is.
        for (path, bytes) in files.chain([(json, scene.to_json().into_bytes())]) {
            fs::write(&path, bytes).map_err(|e| at(&path, &e))?;
        }
        Ok(())
    }

    /// The pictures of jobs that there are, of so many rows and columns.
    ///
    /// # Errors
    /// Which cannot be read, and why.
    pub(crate) fn replicates(&self, jobs: &[Job], pixels: u32) -> Result<Vec<Replicate>, String> {
        let mut replicates = Vec::new();
        for job in jobs {
            let path = job.picture(&self.0);
            if path.is_file() {
                let replicate = Replicate::read(&path, pixels, job.pose, job.seed)
                    .map_err(|error| format!("seed {}: {error}", job.seed))?;
                replicates.push(replicate);
            }
        }
        Ok(replicates)
    }

    /// What an earlier run knew of questions without pictures.
    pub(crate) fn refusals(&self) -> BTreeMap<String, Verdict> {
        let text = fs::read_to_string(self.0.join(REFUSALS)).unwrap_or_default();
        serde_json::from_str(&text).unwrap_or_default()
    }

    /// Keeps what is known of questions without pictures.
    pub(crate) fn keep_refusals(&self, refusals: &BTreeMap<String, Verdict>) {
        let text = serde_json::to_string_pretty(refusals).expect("words");
        // Without this file the questions are undecided when they are judged again.
        let _ = fs::write(self.0.join(REFUSALS), text);
    }
}

fn at(path: &Path, error: &dyn std::fmt::Display) -> String {
    format!("{}: {error}", path.display())
}
