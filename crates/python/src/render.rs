//! Rendering: so many samples, or as many as an error or a time asks for.

use crate::errors::{of_diagnostics, value_error};
use crate::image::Image;
use crate::progress_report::{ProgressReport, Watch};
use crate::scene::Scene;
use crate::watched::watched;
use etalon_film::{FilmSize, Framing, RenderedImage};
use etalon_integrators::{RenderPlan, ReplicateRange};
use etalon_render::pilot::Failure;
use etalon_render::pipeline::{self, LoadOptions, Loaded, RenderControls, RenderOptions, Rendered};
use etalon_render::resources::MOST_REPLICATES;
use etalon_render::target::{self, Noise, Pilot, Target};
use glam::UVec2;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::num::NonZeroU32;
use std::sync::Arc;
use std::time::Instant;

/// Renders a scene.
///
/// spp: samples per pixel, all replicates together, if not the scene's.
/// seed: if not the scene's. The same seed gives the same bits, whatever the threads, and those of the binary.
/// error: in place of spp, the `relative_standard_error` to reach, such as 0.01. A pilot of 64 samples per pixel, which are no
/// part of the image, fixes how many are needed; `spp` and `replicates` of its metadata give the same image again. In
/// one case of twenty or so the error is missed; `image.notes` says so.
/// seconds: in place of spp, about how long to render (s), the pilot that fixes the samples included.
/// replicates: independent estimates whose spread makes the standard error; 8 or somewhat more if None.
/// integrator: a type for the innermost integrator instead of its own.
/// size: (width, height) of the whole film in pixels, instead of the scene's.
/// crop: (x, y, width, height): this part of the film alone, with the bits that it has in the whole.
/// time: the moment that the shutter counts from (units of scene time).
/// features: whether the image gets the channels that `denoise` needs.
/// part: (k, n): the k-th of n shares of the replicates alone, for `merge` to put together. The same spp and seed for all.
/// threads: how many; as many as there are processors if None.
/// progress: called with the fraction done, or True for a line on standard error.
///
/// Ctrl-C stops the render and raises KeyboardInterrupt. Raises SceneError if the scene cannot be rendered so.
#[pyfunction]
#[pyo3(signature = (scene, spp=None, seed=None, *, error=None, seconds=None, replicates=None, integrator=None, size=None,
    crop=None, time=None, features=false, part=None, threads=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "Python has names for them")]
pub(crate) fn render(
    py: Python<'_>,
    scene: PyRef<'_, Scene>,
    spp: Option<NonZeroU32>,
    seed: Option<u64>,
    error: Option<f64>,
    seconds: Option<f64>,
    replicates: Option<NonZeroU32>,
    integrator: Option<String>,
    size: Option<[u32; 2]>,
    crop: Option<[u32; 4]>,
    time: Option<f64>,
    features: bool,
    part: Option<(u32, u32)>,
    threads: Option<NonZeroU32>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<Image> {
    if let Some(time) = time.filter(|time| !time.is_finite()) {
        return Err(value_error(format!("time is {time}: it must be finite")));
    }
    if let Some(count) = replicates.filter(|count| count.get() > MOST_REPLICATES) {
        return Err(value_error(format!(
            "replicates is {count}: there may be {MOST_REPLICATES} at most"
        )));
    }
    let target = target(spp, error, seconds)?;
    if part.is_some() && (features || target.is_some()) {
        return Err(value_error(
            "a part has spp samples per pixel, and no features",
        ));
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
    let amount = RenderOptions {
        replicates: replicates.map(NonZeroU32::get),
        spp: spp.map(NonZeroU32::get),
        seed,
        // Blocks of one sequence overstate the noise that a denoiser is to take away.
        independent_replicates: features,
        ..RenderOptions::default()
    };
    let mut plan = pipeline::plan(&loaded, &amount);
    plan.share = part.map(|part| share(part, plan.replicates)).transpose()?;
    let job = |watch: &Watch| rendered(&loaded, plan, target, amount.replicates, features, watch);
    let rendered = watched(py, threads, &report, job)?;
    let rendered = rendered.map_err(|failure| match failure {
        Failure::Refused(refusal) => of_diagnostics(&[refusal], &loaded.sources, &scene.keys()),
        Failure::Cancelled => PyKeyboardInterrupt::new_err(()),
    })?;
    let (image, mut notes) = (rendered.developed, rendered.outcome.remarks);
    if let Some(Target::Error(aim)) = target {
        notes.extend(missed(aim, &image));
    }
    Ok(match rendered.part {
        Some(part) => Image::of_part(Arc::new(part), notes),
        None => Image::new(image, None, notes),
    })
}

/// The replicates of the k-th part of n.
fn share((number, count): (u32, u32), replicates: u32) -> PyResult<ReplicateRange> {
    let share =
        (number.checked_sub(1)).and_then(|index| ReplicateRange::of(replicates, index, count));
    share.ok_or_else(|| {
        value_error(format!(
            "part is ({number}, {count}): it must be (k, n) with k from 1 to n, and n at most the number of replicates, {replicates}"
        ))
    })
}

/// What is to be said if an image has not the relative standard error that was aimed at.
fn missed(aim: f64, image: &RenderedImage) -> Option<String> {
    let reached = Noise::of(image)?.relative()?;
    let (reached, percent) = (100.0 * reached, 100.0 * aim);
    (reached > percent).then(|| {
        format!(
            "the target is missed: relative standard error {reached:.3} % instead of {percent} %"
        )
    })
}

/// What the image is to reach, if it is not a number of samples.
fn target(
    spp: Option<NonZeroU32>,
    error: Option<f64>,
    seconds: Option<f64>,
) -> PyResult<Option<Target>> {
    let given = [
        ("spp", spp.is_some()),
        ("error", error.is_some()),
        ("seconds", seconds.is_some()),
    ];
    let given: Vec<&str> = given.iter().filter(|g| g.1).map(|g| g.0).collect();
    if given.len() > 1 {
        return Err(value_error(format!(
            "{} each fix the number of samples: give one of them",
            given.join(" and ")
        )));
    }
    for (name, value, range) in [
        ("error", error, target::ERRORS),
        ("seconds", seconds, target::SECONDS),
    ] {
        if let Some(value) = value.filter(|value| !range.contains(value)) {
            return Err(value_error(format!(
                "{name} is {value}: it must lie between {} and {}",
                range.start(),
                range.end()
            )));
        }
    }
    Ok(error.map(Target::Error).or(seconds.map(Target::Seconds)))
}

/// Renders, after a pilot if there is a target.
fn rendered(
    loaded: &Loaded,
    mut plan: RenderPlan,
    target: Option<Target>,
    replicates: Option<u32>,
    features: bool,
    watch: &Watch,
) -> Result<Rendered, Failure> {
    if let Some(target) = target {
        let pilot = Pilot {
            samples: target::PILOT,
            distribution: None,
            start: Instant::now(),
        };
        plan = target::fix(loaded, &plan, target, pilot, replicates, watch)?.plan;
    }
    let pixels = loaded
        .compiled
        .film
        .crop_size
        .as_u64vec2()
        .element_product();
    let samples = u64::from(plan.share().count) * u64::from(plan.samples_per_replicate);
    watch.expect(pixels.saturating_mul(samples));
    let manner = RenderControls {
        features,
        ..RenderControls::default()
    };
    Ok(pipeline::render_as(loaded, &plan, manner, watch)?)
}
