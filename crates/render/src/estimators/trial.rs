//! A comparison from the scene to the findings: read, try out, fix, measure.

use super::analysis;
use super::cell::{self, Cell};
use super::estimator_config::{self, EstimatorConfig, Lists, Load};
use super::findings::Findings;
use super::options::Options;
use super::reference::Reference;
use super::schedule::{FEWEST, LADDER, Pace, Schedule, Share, Size};
use crate::loaded::{LoadError, Loaded};
use crate::{memory, pipeline};
use etalon_integrators::Progress;
use etalon_params::Diagnostic;
use etalon_sampling::hash::{derived_key, stream_key};
use std::path::Path;
use std::time::{Duration, Instant};

/// Why there is no comparison.
#[derive(Debug)]
pub enum Failure {
    /// The scene or the command line, with places.
    Refused(LoadError),
    /// Anything else, in one sentence.
    Impossible(String),
    /// Somebody asked to stop.
    Cancelled,
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Refused(refusal) => {
                let first = refusal.diagnostics.first();
                let text = first.map(|d| d.one_line(&refusal.sources));
                f.write_str(&text.unwrap_or_else(|| "the scene was refused".to_owned()))
            }
            Self::Impossible(reason) => f.write_str(reason),
            Self::Cancelled => f.write_str("cancelled"),
        }
    }
}

impl std::error::Error for Failure {}

impl From<LoadError> for Failure {
    fn from(refusal: LoadError) -> Self {
        Self::Refused(refusal)
    }
}

impl From<String> for Failure {
    fn from(reason: String) -> Self {
        Self::Impossible(reason)
    }
}

/// A comparison that is ready to be measured: what will be rendered is fixed.
pub struct Trial {
    scene: Loaded,
    entrants: Vec<EstimatorConfig>,
    /// A reference from a file.
    reference: Option<Reference>,
    schedule: Schedule,
    options: Options,
    /// When there is no time left; a schedule of another time has none.
    deadline: Option<Instant>,
}

/// How far beyond the time that was asked for pictures are still begun, relatively.
const OVERTIME: f64 = 0.05;

/// What the random numbers of a comparison are for.
#[derive(Clone, Copy)]
enum Purpose {
    Pilot,
    Reference,
    Measurement,
}

/// A seed that nothing else has: of picture `index` for one purpose of one estimator.
fn seed(options: &Options, purpose: Purpose, entrant: usize, cell: usize, index: u32) -> u64 {
    let key = stream_key(options.seed, purpose as u32);
    derived_key(
        derived_key(derived_key(key, entrant as u32), cell as u32),
        index,
    )
}

impl Trial {
    /// Reads the scene, renders a short pilot with every estimator on the current thread pool, and
    /// fixes what will be measured.
    ///
    /// # Errors
    /// [`Failure::Refused`] for a scene, integrator, sampler or filter that cannot be used;
    /// [`Failure::Impossible`] for fewer than two estimators, for a reference that does not fit, or
    /// if the time is not enough (it says what would be).
    pub fn prepare(path: &Path, options: &Options) -> Result<Self, Failure> {
        Self::prepare_loaded(&|load| pipeline::load(path, load), options, &())
    }

    /// As [`Trial::prepare`], of a scene that is loaded in this way; `progress` may stop the pilot.
    ///
    /// # Errors
    /// As [`Trial::prepare`], and [`Failure::Cancelled`].
    pub fn prepare_loaded(
        load: Load<'_>,
        options: &Options,
        progress: &dyn Progress,
    ) -> Result<Self, Failure> {
        if !(options.seconds > 0.0 && options.seconds.is_finite()) {
            return Err("the time must be a positive number of seconds"
                .to_owned()
                .into());
        }
        if !(0.01..=0.9).contains(&options.reference_share) {
            return Err("the reference's share must lie between 0.01 and 0.9"
                .to_owned()
                .into());
        }
        let lists = Lists {
            integrators: &options.integrators,
            samplers: &options.samplers,
            filters: &options.filters,
            light_choosers: &options.light_choosers,
        };
        let (scene, entrants) = estimator_config::gather(load, &options.load, &lists)?;
        if let [only] = entrants.as_slice() {
            return Err(format!(
                "`{}` alone is no comparison: name two or more integrators, samplers or filters",
                only.name
            )
            .into());
        }
        let size = scene.compiled.film.crop_size.to_array().map(|n| n as usize);
        let reference = options.reference.as_ref();
        let reference = reference
            .map(|path| Reference::read(path, size))
            .transpose()?;
        check_memory(&scene, &entrants)?;
        let start = Instant::now();
        let paces = pilot(&entrants, options, progress)?;
        let left = options.seconds - start.elapsed().as_secs_f64();
        let share = reference.is_none().then_some(options.reference_share);
        let schedule = Schedule::fix(&paces, left, share, options.picture_seconds).map_err(|needed| {
            let spent = options.seconds - left;
            let enough = (1.2 * (needed + spent)).max(0.1);
            format!(
                "{} s are not enough for {} estimators: one sample per pixel takes up to {:.2} s{}, \
                 and each renders 16 pictures or more; {} s would do",
                options.seconds,
                paces.len(),
                paces.iter().map(|p| p.seconds).fold(0.0, f64::max),
                (options.picture_seconds)
                    .map(|length| format!(", a picture {length} s"))
                    .unwrap_or_default(),
                if enough < 1.0 {
                    (enough * 10.0).ceil() / 10.0
                } else {
                    enough.ceil()
                }
            )
        })?;
        Ok(Self {
            scene,
            entrants,
            reference,
            schedule,
            options: options.clone(),
            deadline: Some(start + Duration::from_secs_f64(options.seconds * (1.0 + OVERTIME))),
        })
    }

    /// The estimators.
    pub fn entrants(&self) -> &[EstimatorConfig] {
        &self.entrants
    }

    /// The scene.
    pub fn scene(&self) -> &Loaded {
        &self.scene
    }

    /// What will be rendered.
    pub fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    /// The same with what was rendered another time, so that all pictures (but not their times) are
    /// those of then; the pilot's schedule depends on the machine.
    ///
    /// # Errors
    /// [`Failure::Impossible`] unless it is of as many estimators, each with at least two pictures of
    /// every size and a step where samples are equal, and has a reference if and only if none is read.
    pub fn with_schedule(self, schedule: Schedule) -> Result<Self, Failure> {
        let enough = |size: &Size| size.samples >= 1 && size.replicates >= 2;
        let fits = |share: &Share| {
            let sizes = share.ladder.iter().chain([&share.equal_time]);
            share.ladder.len() > schedule.equal_samples && sizes.into_iter().all(enough)
        };
        let sound = schedule.shares.len() == self.entrants.len()
            && schedule.shares.iter().all(fits)
            && schedule.reference.iter().all(enough)
            && schedule.reference.is_none() == self.reference.is_some();
        match sound {
            true => Ok(Self {
                schedule,
                deadline: None,
                ..self
            }),
            false => Err("this schedule is of another comparison".to_owned().into()),
        }
    }

    /// Camera samples that [`Trial::run`] will take.
    pub fn samples(&self) -> u64 {
        let [width, height] = self.scene.compiled.film.crop_size.to_array();
        self.schedule.samples() * u64::from(width) * u64::from(height)
    }

    /// Renders and measures everything on the current thread pool.
    ///
    /// # Errors
    /// If memory runs out, a pixel is not finite, or `progress` says to stop.
    pub fn run(mut self, progress: &dyn Progress) -> Result<Findings, Failure> {
        let start = Instant::now();
        let reference = match self.reference.take() {
            Some(reference) => reference,
            None => self.render_reference(progress)?,
        };
        let mut cells: Vec<Vec<Cell>> = (self.schedule.shares.iter())
            .map(|share| {
                let sizes = [share.equal_time].into_iter().chain(share.ladder.clone());
                sizes.map(Cell::new).collect()
            })
            .collect();
        for (entrant, cell, index) in order(&cells) {
            // By the clock alone, not by results. All cells are equally far, as the order spreads them.
            let is_late = self.deadline.is_some_and(|end| Instant::now() > end);
            if is_late && may_be_left_out(&cells[entrant][cell], cell) {
                continue;
            }
            let estimator = &self.entrants[entrant];
            let target = &mut cells[entrant][cell];
            let seed = seed(&self.options, Purpose::Measurement, entrant, cell, index);
            let samples = target.size.samples;
            let rendered = cell::render(estimator, samples, seed, progress)?;
            if progress.cancelled() {
                return Err(Failure::Cancelled);
            }
            let measured = target.add(rendered, &reference, cell == 0);
            measured.map_err(|reason| format!("{}: {reason}", estimator.name))?;
        }
        let seconds = start.elapsed().as_secs_f64();
        let planned = |cells: &[Vec<Cell>]| -> u32 {
            let sizes = cells.iter().flatten().map(|cell| cell.size.replicates);
            sizes.sum()
        };
        let all = planned(&cells);
        for cell in cells.iter_mut().flatten() {
            // Of those that were left out, one may lack its partner.
            if (cell.measured.len() as u32) < cell.size.replicates {
                cell.measured.truncate(2 * cell.pairs.len());
            }
            cell.size.replicates = cell.measured.len() as u32;
        }
        let measured = analysis::Measured {
            left_out: [all - planned(&cells), all],
            scene: &self.scene,
            entrants: &self.entrants,
            options: &self.options,
            equal_samples: self.schedule.equal_samples,
            reference: &reference,
            cells: &cells,
            seconds,
        };
        Ok(analysis::findings(&measured))
    }

    fn render_reference(&self, progress: &dyn Progress) -> Result<Reference, Failure> {
        let size = self.schedule.reference;
        let size = size.expect("a schedule without reference is made where there is a file");
        let seed = seed(&self.options, Purpose::Reference, 0, 0, 0);
        let share = self.options.reference_share;
        let entrant = &self.entrants[0];
        let reference = Reference::render(entrant, size, seed, share, progress)?;
        match progress.cancelled() {
            true => Err(Failure::Cancelled),
            false => Ok(reference),
        }
    }
}

/// Whether there are pictures enough in a cell: of equal time (cell 0), or of a size of the ladder beyond its first, whose pictures
/// take no time.
fn may_be_left_out(cell: &Cell, index: usize) -> bool {
    let fewest = match index {
        0 => FEWEST,
        1 => cell.size.replicates,
        _ => LADDER / 2,
    };
    cell.measured.len() as u32 >= fewest
}

/// Every picture as (estimator, cell, index), those of all cells spread evenly over the run.
fn order(cells: &[Vec<Cell>]) -> Vec<(usize, usize, u32)> {
    let mut order = Vec::new();
    for (entrant, cells) in cells.iter().enumerate() {
        for (cell, Cell { size, .. }) in cells.iter().enumerate() {
            for index in 0..size.replicates {
                let at = (f64::from(index) + 0.5) / f64::from(size.replicates);
                order.push((at, (entrant, cell, index)));
            }
        }
    }
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    order.into_iter().map(|(_, picture)| picture).collect()
}

fn check_memory(scene: &Loaded, entrants: &[EstimatorConfig]) -> Result<(), Failure> {
    let planes = entrants.iter().map(|e| 3 + e.integrator.channels().len());
    let refuse = |diagnostic: Diagnostic| {
        Failure::Refused(LoadError {
            diagnostics: vec![diagnostic],
            sources: scene.sources.clone(),
        })
    };
    memory::check(scene, planes.max().unwrap_or(3), false).map_err(refuse)
}

/// The share of the time that the pilot may take, all estimators together.
const PILOT_SHARE: f64 = 0.05;

/// The pictures of a pilot grow until one takes so long (s), or their share of the time is spent.
const LONG_ENOUGH: f64 = 0.05;

/// The pace of every estimator, from pictures of 1, 4, 16, … samples per pixel.
fn pilot(
    entrants: &[EstimatorConfig],
    options: &Options,
    progress: &dyn Progress,
) -> Result<Vec<Pace>, Failure> {
    let each = PILOT_SHARE * options.seconds / entrants.len() as f64;
    let pace = |(entrant, estimator): (usize, &EstimatorConfig)| {
        let sampler = estimator.sampler;
        let render = |step: u32, samples: u32| {
            let seed = seed(options, Purpose::Pilot, entrant, 0, step);
            let rendered = cell::render(estimator, samples, seed, progress)?;
            match progress.cancelled() {
                true => Err(Failure::Cancelled),
                false => Ok(rendered.seconds),
            }
        };
        // The first picture finds cold caches; its time is spent, but does not count.
        let cold = render(0, 1)?;
        let (mut counted, mut taken) = (0.0, 0.0);
        let (mut step, mut samples) = (1, 1);
        loop {
            let seconds = render(step, samples)?;
            counted += seconds;
            taken += f64::from(samples);
            if seconds >= LONG_ENOUGH || cold + counted + 4.0 * seconds > each {
                return Ok(Pace {
                    seconds: (counted / taken).max(1e-9),
                    sampler,
                });
            }
            (step, samples) = (step + 1, samples * 4);
        }
    };
    entrants.iter().enumerate().map(pace).collect()
}
