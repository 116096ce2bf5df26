//! `etalon render`.

use super::convert::losses_in_words;
use super::{BAD_INPUT, fail, note, replay, strategies};
use crate::args::{PartOfMany, RenderArgs};
use crate::pipeline::{self, LoadOptions, Loaded, RenderOptions, Rendered};
use crate::progress::Bar;
use crate::target::{self, Fixed, Noise, Target};
use crate::{diagnose, resources, say};
use etalon_film::Developed;
use etalon_images::{Losses, hdr, pfm, write_atomically};
use etalon_integrators::{Plan, Share};
use etalon_params::Diagnostic;
use std::fmt::Display;
use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

/// Set by Ctrl-C: finish the pass, write the image, stop.
static CANCELLED: AtomicBool = AtomicBool::new(false);

/// Exit code of a render that Ctrl-C ended early (128 + SIGINT, as shells have it).
const INTERRUPTED: u8 = 130;

/// Renders a scene to a file.
pub fn run(args: &RenderArgs) -> ExitCode {
    if args.replay.is_none()
        && let Err(message) = check_paths(args)
    {
        return fail(message);
    }
    let threads = args.threads.unwrap_or(0) as usize;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    match pool {
        // Everything happens on these threads: reading meshes and pictures, too.
        Ok(pool) => pool.install(|| run_here(args)),
        Err(error) => fail(format!("cannot start threads: {error}")),
    }
}

/// Renders on the current thread pool.
fn run_here(args: &RenderArgs) -> ExitCode {
    let mut loaded = match pipeline::load(
        &args.scene,
        &LoadOptions {
            defines: args.define.clone(),
            integrator: args.integrator.clone(),
            data: args.data.clone(),
            light_chooser: args.light_chooser,
        },
    ) {
        Ok(loaded) => loaded,
        Err(refusal) => {
            diagnose::print(&refusal.diagnostics, &refusal.sources);
            return ExitCode::from(BAD_INPUT);
        }
    };
    if !args.quiet {
        diagnose::print(&loaded.notes, &loaded.sources);
    }
    if let Some(address) = &args.replay {
        return replay::run(&loaded, &plan(args, &loaded), address);
    }
    let techniques = args.strategies.as_ref().map(|folder| {
        let integrator = strategies::integrator(&loaded)?;
        Ok::<_, String>((folder, integrator))
    });
    let techniques = match techniques.transpose() {
        Ok(techniques) => techniques,
        Err(message) => return fail(message),
    };
    listen_for_interrupts();
    let aimed = match aim(args, &loaded) {
        Ok(aimed) => aimed,
        Err(target::Failure::Cancelled) => {
            say::remark("stopped during the pilot, without an image\n");
            return ExitCode::from(INTERRUPTED);
        }
        Err(target::Failure::Refused(diagnostic)) => {
            diagnose::print(&[diagnostic], &loaded.sources);
            return ExitCode::from(BAD_INPUT);
        }
    };
    let rendered = match render(args, &loaded, aimed.as_ref()) {
        Ok(rendered) => rendered,
        Err(diagnostic) => {
            diagnose::print(&[diagnostic], &loaded.sources);
            return ExitCode::from(BAD_INPUT);
        }
    };
    if let Err(message) = deliver(args, &loaded, &rendered, aimed.as_ref()) {
        return fail(message);
    }
    if let Some((folder, integrator)) = techniques {
        let each = |loaded: &Loaded| Ok(render(args, loaded, None)?.developed);
        match strategies::write(folder, args, &mut loaded, &integrator, each) {
            Ok(Ok(())) => {}
            Ok(Err(diagnostic)) => {
                diagnose::print(&[diagnostic], &loaded.sources);
                return ExitCode::from(BAD_INPUT);
            }
            Err(message) => return fail(message),
        }
    }
    if CANCELLED.load(Ordering::Relaxed) {
        return ExitCode::from(INTERRUPTED);
    }
    ExitCode::SUCCESS
}

/// Refuses folders that are not there and outputs that could not be written anyway, before hours
/// are spent on them.
fn check_paths(args: &RenderArgs) -> Result<(), String> {
    let extension = args
        .output()
        .extension()
        .map(|e| e.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("exr" | "hdr" | "rgbe" | "pfm") => {}
        _ => {
            return Err(format!(
                "cannot write {}: the name must end in .exr (or .hdr, .pfm)",
                args.output().display()
            ));
        }
    }
    if args.part.is_some() && extension.as_deref() != Some("exr") {
        return Err(format!(
            "cannot write {}: only .exr can hold a part's exact sums",
            args.output().display()
        ));
    }
    if let Some(folder) = args.data.iter().find(|folder| !folder.is_dir()) {
        return Err(format!("there is no folder {}", folder.display()));
    }
    std::iter::once(args.output())
        .chain(args.stats.as_deref())
        .try_for_each(check_place)
}

/// Refuses a place where no file can be made.
pub(super) fn check_place(path: &Path) -> Result<(), String> {
    let refuse = |reason: &dyn Display| Err(format!("cannot write {}: {reason}", path.display()));
    if path.is_dir() {
        return refuse(&"it is a folder");
    }
    if path.exists() {
        return Ok(());
    }
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    if folder.is_some_and(|folder| !folder.is_dir()) {
        return refuse(&"there is no such folder");
    }
    // Only trying tells whether a file can be made there.
    let trial = path.with_file_name(format!(".etalon-{}.part", std::process::id()));
    let made = OpenOptions::new()
        .write(true)
        .create_new(true)
        .open(&trial)
        .and_then(|_| std::fs::remove_file(&trial));
    made.or_else(|error| refuse(&error))
}

fn listen_for_interrupts() {
    // A second Ctrl-C does not wait.
    let handler = || {
        if CANCELLED.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(INTERRUPTED));
        }
    };
    // Without a handler Ctrl-C still ends the program, only without an image.
    if ctrlc::set_handler(handler).is_err() {
        note("Ctrl-C will not write the image");
    }
}

/// What the command line says of the amount of work.
fn plan(args: &RenderArgs, loaded: &Loaded) -> Plan {
    let options = RenderOptions {
        spp: args.spp,
        seed: args.seed,
        replicates: args.replicates,
        sampler: None,
    };
    pipeline::plan(loaded, &options)
}

/// The plan that a pilot fixes, if a target is given.
fn aim(args: &RenderArgs, loaded: &Loaded) -> Result<Option<Fixed>, target::Failure> {
    let error = args.error.map(Target::Error);
    let Some(aim) = error.or(args.time.map(Target::Seconds)) else {
        return Ok(None);
    };
    let plan = plan(args, loaded);
    let size = loaded.compiled.film.crop_size;
    let samples = u64::from(args.pilot) * u64::from(size.x) * u64::from(size.y);
    let bar = Bar::new(samples, args.quiet, &CANCELLED);
    let fixed = target::fix(loaded, &plan, aim, args.pilot, args.replicates, &bar);
    bar.finish();
    let fixed = fixed?;
    if !args.quiet {
        let Plan {
            replicates,
            samples_per_replicate,
            ..
        } = fixed.plan;
        note(format!(
            "after a pilot of {} samples per pixel ({:.2} s): {replicates} replicates of \
             {samples_per_replicate}, {} samples per pixel",
            fixed.pilot,
            fixed.seconds,
            u64::from(replicates) * u64::from(samples_per_replicate),
        ));
    }
    Ok(Some(fixed))
}

fn render(
    args: &RenderArgs,
    loaded: &Loaded,
    aimed: Option<&Fixed>,
) -> Result<Rendered, Diagnostic> {
    let mut plan = aimed.map_or_else(|| plan(args, loaded), |fixed| fixed.plan);
    let spp = u64::from(plan.replicates) * u64::from(plan.samples_per_replicate);
    let asked = u64::from(args.spp.unwrap_or(loaded.compiled.sampler.spp));
    if aimed.is_none() && spp != asked && !args.quiet {
        note(format!(
            "{spp} samples per pixel instead of {asked}: {} replicates of {}",
            plan.replicates, plan.samples_per_replicate
        ));
    }
    if let Some(part) = args.part {
        plan.share = Some(share(part, plan.replicates)?);
    }
    let size = loaded.compiled.film.crop_size;
    let here = u64::from(plan.share().count) * u64::from(plan.samples_per_replicate);
    let samples = here * u64::from(size.x) * u64::from(size.y);
    let bar = Bar::new(samples, args.quiet, &CANCELLED);
    let rendered = pipeline::render(loaded, &plan, &bar);
    bar.finish();
    rendered
}

/// The replicates of one part of many.
fn share(part: PartOfMany, replicates: u32) -> Result<Share, Diagnostic> {
    let PartOfMany { number, count } = part;
    Share::of(replicates, number - 1, count).ok_or_else(|| {
        let message = format!(
            "`--part {number}/{count}`: {replicates} replicates cannot be dealt to {count} parts"
        );
        Diagnostic::error_nowhere(message).help(format!(
            "every part renders one replicate at least: split into {replicates} parts at most, or \
             ask for more with `--replicates {count}` (the same for every part)"
        ))
    })
}

/// Writes the image and the statistics, and says how it went.
fn deliver(
    args: &RenderArgs,
    loaded: &Loaded,
    rendered: &Rendered,
    aimed: Option<&Fixed>,
) -> Result<(), String> {
    let losses = match &rendered.part {
        Some(part) => part
            .write_exr(args.output())
            .map(|()| Losses::default())
            .map_err(|error| error.to_string()),
        None => write_image(args.output(), &rendered.developed),
    }?;
    if !args.quiet {
        losses_in_words(&losses).iter().for_each(note);
    }
    if let Some(path) = &args.stats {
        let text = format!("{:#}\n", stats(args, loaded, rendered, aimed));
        write_atomically(path, |file| file.write_all(text.as_bytes()))
            .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    }
    let metadata = rendered.developed.metadata.as_ref();
    let faults = metadata.map_or(0, |m| m.faults.total());
    if faults > 0 {
        say::remark(&format!(
            "warning: {faults} contributions were not finite; see `etalon info`\n"
        ));
        let first = metadata.iter().flat_map(|m| &m.faults.first);
        let plan = aimed.map_or_else(|| plan(args, loaded), |fixed| fixed.plan);
        if let Some(command) = first.filter_map(|o| replay::command(args, &plan, o)).next() {
            say::remark(&format!("look at the first of them with\n  {command}\n"));
        }
    }
    if let Some(aim) = args.error {
        match relative_error(rendered) {
            Some(error) if error <= aim && !args.quiet => say::remark(&format!(
                "relative standard error {:.3} %, of {} % aimed at\n",
                100.0 * error,
                100.0 * aim
            )),
            Some(error) if error <= aim => {}
            Some(error) => say::remark(&format!(
                "warning: the target is missed: relative standard error {:.3} % instead of {} %\n",
                100.0 * error,
                100.0 * aim
            )),
            None => say::remark("warning: whether the target is reached is unknown\n"),
        }
    }
    if !args.quiet {
        let seconds = rendered.time.as_secs_f64();
        let per_second = |n: u64| n as f64 * 1e-6 / seconds;
        let error = match rendered.developed.mean_relative_standard_error() {
            Some(error) => format!("mean relative standard error {:.2} %", 100.0 * error),
            None => "no standard error (one replicate)".to_owned(),
        };
        let stopped = match rendered.outcome.replicates {
            done if done < rendered.replicates => {
                format!(
                    "stopped after {done} of {} replicates, ",
                    rendered.replicates
                )
            }
            _ => String::new(),
        };
        say::remark(&format!(
            "{}: {stopped}{seconds:.2} s, {:.2} M samples/s, {:.2} M rays/s, {error}\n",
            args.output().display(),
            per_second(rendered.outcome.samples),
            per_second(rendered.outcome.rays),
        ));
    }
    Ok(())
}

/// The relative standard error that `--error` is about.
fn relative_error(rendered: &Rendered) -> Option<f64> {
    Noise::of(&rendered.developed)?.relative()
}

/// Writes an EXR with everything, or the colours alone in a simpler format.
fn write_image(path: &Path, developed: &Developed) -> Result<Losses, String> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("pfm") => pfm::write(path, &developed.image).map(|()| Losses::default()),
        Some("hdr" | "rgbe") => hdr::write(path, &developed.image),
        _ => developed.write_exr(path).map(|()| Losses::default()),
    }
    .map_err(|error| error.to_string())
}

fn stats(
    args: &RenderArgs,
    loaded: &Loaded,
    rendered: &Rendered,
    aimed: Option<&Fixed>,
) -> serde_json::Value {
    let seconds = rendered.time.as_secs_f64();
    let metadata = rendered.developed.metadata.as_ref();
    serde_json::json!({
        "scene": args.scene.display().to_string(),
        "scene_hash": loaded.hash,
        "integrator": loaded.integrator_name,
        "load_seconds": loaded.load_time.as_secs_f64(),
        "build_seconds": loaded.build_time.as_secs_f64(),
        "render_seconds": seconds,
        "samples": rendered.outcome.samples,
        "rays": rendered.outcome.rays,
        "samples_per_second": rendered.outcome.samples as f64 / seconds,
        "rays_per_second": rendered.outcome.rays as f64 / seconds,
        "spp": metadata.map(|m| m.spp),
        "replicates": rendered.outcome.replicates,
        "part": metadata.and_then(|m| m.part.as_ref()),
        "mean_relative_standard_error": rendered.developed.mean_relative_standard_error(),
        "relative_standard_error": relative_error(rendered),
        "pilot_spp": aimed.map(|fixed| fixed.pilot),
        "pilot_seconds": aimed.map(|fixed| fixed.seconds),
        "non_finite": metadata.map(|m| m.faults.total()),
        "peak_memory_bytes": resources::peak_memory_bytes(),
        "threads": rayon::current_num_threads(),
        "seed": metadata.map(|m| m.seed),
    })
}
