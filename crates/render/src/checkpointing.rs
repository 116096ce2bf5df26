//! Checkpoints: the film of a long render, kept beside the image while it is rendered.
//!
//! A checkpoint is written when a replicate is finished: after the first one, and then whenever the
//! time since the last is twenty times what writing took, so that writing never costs more than 5 %
//! or so. Within a long replicate one is written between rounds over the film, now and then, and
//! when the render is interrupted. It appears under its name only when it is complete, in place of
//! the one before.

use crate::first_half::FirstHalf;
use crate::watcher::Show;
use etalon_film::{CheckpointFacts, ExactFilm, ExactTile, Part, RenderFacts, recorded_seconds};
use etalon_integrators::ReplicateRange;
use etalon_transport::{Film, FilmSample, Placing};
use glam::{UVec2, Vec2};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Time between checkpoints, in units of the time for writing one.
const PATIENCE: u32 = 20;

/// The least time between checkpoints within a replicate.
const WITHIN: Duration = Duration::from_secs(10);

/// How to keep a render, and what was kept of it.
#[derive(Clone, Debug)]
pub struct Checkpointing {
    /// Where.
    pub path: PathBuf,
    /// What the checkpoint says beside what a part says.
    pub facts: CheckpointFacts,
    /// A checkpoint to resume from.
    pub earlier: Option<Part>,
    /// Hears why no checkpoint could be written, the first time.
    pub failed: fn(&str),
}

impl Checkpointing {
    /// Samples of the replicate that was being rendered, all pixels together.
    pub fn samples_begun(&self) -> u64 {
        let metadata = self.earlier.as_ref().map(Part::metadata);
        metadata.map_or(0, |metadata| {
            let [width, height] = metadata.film.crop_size.map(f64::from);
            let mean = metadata.unfinished.map_or(0.0, |begun| begun.mean);
            (mean * width * height).round() as u64
        })
    }

    /// Replicates that are finished, and the time that they took as far as it is known.
    pub fn finished(&self) -> (u32, Duration) {
        let metadata = self.earlier.as_ref().map(Part::metadata);
        metadata.map_or((0, Duration::ZERO), |metadata| {
            let seconds = metadata.seconds.unwrap_or(0.0);
            let time = Duration::try_from_secs_f64(seconds).unwrap_or_default();
            (metadata.replicates, time)
        })
    }
}

/// Writes checkpoints.
#[derive(Debug)]
struct Keeper {
    path: PathBuf,
    facts: RenderFacts,
    checkpoint: CheckpointFacts,
    /// Replicates of the whole, and samples per pixel of each.
    of: (u32, u32),
    /// Replicates when nothing remains to be done.
    last: u32,
    /// When rendering began, and the time of earlier runs.
    begin: Instant,
    before: Duration,
    /// When the last checkpoint was finished, and what writing it took.
    written: Option<(Instant, Duration)>,
    failed: Option<fn(&str)>,
}

/// The film of a render: kept and shown while it is rendered, if that was asked for.
#[derive(Debug)]
pub(crate) struct RenderFilm {
    film: ExactFilm,
    keeper: Option<Keeper>,
    show: Option<Show>,
    half: Option<FirstHalf>,
}

impl RenderFilm {
    /// This film, kept as `keeping` says while the replicates of `share` are rendered, of `of`
    /// replicates and samples per pixel of each in all.
    ///
    /// # Errors
    /// If the checkpoint to resume from is of another film.
    pub(crate) fn new(
        film: ExactFilm,
        keeping: Option<Checkpointing>,
        facts: &RenderFacts,
        share: ReplicateRange,
        of: (u32, u32),
    ) -> Result<Self, String> {
        let Some(keeping) = keeping else {
            return Ok(Self::unkept(film));
        };
        let (_, before) = keeping.finished();
        let film = match keeping.earlier {
            Some(part) => film.go_on(part)?,
            None => film,
        };
        let keeper = Keeper {
            path: keeping.path,
            facts: facts.clone(),
            checkpoint: keeping.facts,
            of,
            last: share.count,
            begin: Instant::now(),
            before,
            written: None,
            failed: Some(keeping.failed),
        };
        Ok(Self {
            film,
            keeper: Some(keeper),
            show: None,
            half: None,
        })
    }

    /// A film of which nothing is kept.
    pub(crate) fn unkept(film: ExactFilm) -> Self {
        Self {
            film,
            keeper: None,
            show: None,
            half: None,
        }
    }

    /// The same film, shown to somebody.
    #[must_use]
    pub(crate) fn shown(self, show: Option<Show>) -> Self {
        Self { show, ..self }
    }

    /// The same film, which remembers its first half.
    #[must_use]
    pub(crate) fn halved(self, half: Option<FirstHalf>) -> Self {
        Self { half, ..self }
    }

    /// The first half, if it was to be remembered.
    pub(crate) fn take_half(&mut self) -> Option<FirstHalf> {
        self.half.take()
    }

    /// Shows it, if somebody looks on.
    fn show(&mut self) {
        if let Some(show) = &mut self.show {
            show.show(&mut self.film);
        }
    }

    /// The film, after what there is has been kept if the render was interrupted.
    pub(crate) fn finish(mut self) -> ExactFilm {
        if let Some(keeper) = &mut self.keeper
            && self.film.replicates() < keeper.last
        {
            keeper.write(&mut self.film);
        }
        self.film
    }
}

impl Keeper {
    /// Whether a checkpoint is worth its time now.
    fn is_due(&self, replicates: u32) -> bool {
        let rested = |(when, took): (Instant, Duration)| when.elapsed() >= PATIENCE * took;
        replicates < self.last && self.written.is_none_or(rested)
    }

    /// Whether one is worth its time within a replicate.
    fn is_due_within(&self) -> bool {
        let (when, took) = self.written.unwrap_or((self.begin, Duration::ZERO));
        when.elapsed() >= WITHIN.max(PATIENCE * took)
    }

    fn write(&mut self, film: &mut ExactFilm) {
        let begin = Instant::now();
        let facts = RenderFacts {
            seconds: recorded_seconds(self.before + self.begin.elapsed()),
            ..self.facts.clone()
        };
        let written = film.lend_part(facts, self.of, self.checkpoint.clone(), |part| {
            part.write_exr(&self.path)
        });
        if let Some(Err(error)) = written
            && let Some(failed) = self.failed.take()
        {
            failed(&error.to_string());
        }
        self.written = Some((Instant::now(), begin.elapsed()));
    }
}

impl Placing for RenderFilm {
    #[inline]
    fn place(&self, pixel: UVec2, u: Vec2) -> FilmSample {
        self.film.place(pixel, u)
    }

    #[inline]
    fn place_alone(&self, pixel: UVec2, u: Vec2) -> FilmSample {
        self.film.place_alone(pixel, u)
    }

    #[inline]
    fn shares_samples(&self) -> bool {
        self.film.shares_samples()
    }

    #[inline]
    fn dealt(&self, pixel: UVec2, even: u32) -> u32 {
        self.film.dealt(pixel, even)
    }
}

impl Film for RenderFilm {
    type Tile<'f> = ExactTile<'f>;

    fn origin(&self) -> UVec2 {
        self.film.origin()
    }

    fn size(&self) -> UVec2 {
        self.film.size()
    }

    fn margin(&self) -> f32 {
        self.film.margin()
    }

    fn rim(&self) -> u32 {
        self.film.rim()
    }

    fn light_paths(&self) -> u32 {
        self.film.light_paths()
    }

    fn tile(&self, from: UVec2, to: UVec2, alone: bool) -> ExactTile<'_> {
        self.film.tile(from, to, alone)
    }

    fn done(&self, pixel: UVec2) -> u32 {
        self.film.done(pixel)
    }

    fn end_round(&mut self) {
        self.show();
        if let Some(keeper) = &mut self.keeper
            && keeper.is_due_within()
        {
            keeper.write(&mut self.film);
        }
    }

    fn end_replicate(&mut self, samples: u32) {
        self.film.end_replicate(samples);
        if let Some(half) = &mut self.half {
            half.see(&self.film);
        }
        self.show();
        let replicates = self.film.replicates();
        if let Some(keeper) = &mut self.keeper
            && keeper.is_due(replicates)
        {
            keeper.write(&mut self.film);
        }
    }
}
