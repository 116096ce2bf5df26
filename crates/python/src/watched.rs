//! Long work, in a way that leaves the interpreter to others and hears Ctrl-C.

use crate::errors::value_error;
use crate::progress_report::{ProgressReport, Watch};
use etalon_render::resources::MOST_THREADS;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::num::NonZeroU32;
use std::panic::resume_unwind;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// How often signals are looked for and progress is told.
const TICK: Duration = Duration::from_millis(100);

/// So many threads.
fn pool(threads: NonZeroU32) -> PyResult<ThreadPool> {
    let threads = threads.get();
    if threads > MOST_THREADS {
        return Err(value_error(format!(
            "threads is {threads}: there may be {MOST_THREADS} at most"
        )));
    }
    let pool = ThreadPoolBuilder::new()
        .num_threads(threads as usize)
        .build();
    pool.map_err(|error| value_error(format!("cannot start threads: {error}")))
}

/// Does a job on so many threads, or on those that all renders share, and tells how far it is.
///
/// The outer error is Python's: Ctrl-C, or what the callable raised.
pub(crate) fn watched<T: Send, E: Send>(
    py: Python<'_>,
    threads: Option<NonZeroU32>,
    report: &ProgressReport,
    job: impl FnOnce(&Watch) -> Result<T, E> + Send,
) -> PyResult<Result<T, E>> {
    let pool = threads.map(pool).transpose()?;
    let outcome = py.detach(|| work(pool.as_ref(), report, job));
    if let Ok(Ok(_)) = &outcome {
        report.tell(py, 1.0)?;
    }
    report.end(py)?;
    outcome
}

/// Does the job on other threads. Meanwhile this one, to which Python sends signals, looks for them and tells what is done.
fn work<T: Send>(
    pool: Option<&ThreadPool>,
    report: &ProgressReport,
    job: impl FnOnce(&Watch) -> T + Send,
) -> PyResult<T> {
    let watch = Watch::default();
    thread::scope(|scope| {
        let (alive, ended) = channel::<()>();
        let watch = &watch;
        let worker = scope.spawn(move || {
            let _alive = alive;
            match pool {
                Some(pool) => pool.install(|| job(watch)),
                None => job(watch),
            }
        });
        let mut outcome = Ok(());
        while ended.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
            if outcome.is_ok() {
                outcome = Python::attach(|py| {
                    py.check_signals()?;
                    report.tell(py, watch.fraction())
                });
                if outcome.is_err() {
                    watch.stop();
                }
            }
        }
        let done = worker.join().unwrap_or_else(|panic| resume_unwind(panic));
        outcome.map(|()| done)
    })
}
