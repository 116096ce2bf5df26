//! How long to render between two looks at the film, and between two looks at who may say stop.
//!
//! Both follow the clock, which decides no bit of a picture: only how its samples are grouped.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// A round lasts this long at least (s), or as long as the pass has samples.
const ROUND: f64 = 0.5;

/// And at least this share of the time that the pass has taken so far, so that rounds stay few.
const SHARE: f64 = 0.25;

/// Between two looks at who may say stop there should be no more than this.
const PATIENCE: Duration = Duration::from_millis(50);

/// The number of samples in a round.
#[derive(Debug, Default)]
pub(crate) struct RoundSize {
    /// Time per sample (s), of all threads together, once known.
    per_sample: Option<f64>,
    pass: Option<Instant>,
    round: Option<Instant>,
}

impl RoundSize {
    /// A pass begins.
    pub(crate) fn begin(&mut self) {
        self.pass = Some(Instant::now());
    }

    /// Begins a round over so many pixels; gives how many more samples each is to get.
    pub(crate) fn round(&mut self, pixels: u64) -> u32 {
        let now = Instant::now();
        self.round = Some(now);
        let Some(per_sample) = self.per_sample else {
            return 1;
        };
        let taken = self.pass.map_or(0.0, |pass| (now - pass).as_secs_f64());
        let seconds = ROUND.max(SHARE * taken);
        let samples = (seconds / (per_sample * pixels as f64)) as u32;
        // Whole batches keep threads busy.
        let whole = samples / 16 * 16;
        if whole > 0 { whole } else { samples.max(1) }
    }

    /// Ends a round in which so many samples were drawn.
    pub(crate) fn end_round(&mut self, drawn: u64) {
        if let Some(round) = self.round.take().filter(|_| drawn > 0) {
            self.per_sample = Some(round.elapsed().as_secs_f64() / drawn as f64);
        }
    }
}

/// The size of batches: smaller if samples are slow.
#[derive(Debug)]
pub(crate) struct Batches {
    most: usize,
    size: AtomicUsize,
}

impl Batches {
    /// At most so many.
    pub(crate) fn new(most: usize) -> Self {
        Self {
            most,
            size: AtomicUsize::new(1),
        }
    }

    /// The current size.
    #[inline]
    pub(crate) fn size(&self) -> usize {
        self.size.load(Ordering::Relaxed)
    }

    /// Does a batch, and looks at the clock.
    #[inline]
    pub(crate) fn measure(&self, batch: impl FnOnce()) {
        let begin = Instant::now();
        batch();
        let size = self.size();
        let next = match begin.elapsed() {
            taken if taken > PATIENCE => 1,
            taken if 4 * taken < PATIENCE => (2 * size).min(self.most),
            _ => size,
        };
        if next != size {
            self.size.store(next, Ordering::Relaxed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slow_samples_come_alone() {
        let batches = Batches::new(16);
        assert_eq!(batches.size(), 1);
        (0..4).for_each(|_| batches.measure(|| ()));
        assert_eq!(batches.size(), 16);
        batches.measure(|| std::thread::sleep(2 * PATIENCE));
        assert_eq!(batches.size(), 1);
    }

    #[test]
    fn rounds_are_long_enough() {
        let mut round_size = RoundSize::default();
        round_size.begin();
        assert_eq!(round_size.round(100), 1, "nothing is known yet");
        round_size.per_sample = Some(1e-3);
        assert_eq!(round_size.round(1), 496);
        assert_eq!(round_size.round(100), 5);
        assert_eq!(round_size.round(1 << 40), 1, "a round has a sample");
        assert_eq!(round_size.round(0), u32::MAX / 16 * 16);
    }
}
