//! `etalon render`.

use super::amount::{self, Amount};
use super::{BAD_INPUT, delivery, fail, note, replay, strategies};
use crate::args::RenderArgs;
use crate::keeping::Keeping;
use crate::part::PartOfMany;
use crate::pipeline::{self, LoadOptions, Loaded, Manner, Rendered};
use crate::progress::Bar;
use crate::{diagnose, say, target};
use etalon_integrators::Share;
use etalon_params::Diagnostic;
use std::fmt::Display;
use std::fs::{self, OpenOptions};
use std::io::ErrorKind;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

/// Set by Ctrl-C: finish the replicate, write the image, stop.
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
        let plan = amount::plan(args, &loaded);
        return match amount::counts(args, &loaded, &plan) {
            Ok(counts) => replay::run(&loaded, &plan, counts, address),
            Err(failure) => give_up(failure, &loaded),
        };
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
    let amount = match amount::decide(args, &loaded, &CANCELLED) {
        Ok(amount) => amount,
        Err(failure) => return give_up(failure, &loaded),
    };
    let (plan, pilot) = (amount.plan, amount.pilot);
    let rendered = match render(args, &loaded, amount) {
        Ok(rendered) => rendered,
        Err(diagnostic) => return give_up(diagnostic.into(), &loaded),
    };
    if let Err(message) = delivery::deliver(args, &loaded, &rendered, &plan, pilot) {
        return fail(message);
    }
    if args.resume && rendered.outcome.replicates == rendered.replicates {
        remove(&amount::checkpoint(args));
    }
    if let Some((folder, integrator)) = techniques {
        let each = |loaded: &Loaded| {
            let amount = Amount::plain(amount::plan(args, loaded));
            Ok(render(args, loaded, amount)?.developed)
        };
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

/// Says why nothing is rendered.
fn give_up(failure: target::Failure, loaded: &Loaded) -> ExitCode {
    match failure {
        target::Failure::Cancelled => {
            say::remark("stopped during the pilot, without an image\n");
            ExitCode::from(INTERRUPTED)
        }
        target::Failure::Refused(diagnostic) => {
            diagnose::print(&[diagnostic], &loaded.sources);
            ExitCode::from(BAD_INPUT)
        }
    }
}

/// Removes the checkpoint of an image that is finished.
fn remove(checkpoint: &Path) {
    match fs::remove_file(checkpoint) {
        Err(error) if error.kind() != ErrorKind::NotFound => say::remark(&format!(
            "warning: {} could not be removed: {error}\n",
            checkpoint.display()
        )),
        _ => {}
    }
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
    // The file that a symbolic link names is made where it leads.
    let path = match etalon_images::atomic_file::target(path) {
        Ok(target) => target,
        Err(error) => return refuse(&error),
    };
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

/// Renders what was decided.
fn render(args: &RenderArgs, loaded: &Loaded, amount: Amount) -> Result<Rendered, Diagnostic> {
    let mut plan = amount.plan;
    if let Some(part) = args.part {
        plan.share = Some(share(part, plan.replicates)?);
    }
    let keeping = args.resume.then(|| Keeping {
        path: amount::checkpoint(args),
        facts: amount::checkpoint_facts(args, amount.pilot),
        earlier: amount.earlier,
    });
    let size = loaded.compiled.film.crop_size;
    let finished = keeping.as_ref().map_or(0, |keeping| keeping.finished().0);
    let here = plan.share().count.saturating_sub(finished);
    let samples = u64::from(here) * u64::from(plan.samples_per_replicate);
    let samples = samples * u64::from(size.x) * u64::from(size.y);
    let bar = Bar::new(samples, args.quiet, &CANCELLED);
    let manner = Manner {
        counts: amount.counts,
        keeping,
    };
    let rendered = pipeline::render_as(loaded, &plan, manner, &bar);
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
