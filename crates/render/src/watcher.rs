//! Previews while a picture is rendered.
//!
//! The film is shown between rounds, when no tile is open, and at most so often that previews cost a tenth of the time.
//! They change no bit of the picture.

use etalon_film::{ExactFilm, Glance};
use std::fmt::Debug;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Who looks on.
pub trait Watcher: Send + Sync + Debug {
    /// Sees the picture as it is now.
    fn see(&self, glance: Glance);
}

/// The least time between two looks.
const PATIENCE: Duration = Duration::from_millis(200);

/// Time between previews, in units of the time that one takes.
const SHARE: u32 = 9;

/// Shows a film to a watcher.
#[derive(Debug)]
pub(crate) struct Show {
    watcher: Arc<dyn Watcher>,
    /// Samples per pixel of a replicate.
    samples: u32,
    /// When the last look ended, and what it took.
    last: Option<(Instant, Duration)>,
}

impl Show {
    /// Nothing has been seen of a film of replicates of `samples` samples per pixel.
    pub(crate) fn new(watcher: Arc<dyn Watcher>, samples: u32) -> Self {
        Self {
            watcher,
            samples,
            last: None,
        }
    }

    /// Shows the film, if it is time for it.
    pub(crate) fn show(&mut self, film: &mut ExactFilm) {
        let rested =
            |(when, took): (Instant, Duration)| when.elapsed() >= PATIENCE.max(SHARE * took);
        if !self.last.is_none_or(rested) {
            return;
        }
        let begin = Instant::now();
        if let Some(glance) = film.glance(self.samples) {
            self.watcher.see(glance);
        }
        self.last = Some((Instant::now(), begin.elapsed()));
    }
}
