//! Rendering, in a way that leaves the interpreter to others and hears Ctrl-C.

use crate::errors::{of_diagnostics, value_error};
use crate::image::Image;
use crate::progress_report::{ProgressReport, Watch};
use crate::scene::Scene;
use etalon_film::{FilmSize, Framing};
use etalon_integrators::RenderPlan;
use etalon_params::Diagnostic;
use etalon_render::pipeline::{self, LoadOptions, Loaded, RenderOptions, Rendered};
use glam::UVec2;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::num::NonZeroU32;
use std::panic::resume_unwind;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// How often signals are looked for and progress is told.
const TICK: Duration = Duration::from_millis(100);

/// The most threads, as for the binary.
const MOST_THREADS: usize = 1024;

/// Renders a scene.
///
/// spp: samples per pixel, all replicates together, if not the scene's.
/// seed: if not the scene's. The same seed gives the same bits, whatever the threads, and those of the binary.
/// integrator: a type for the innermost integrator instead of its own.
/// size: (width, height) of the whole film in pixels, instead of the scene's.
/// crop: (x, y, width, height): this part of the film alone, with the bits that it has in the whole.
/// time: the moment that the shutter counts from (units of scene time).
/// threads: how many; as many as there are processors if None.
/// progress: called with the fraction done, or True for a line on standard error.
///
/// Ctrl-C stops the render and raises KeyboardInterrupt. Raises SceneError if the scene cannot be rendered so.
#[pyfunction]
#[pyo3(signature = (scene, spp=None, seed=None, *, integrator=None, size=None, crop=None, time=None, threads=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "Python has names for them")]
pub(crate) fn render(
    py: Python<'_>,
    scene: PyRef<'_, Scene>,
    spp: Option<NonZeroU32>,
    seed: Option<u64>,
    integrator: Option<String>,
    size: Option<[u32; 2]>,
    crop: Option<[u32; 4]>,
    time: Option<f64>,
    threads: Option<NonZeroU32>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<Image> {
    if let Some(time) = time.filter(|time| !time.is_finite()) {
        return Err(value_error(format!("time is {time}: it must be finite")));
    }
    let report = ProgressReport::of(progress)?;
    let is_other = integrator.is_some() || size.is_some() || crop.is_some() || time.is_some();
    let loaded = scene.with(
        py,
        is_other.then_some(|options: &mut LoadOptions| {
            options.integrator = integrator;
            options.time = time.unwrap_or_default();
            options.framing = Framing {
                size: size.map(|size| FilmSize::Pixels(size.into())),
                crop: crop.map(|[x, y, w, h]| [UVec2::new(x, y), UVec2::new(w, h)]),
            };
        }),
    )?;
    let plan = pipeline::plan(
        &loaded,
        &RenderOptions {
            spp: spp.map(NonZeroU32::get),
            seed,
            ..RenderOptions::default()
        },
    );
    let pool = threads.map(pool).transpose()?;
    let rendered = py.detach(|| watched(&loaded, &plan, pool.as_ref(), &report));
    if let Ok(Ok(_)) = &rendered {
        report.tell(py, 1.0)?;
    }
    report.end(py)?;
    let rendered =
        rendered?.map_err(|refusal| of_diagnostics(&[refusal], &loaded.sources, &scene.keys()))?;
    Ok(Image::new(
        rendered.developed,
        None,
        rendered.outcome.remarks,
    ))
}

/// So many threads.
fn pool(threads: NonZeroU32) -> PyResult<ThreadPool> {
    let threads = threads.get() as usize;
    if threads > MOST_THREADS {
        return Err(value_error(format!(
            "threads is {threads}: there may be {MOST_THREADS} at most"
        )));
    }
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| value_error(format!("cannot start threads: {error}")))
}

/// Renders on these threads, or on those that all renders share. Meanwhile this one, to which Python sends signals,
/// looks for them and tells what is done.
///
/// The outer error is Python's: Ctrl-C, or what the callable raised.
fn watched(
    loaded: &Loaded,
    plan: &RenderPlan,
    pool: Option<&ThreadPool>,
    report: &ProgressReport,
) -> PyResult<Result<Rendered, Diagnostic>> {
    let pixels = loaded.compiled.film.crop_size.as_dvec2().element_product();
    let samples = pixels * f64::from(plan.replicates) * f64::from(plan.samples_per_replicate);
    let watch = Watch::default();
    thread::scope(|scope| {
        let (alive, ended) = channel::<()>();
        let watch = &watch;
        let worker = scope.spawn(move || {
            let _alive = alive;
            let render = || pipeline::render(loaded, plan, watch);
            match pool {
                Some(pool) => pool.install(render),
                None => render(),
            }
        });
        let mut outcome = Ok(());
        while ended.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
            if outcome.is_ok() {
                outcome = Python::attach(|py| {
                    py.check_signals()?;
                    report.tell(py, (watch.done() as f64 / samples).min(1.0))
                });
                if outcome.is_err() {
                    watch.stop();
                }
            }
        }
        let rendered = worker.join().unwrap_or_else(|panic| resume_unwind(panic));
        outcome.map(|()| rendered)
    })
}
