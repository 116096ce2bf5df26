//! A run: what is asked of a program, where its scenes and pictures are, and what was found so far.

use crate::driver::Driver;
use crate::job::Job;
use crate::judge::{Finding, Rules, Verdict, judge};
use crate::mitsuba_xml;
use crate::page::Run;
use crate::plan::Plan;
use crate::pose::Freedom;
use crate::question::Question;
use crate::replicate::{self, Replicate};
use crate::report::{Report, Row};
use crate::runner::{Outcome, Place, Runner};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// A run in its folder.
pub struct Suite {
    /// The folder, an absolute path.
    pub folder: PathBuf,
    /// What it is.
    pub plan: Plan,
    questions: Vec<&'static Question>,
    /// What is known of questions without pictures.
    refusals: BTreeMap<String, Verdict>,
}

/// Poses of a question where seeds differ.
const POSES: u32 = 2;

impl Suite {
    /// Begins a run in a folder, or goes on with the same run there; writes its scenes.
    ///
    /// # Errors
    /// If the folder holds another run, or cannot be written.
    pub fn create(folder: &Path, plan: Plan) -> Result<Self, String> {
        let folder = std::path::absolute(folder).map_err(|e| at(folder, &e))?;
        let file = folder.join("plan.json");
        if file.exists() {
            let before = Plan::read(&file)?;
            if before != plan {
                return Err(format!(
                    "{} holds another run ({} {}, tier {}, {} questions): give another folder",
                    folder.display(),
                    before.title,
                    before.program_version,
                    before.tier.name(),
                    before.questions.len()
                ));
            }
        }
        let suite = Self::of(folder, plan)?;
        suite.write()?;
        Ok(suite)
    }

    /// The run in a folder.
    ///
    /// # Errors
    /// If there is none, or it is of another version of this program.
    pub fn open(folder: &Path) -> Result<Self, String> {
        let folder = std::path::absolute(folder).map_err(|e| at(folder, &e))?;
        let plan = Plan::read(&folder.join("plan.json"))?;
        Self::of(folder, plan)
    }

    fn of(folder: PathBuf, plan: Plan) -> Result<Self, String> {
        let question = |name: &String| {
            crate::questions::by_name(name).ok_or_else(|| format!("there is no question `{name}`"))
        };
        let questions: Vec<&'static Question> = (plan.questions.iter())
            .map(question)
            .collect::<Result<_, _>>()?;
        let [part, of] = plan.part.map(|number| number as usize);
        if !(1..=of).contains(&part) {
            return Err(format!("there is no part {part} of {of}"));
        }
        Ok(Self {
            questions: questions.into_iter().skip(part - 1).step_by(of).collect(),
            refusals: read_refusals(&folder.join(REFUSALS)),
            folder,
            plan,
        })
    }

    /// Writes the plan and the scenes of all poses, as JSON and as XML.
    fn write(&self) -> Result<(), String> {
        let scenes = self.folder.join("scenes");
        for folder in [&scenes, &self.folder.join("pictures")] {
            fs::create_dir_all(folder).map_err(|e| at(folder, &e))?;
        }
        for question in &self.questions {
            for pose in 0..self.poses(question) {
                let (scene, _) = question.posed(self.plan.suite_seed, pose);
                let name = format!("{}-pose{pose}", question.name);
                let mut files = vec![(format!("{name}.json"), scene.to_json())];
                if let Ok(xml) = mitsuba_xml::write(&scene, &name, self.plan.mode) {
                    files.push((format!("{name}.xml"), xml.text));
                    files.extend(xml.files);
                }
                for (file, text) in files {
                    let path = scenes.join(file);
                    fs::write(&path, text).map_err(|e| at(&path, &e))?;
                }
            }
        }
        let plan = serde_json::to_string_pretty(&self.plan).expect("names and numbers");
        let file = self.folder.join("plan.json");
        fs::write(&file, plan).map_err(|e| at(&file, &e))
    }

    /// How many poses there are of a question.
    fn poses(&self, question: &Question) -> u32 {
        match self.plan.pose_each || question.freedom == Freedom::EachAnew {
            true => self.plan.tier.most(),
            false => POSES,
        }
    }

    /// The pictures of a question up to a look.
    pub fn jobs(&self, question: &Question, count: u32) -> Vec<Job> {
        (0..count)
            .map(|index| Job {
                question: question.name.to_owned(),
                pose: index % self.poses(question),
                samples: question.samples,
                seed: index + 1,
                picture: self.plan.picture,
            })
            .collect()
    }

    /// All pictures of the first look, for whoever renders them elsewhere.
    pub fn first_look(&self) -> Vec<Job> {
        let count = self.plan.tier.looks().first().copied().unwrap_or(0);
        (self.questions.iter())
            .flat_map(|question| self.jobs(question, count))
            .collect()
    }

    /// Renders what is missing, look by look, and judges it; `begin` is called before each with its number and that of its pictures. What fails is told of its question.
    pub fn run(
        &mut self,
        driver: &Driver,
        runner: &Runner<'_>,
        begin: impl Fn(usize, usize),
    ) -> Report {
        self.refusals.clear();
        let mut open = self.questions.clone();
        for (look, count) in self.plan.tier.looks().iter().enumerate() {
            let jobs: Vec<Job> = open
                .iter()
                .flat_map(|question| self.jobs(question, *count))
                .filter(|job| !job.picture(&self.folder).is_file())
                .collect();
            begin(look, jobs.len());
            let place = Place {
                folder: &self.folder,
                mode: self.plan.mode,
            };
            for (job, outcome) in runner.run(driver, &jobs, place) {
                let verdict = match outcome {
                    Outcome::Rendered => continue,
                    Outcome::Unsupported(why) => Verdict::NotSupported(why),
                    Outcome::Broken(how) => Verdict::Broken(format!("seed {}: {how}", job.seed)),
                };
                self.refusals.entry(job.question).or_insert(verdict);
            }
            open.retain(|question| matches!(self.finding(question).verdict, Verdict::Undecided(_)));
        }
        let refusals = serde_json::to_string_pretty(&self.refusals).expect("words");
        // Without this file the questions are undecided when they are judged again.
        let _ = fs::write(self.folder.join(REFUSALS), refusals);
        self.judge()
    }

    /// What the pictures of the folder say, whoever rendered them.
    pub fn judge(&self) -> Report {
        let rows = self.questions.iter().map(|question| Row {
            question: question.name.to_owned(),
            finding: self.finding(question),
        });
        Report {
            version: crate::report::VERSION,
            plan: self.plan.clone(),
            bound: self.rules().bound,
            rows: rows.collect(),
        }
    }

    fn rules(&self) -> Rules {
        Rules {
            darkness: self.plan.samples_lights,
            ..Rules::new(
                self.plan.questions.len(),
                self.plan.tier.looks().len() as u32,
            )
        }
    }

    /// What the pictures of a question say.
    fn finding(&self, question: &Question) -> Finding {
        if let Some(verdict) = self.refusals.get(question.name) {
            return Finding::of(verdict.clone());
        }
        let (_, truth) = (question.ask)();
        match self.replicates(question, truth.pixels) {
            Ok(replicates) => judge(&truth, &replicates, &self.rules()),
            Err(error) => Finding::of(Verdict::Broken(error)),
        }
    }

    /// The pictures of a question that there are.
    fn replicates(&self, question: &Question, pixels: u32) -> Result<Vec<Replicate>, String> {
        let mut replicates = Vec::new();
        for job in self.jobs(question, self.plan.tier.most()) {
            let path = job.picture(&self.folder);
            if path.is_file() {
                let replicate = Replicate::read(&path, pixels, job.pose, job.seed)
                    .map_err(|error| format!("seed {}: {error}", job.seed))?;
                replicates.push(replicate);
            }
        }
        Ok(replicates)
    }

    /// A report of this run with the means of the folder's pictures, for [`crate::page::page`]. Questions without pictures, or
    /// with one that cannot be read, are shown without.
    pub fn run_for_page<'a>(&self, report: &'a Report) -> Run<'a> {
        let mean = |question: &&'static Question| {
            let (_, truth) = (question.ask)();
            let replicates = self.replicates(question, truth.pixels).ok()?;
            let mean = replicate::mean(&replicates, truth.pixels)?;
            Some((question.name.to_owned(), mean))
        };
        Run {
            report,
            means: self.questions.iter().filter_map(mean).collect(),
        }
    }
}

fn at(path: &Path, error: &dyn std::fmt::Display) -> String {
    format!("{}: {error}", path.display())
}

/// The file with what is known of questions without pictures.
const REFUSALS: &str = "refusals.json";

/// Those of an earlier run, if there was one.
fn read_refusals(file: &Path) -> BTreeMap<String, Verdict> {
    let text = fs::read_to_string(file).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or_default()
}
