//! A progress bar with the remaining time; silent without a terminal.

use crate::preview::Onlookers;
use etalon_integrators::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Shows how a render proceeds, and hears Ctrl-C.
pub struct Bar<'a> {
    bar: ProgressBar,
    cancelled: &'a AtomicBool,
}

impl<'a> Bar<'a> {
    /// A bar for so many samples. It appears on standard error only if that is a terminal,
    /// and not when `quiet`.
    pub fn new(samples: u64, quiet: bool, cancelled: &'a AtomicBool) -> Self {
        let target = if quiet {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr_with_hz(8)
        };
        let bar = ProgressBar::with_draw_target(Some(samples), target);
        let style = ProgressStyle::with_template(
            "{prefix}{wide_bar} {percent:>3} %  {rate}, {eta} left {msg}",
        )
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .with_key(
            "rate",
            |state: &ProgressState, w: &mut dyn std::fmt::Write| {
                let _ = write!(w, "{:.2} M samples/s", state.per_sec() * 1e-6);
            },
        );
        bar.set_style(style);
        bar.enable_steady_tick(Duration::from_millis(250));
        Self { bar, cancelled }
    }

    /// The same bar with a word before it.
    #[must_use]
    pub fn named(self, prefix: String) -> Self {
        self.bar.set_prefix(prefix);
        self
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Progress for Bar<'_> {
    fn tile_done(&self, samples: u64) {
        self.bar.inc(samples);
        if self.cancelled.load(Ordering::Relaxed) {
            self.bar.set_message("(stopping)");
        }
    }

    fn cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

/// A bar whose progress others see, too.
pub struct Seen<'a> {
    /// The bar.
    pub bar: &'a Bar<'a>,
    /// The others.
    pub onlookers: &'a Onlookers,
}

impl Progress for Seen<'_> {
    fn tile_done(&self, samples: u64) {
        self.bar.tile_done(samples);
        self.onlookers.advance(samples);
    }

    fn cancelled(&self) -> bool {
        self.bar.cancelled()
    }
}
