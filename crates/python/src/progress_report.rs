//! Who is told how a render proceeds, and how it is stopped.

use etalon_integrators::Progress;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Counts samples for others to look at, and stops when they say so.
#[derive(Default)]
pub(crate) struct Watch {
    done: AtomicU64,
    /// Samples of all, once it is known how many there will be.
    all: AtomicU64,
    stopped: AtomicBool,
}

impl Watch {
    /// So many more samples will be taken.
    pub(crate) fn expect(&self, samples: u64) {
        let all = self.done.load(Ordering::Relaxed).saturating_add(samples);
        self.all.store(all, Ordering::Relaxed);
    }

    /// The fraction that is done: 0 as long as a pilot has not fixed how much there is to do.
    pub(crate) fn fraction(&self) -> f64 {
        match self.all.load(Ordering::Relaxed) {
            0 => 0.0,
            all => (self.done.load(Ordering::Relaxed) as f64 / all as f64).min(1.0),
        }
    }

    /// Set when somebody asks to stop.
    pub(crate) fn stopped(&self) -> &AtomicBool {
        &self.stopped
    }

    /// Asks to stop.
    pub(crate) fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }
}

impl Progress for Watch {
    fn tile_done(&self, samples: u64) {
        self.done.fetch_add(samples, Ordering::Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }
}

/// What `progress` asks for.
pub(crate) enum ProgressReport {
    /// Nothing.
    Silent,
    /// A line on standard error.
    Line,
    /// A call with the fraction that is done.
    Call(Py<PyAny>),
}

impl ProgressReport {
    /// Of `None`, a `bool` or a callable.
    pub(crate) fn of(progress: Option<Bound<'_, PyAny>>) -> PyResult<Self> {
        match progress {
            None => Ok(Self::Silent),
            Some(object) if object.is_callable() => Ok(Self::Call(object.unbind())),
            Some(object) => match object.extract() {
                Ok(true) => Ok(Self::Line),
                Ok(false) => Ok(Self::Silent),
                Err(_) => Err(PyTypeError::new_err(
                    "progress is True for a line on standard error, or a callable given the fraction done",
                )),
            },
        }
    }

    /// Tells what fraction is done.
    pub(crate) fn tell(&self, py: Python<'_>, fraction: f64) -> PyResult<()> {
        match self {
            Self::Silent => Ok(()),
            Self::Line => write(py, &format!("\r{:3.0} %", 100.0 * fraction)),
            Self::Call(callable) => callable.call1(py, (fraction,)).map(drop),
        }
    }

    /// Ends a line that was begun.
    pub(crate) fn end(&self, py: Python<'_>) -> PyResult<()> {
        match self {
            Self::Line => write(py, "\n"),
            _ => Ok(()),
        }
    }
}

/// Python's standard error, which notebooks show.
fn write(py: Python<'_>, text: &str) -> PyResult<()> {
    let stderr = py.import("sys")?.getattr("stderr")?;
    stderr.call_method1("write", (text,))?;
    stderr.call_method0("flush").map(drop)
}
