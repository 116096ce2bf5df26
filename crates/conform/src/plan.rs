//! What a run is, before anything is rendered: what is asked, and which pictures answer it.

use crate::driver::{Driver, PictureFormat};
use crate::job::Job;
use crate::mode::Mode;
use crate::pose::Freedom;
use crate::question::Question;
use crate::refinement;
use crate::tier::Tier;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// δ, unless a strict one is asked for.
pub const BOUND: f64 = 0.005;

/// δ where a strict one is asked for.
pub const STRICT_BOUND: f64 = 0.001;

/// Poses of a question where seeds differ.
const POSES: u32 = 2;

/// What a run is; it stands in `plan.json` of its folder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// The version of this file.
    pub version: u32,
    /// The seed of all poses.
    pub suite_seed: u64,
    /// How much is rendered.
    pub tier: Tier,
    /// δ: the relative difference of means within which the program agrees.
    pub bound: f64,
    /// What the program leaves out.
    pub mode: Mode,
    /// The driver's name.
    pub program: String,
    /// The program's name in full.
    pub title: String,
    /// What the program says its version is.
    pub program_version: String,
    /// Whether every picture has a pose of its own.
    pub pose_each: bool,
    /// Whether the program looks for lights.
    pub samples_lights: bool,
    /// The format of pictures.
    pub picture: PictureFormat,
    /// The names of the questions.
    pub questions: Vec<String>,
    /// What they are: [`crate::questions::fingerprint`].
    pub fingerprint: String,
    /// What the driver says of units and the like.
    pub conventions: BTreeMap<String, serde_json::Value>,
    /// Part I of N of the questions is rendered, every Nth from the Ith on; the error rates are those of all. The plan in a folder
    /// is always that of all.
    pub part: [u32; 2],
}

impl Plan {
    /// The version of the file.
    pub const VERSION: u32 = 2;

    /// The name of a program without a driver, which renders elsewhere.
    pub const ELSEWHERE: &'static str = "elsewhere";

    /// The questions of a tier whose names fit, to a program that takes seeds and is not known yet.
    pub fn new(suite_seed: u64, tier: Tier, mode: Mode, fits: impl Fn(&str) -> bool) -> Self {
        let asked = || {
            (crate::questions::ALL.iter())
                .filter(|question| tier.asks(question) && fits(question.name))
        };
        Self {
            version: Self::VERSION,
            suite_seed,
            tier,
            bound: BOUND,
            mode,
            program: Self::ELSEWHERE.to_owned(),
            title: "another program".to_owned(),
            program_version: String::new(),
            pose_each: false,
            samples_lights: true,
            picture: PictureFormat::Exr,
            questions: asked().map(|question| question.name.to_owned()).collect(),
            fingerprint: crate::questions::fingerprint(asked()),
            conventions: BTreeMap::new(),
            part: [1, 1],
        }
    }

    /// The same for a driver's program, of the version that it says.
    #[must_use]
    pub fn of(self, driver: &Driver, program_version: String) -> Self {
        Self {
            program: driver.description.name.clone(),
            title: driver.description.title.clone(),
            conventions: driver.description.conventions.clone(),
            program_version,
            pose_each: !driver.description.seed,
            samples_lights: driver.description.samples_lights,
            picture: driver.description.picture,
            ..self
        }
    }

    /// Reads one from a file.
    ///
    /// # Errors
    /// One sentence.
    pub(crate) fn read(file: &Path) -> Result<Self, String> {
        let at = |error: &dyn std::fmt::Display| format!("{}: {error}", file.display());
        let text = std::fs::read_to_string(file).map_err(|error| at(&error))?;
        let plan: Self = serde_json::from_str(&text).map_err(|error| at(&error))?;
        match plan.version {
            Self::VERSION => Ok(plan),
            other => Err(at(&format!(
                "version {other} of the plan, and this program knows {}",
                Self::VERSION
            ))),
        }
    }

    /// A picture of a question.
    pub fn job(&self, question: &Question, index: u32) -> Job {
        // Programs without random numbers have a pose for each picture.
        let poses = match self.pose_each || question.freedom == Freedom::EachAnew {
            true => self.tier.most(),
            false => POSES,
        };
        Job {
            question: question.name.to_owned(),
            pose: index % poses,
            samples: question.samples,
            seed: question.seed(index),
            again: false,
            picture: self.picture,
        }
    }

    /// The pictures of a question up to a look.
    pub fn jobs(&self, question: &Question, count: u32) -> Vec<Job> {
        (0..count).map(|index| self.job(question, index)).collect()
    }

    /// The pictures of a question with more samples, of seeds that no other has.
    pub fn finer_jobs(&self, question: &Question) -> Vec<Job> {
        let seed = |job: Job| Job {
            samples: refinement::FACTOR * job.samples,
            seed: job.seed + self.tier.most(),
            ..job
        };
        let jobs = self.jobs(question, refinement::PICTURES);
        jobs.into_iter().map(seed).collect()
    }

    /// The first picture of a question once more.
    pub fn again(&self, question: &Question) -> Job {
        Job {
            again: true,
            ..self.job(question, 0)
        }
    }
}
