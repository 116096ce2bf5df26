//! A run: what is asked of a program, in which order, and what was found so far.

use crate::copies;
use crate::driver::Driver;
use crate::folder::Folder;
use crate::job::Job;
use crate::judge::{Finding, Verdict, judge};
use crate::page::Run;
use crate::plan::Plan;
use crate::question::Question;
use crate::refinement::Refinement;
use crate::replicate::{self, Replicate};
use crate::report::{Report, Row};
use crate::rules::{BRIGHTEST, Rules};
use crate::runner::{Outcome, Place, Runner};
use std::collections::BTreeMap;
use std::path::Path;

/// A run in its folder.
pub struct Suite {
    /// The folder.
    pub folder: Folder,
    /// What it is.
    pub plan: Plan,
    questions: Vec<&'static Question>,
    /// What is known of questions without pictures.
    refusals: BTreeMap<String, Verdict>,
}

impl Suite {
    /// Begins a run in a folder, or goes on with the same run there.
    ///
    /// # Errors
    /// If the folder holds another run, or cannot be written.
    pub fn create(folder: &Path, plan: Plan) -> Result<Self, String> {
        let folder = Folder::at(folder)?;
        folder.take(&plan)?;
        Self::of(folder, plan)
    }

    /// The run in a folder.
    ///
    /// # Errors
    /// If there is none, or it is of another version of this program.
    pub fn open(folder: &Path) -> Result<Self, String> {
        let folder = Folder::at(folder)?;
        let plan = folder.plan()?;
        Self::of(folder, plan)
    }

    fn of(folder: Folder, plan: Plan) -> Result<Self, String> {
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
            refusals: folder.refusals(),
            folder,
            plan,
        })
    }

    /// All pictures of the first look, for whoever renders them elsewhere; their scenes are written.
    ///
    /// # Errors
    /// If the folder cannot be written.
    pub fn first_look(&self) -> Result<Vec<Job>, String> {
        let count = self.plan.tier.looks().first().copied().unwrap_or(0);
        let mut jobs = Vec::new();
        for question in &self.questions {
            let of_question = self.plan.jobs(question, count);
            self.write_scenes(question, &of_question)?;
            jobs.extend(of_question);
        }
        Ok(jobs)
    }

    fn write_scenes(&self, question: &Question, jobs: &[Job]) -> Result<(), String> {
        let Plan {
            suite_seed, mode, ..
        } = self.plan;
        (jobs.iter()).try_for_each(|job| {
            self.folder
                .write_scene(question, job.pose, suite_seed, mode)
        })
    }

    /// Renders what is missing, step by step, and judges it; `begin` is called before each step with its name and the number of its
    /// pictures. What fails is told of its question.
    ///
    /// # Errors
    /// If the folder cannot be written.
    pub fn run(
        &mut self,
        driver: &Driver,
        runner: &Runner<'_>,
        begin: impl Fn(&str, usize),
    ) -> Result<Report, String> {
        let asked: Vec<&str> = self.questions.iter().map(|q| q.name).collect();
        self.refusals.retain(|name, _| !asked.contains(&&name[..]));
        let mut open = self.questions.clone();
        for (look, count) in self.plan.tier.looks().iter().enumerate() {
            let name = format!("look {}", look + 1);
            let ended =
                self.render(driver, runner, (&name, &begin), &open, |suite, question| {
                    suite.plan.jobs(question, *count)
                })?;
            for (job, outcome) in ended {
                let verdict = match outcome {
                    Outcome::Rendered => continue,
                    Outcome::Unsupported(why) => Verdict::NotSupported(why),
                    Outcome::Broken(how) => Verdict::Broken(format!("seed {}: {how}", job.seed)),
                };
                self.refusals.entry(job.question).or_insert(verdict);
            }
            open.retain(|question| matches!(self.finding(question).verdict, Verdict::Undecided(_)));
        }
        self.folder.keep_refusals(&self.refusals);
        let mut finer = self.questions.clone();
        finer.retain(|question| self.plan.tier.refines(&self.finding(question).verdict));
        // These two tell more and decide nothing: what fails is missing.
        self.render(
            driver,
            runner,
            ("more samples", &begin),
            &finer,
            |suite, question| suite.plan.finer_jobs(question),
        )?;
        let noisy: Vec<_> = self.cheapest_with_noise().into_iter().collect();
        self.render(
            driver,
            runner,
            ("a seed again", &begin),
            &noisy,
            |suite, question| vec![suite.plan.again(question)],
        )?;
        Ok(self.judge())
    }

    /// Has a program render pictures of a question with so many samples per pixel, and reads them; nothing is judged.
    ///
    /// # Errors
    /// If a picture could not be rendered or read.
    pub fn pictures(
        &self,
        driver: &Driver,
        runner: &Runner<'_>,
        question: &'static Question,
        samples: u32,
        count: u32,
    ) -> Result<Vec<Replicate>, String> {
        let jobs = |suite: &Self, question: &Question| {
            let mut jobs = suite.plan.jobs(question, count);
            jobs.iter_mut().for_each(|job| job.samples = samples);
            jobs
        };
        let silent = |_: &str, _: usize| {};
        for (_, outcome) in self.render(driver, runner, ("", &silent), &[question], jobs)? {
            match outcome {
                Outcome::Rendered => {}
                Outcome::Unsupported(why) => return Err(why),
                Outcome::Broken(how) => return Err(how),
            }
        }
        let (_, pictures) = self.replicates(question, jobs(self, question))?;
        Ok(pictures)
    }

    /// Renders what is missing of these questions; what became of it.
    fn render(
        &self,
        driver: &Driver,
        runner: &Runner<'_>,
        (name, begin): (&str, &impl Fn(&str, usize)),
        questions: &[&'static Question],
        jobs: impl Fn(&Self, &Question) -> Vec<Job>,
    ) -> Result<Vec<(Job, Outcome)>, String> {
        let mut missing = Vec::new();
        for question in questions {
            let mut of_question = jobs(self, question);
            of_question.retain(|job| !job.picture(self.folder.path()).is_file());
            self.write_scenes(question, &of_question)?;
            missing.extend(of_question);
        }
        begin(name, missing.len());
        let place = Place {
            folder: self.folder.path(),
            suite_seed: self.plan.suite_seed,
            mode: self.plan.mode,
        };
        Ok(runner.run(driver, &missing, place))
    }

    /// The question of the fewest samples whose pictures have noise, if seeds are to make any.
    fn cheapest_with_noise(&self) -> Option<&'static Question> {
        let noisy = |question: &&&'static Question| {
            let replicates = self.replicates(question, self.plan.jobs(question, 4));
            replicates.is_ok_and(|(_, pictures)| copies::are_noisy(&pictures))
        };
        let questions = self.questions.iter().filter(|_| !self.plan.pose_each);
        questions
            .filter(noisy)
            .min_by_key(|question| question.samples)
            .copied()
    }

    /// What the pictures of the folder say, whoever rendered them.
    pub fn judge(&self) -> Report {
        let rows = self.questions.iter().map(|question| Row {
            question: question.name.to_owned(),
            finding: self.finding(question),
        });
        Report {
            version: crate::report::VERSION,
            rows: rows.collect(),
            seed_repeats: self.seed_repeats(),
            plan: self.plan.clone(),
        }
    }

    /// Whether a seed gave the same picture twice, if one was rendered twice.
    fn seed_repeats(&self) -> Option<bool> {
        self.questions.iter().find_map(|question| {
            let twice = vec![self.plan.job(question, 0), self.plan.again(question)];
            let (_, pictures) = self.replicates(question, twice).ok()?;
            let [a, b] = &pictures[..] else { return None };
            Some(a.is_copy_of(b))
        })
    }

    fn rules(&self, question: &Question) -> Rules {
        let looks = self.plan.tier.looks().len() as u32;
        let (scene, truth) = (question.ask)();
        let found_by_chance = match self.plan.samples_lights {
            true => 0.0,
            false => scene.brightest_emission(),
        };
        let brightest = (BRIGHTEST * truth.brightest()).max(found_by_chance);
        Rules {
            bound: self.plan.bound,
            ..Rules::new(
                self.plan.questions.len(),
                looks,
                question.samples,
                brightest,
            )
        }
    }

    /// What the pictures of a question say.
    fn finding(&self, question: &Question) -> Finding {
        if let Some(verdict) = self.refusals.get(question.name) {
            return Finding::of(verdict.clone());
        }
        let most = self.plan.tier.most();
        let (truth, replicates) = match self.replicates(question, self.plan.jobs(question, most)) {
            Ok(answers) => answers,
            Err(error) => return Finding::of(Verdict::Broken(error)),
        };
        let mut finding = judge(&truth, &replicates, &self.rules(question));
        if let Ok((_, finer)) = self.replicates(question, self.plan.finer_jobs(question)) {
            let before = finding.replicates.iter().map(|(_, ratio)| ratio - 1.0);
            let after = finer
                .iter()
                .map(|picture| picture.mean() / truth.mean() - 1.0);
            let [before, after]: [Vec<f64>; 2] = [before.collect(), after.collect()];
            finding.refinement = Refinement::of(&before, &after);
        }
        finding
    }

    /// The truth of a question, and the pictures of jobs that there are.
    fn replicates(
        &self,
        question: &Question,
        jobs: Vec<Job>,
    ) -> Result<(crate::truth::Picture, Vec<Replicate>), String> {
        let (_, truth) = (question.ask)();
        let replicates = self.folder.replicates(&jobs, truth.pixels)?;
        Ok((truth, replicates))
    }

    /// A report of this run with the means of the folder's pictures, for [`crate::page::page`]. Questions without pictures, or
    /// with one that cannot be read, are shown without.
    pub fn run_for_page<'a>(&self, report: &'a Report) -> Run<'a> {
        let mean = |question: &&'static Question| {
            let jobs = self.plan.jobs(question, self.plan.tier.most());
            let (truth, replicates) = self.replicates(question, jobs).ok()?;
            let mean = replicate::mean(&replicates, truth.pixels)?;
            Some((question.name.to_owned(), mean))
        };
        Run {
            report,
            means: self.questions.iter().filter_map(mean).collect(),
        }
    }
}
