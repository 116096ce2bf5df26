//! `etalon render`.

use super::sample_budget::{self, SampleBudget};
use super::{BAD_INPUT, delivery, fail, frames, note, replay, strategies};
use crate::args::RenderArgs;
use crate::outputs::Outputs;
use crate::preview::Onlookers;
use crate::progress::{Bar, Seen};
use crate::{diagnose, interrupt, say};
use etalon_images::Development;
use etalon_integrators::ReplicateRange;
use etalon_params::Diagnostic;
use etalon_render::checkpointing::Checkpointing;
use etalon_render::part::PartOfMany;
use etalon_render::pilot::Failure;
use etalon_render::pipeline::{self, LoadOptions, Loaded, RenderControls, Rendered};
use etalon_render::write_guard::WriteGuard;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::process::ExitCode;

/// Renders a scene to a file.
pub fn run(args: &RenderArgs) -> ExitCode {
    if let Err(message) = check_folders(args) {
        return fail(message);
    }
    let threads = args.threads.unwrap_or(0) as usize;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    match pool {
        // Everything happens on these threads: reading meshes and pictures, too.
        Ok(pool) => {
            let onlookers = match Onlookers::of(args) {
                Ok(onlookers) => onlookers,
                Err(message) => return fail(message),
            };
            let code = pool.install(|| match args.frames {
                Some(range) => frames::run(args, range, |args| run_here(args, &onlookers)),
                None => run_here(args, &onlookers),
            });
            onlookers.finish();
            code
        }
        Err(error) => fail(format!("cannot start threads: {error}")),
    }
}

/// Renders one picture on the current thread pool.
fn run_here(args: &RenderArgs, onlookers: &Onlookers) -> ExitCode {
    let (args, mut guard) = match with_outputs(args) {
        Ok(claimed) => claimed,
        Err(message) => return fail(message),
    };
    let args = &args;
    let mut loaded = match pipeline::load(
        &args.scene,
        &LoadOptions {
            defines: args.define.clone(),
            integrator: args.integrator.clone(),
            data: args.data.clone(),
            environment: args.environment.clone(),
            light_chooser: args.light_chooser,
            accelerator: args.accelerator.unwrap_or_default(),
            time: args.frame.map_or(0.0, |frame| frame.time),
            sensor: args.framing.sensor.clone(),
            framing: args.framing.framing(),
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
        let plan = sample_budget::plan(args, &loaded);
        return match sample_budget::counts(args, &loaded, &plan) {
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
    if let Err(message) = guard.reads(&loaded.inputs) {
        return fail(message);
    }
    if (args.frame.is_some() || args.part.is_some()) && args.resume {
        let plan = sample_budget::plan(args, &loaded);
        match sample_budget::is_finished(args, &loaded, &plan) {
            Ok(true) => {
                if !args.quiet {
                    note(format!("{} is there already", args.output().display()));
                }
                return ExitCode::SUCCESS;
            }
            Ok(false) => {}
            Err(diagnostic) => return give_up(diagnostic.into(), &loaded),
        }
    }
    if let Err(error) = interrupt::listen() {
        note(format!(
            "Ctrl-C will end the render without an image: {error}"
        ));
    }
    let amount = match sample_budget::decide(args, &loaded, interrupt::flag()) {
        Ok(amount) => amount,
        Err(failure) => return give_up(failure, &loaded),
    };
    let (plan, pilot) = (amount.plan, amount.pilot);
    let rendered = match render(args, &loaded, amount, onlookers) {
        Ok(rendered) => rendered,
        Err(diagnostic) => return give_up(diagnostic.into(), &loaded),
    };
    if !rendered.has_samples() {
        say::remark("stopped before the first sample, without an image\n");
        return ExitCode::from(interrupt::STOPPED);
    }
    onlookers.end(&rendered.developed);
    if let Err(message) = delivery::deliver(args, &loaded, &rendered, &plan, pilot) {
        return fail(message);
    }
    if args.resume && rendered.outcome.replicates == rendered.replicates {
        remove(&sample_budget::checkpoint(args));
    }
    if let Some((folder, integrator)) = techniques {
        let each = |loaded: &Loaded| {
            if interrupt::asked() {
                return Ok(None);
            }
            let amount = SampleBudget::plain(sample_budget::plan(args, loaded));
            let rendered = render(args, loaded, amount, onlookers)?;
            let whole = rendered.outcome.replicates == rendered.replicates;
            Ok(whole.then_some(rendered.developed))
        };
        match strategies::write(folder, args, &mut guard, &mut loaded, &integrator, each) {
            Ok(Ok(())) => {}
            Ok(Err(diagnostic)) => {
                diagnose::print(&[diagnostic], &loaded.sources);
                return ExitCode::from(BAD_INPUT);
            }
            Err(message) => return fail(message),
        }
    }
    if interrupt::asked() {
        return ExitCode::from(interrupt::STOPPED);
    }
    ExitCode::SUCCESS
}

/// Says why nothing is rendered.
fn give_up(failure: Failure, loaded: &Loaded) -> ExitCode {
    match failure {
        Failure::Cancelled => {
            say::remark("stopped during the pilot, without an image\n");
            ExitCode::from(interrupt::STOPPED)
        }
        Failure::Refused(diagnostic) => {
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

/// The arguments with their outputs resolved and claimed, unless a sample is replayed.
fn with_outputs(args: &RenderArgs) -> Result<(RenderArgs, WriteGuard), String> {
    let mut args = args.clone();
    let is_plain = args.shown.development()? == Development::default();
    if args.replay.is_some() {
        return Ok((args, WriteGuard::default()));
    }
    let outputs = Outputs::of(args.output.as_deref(), &args.scene, args.part)?;
    if !is_plain && outputs.picture.is_none() && args.preview.preview.is_none() {
        let message = "`--exposure` and `--view` are for pictures to look at: name one that ends in .png with `-o`";
        return Err(message.to_owned());
    }
    let guard = outputs.claim(&args.scene, args.stats.as_deref(), args.resume)?;
    if !args.quiet && !outputs.named {
        note(match &outputs.picture {
            Some(picture) => format!(
                "{} is a picture to look at; standard errors and all else are in {}",
                picture.display(),
                outputs.image.display()
            ),
            None => format!("without `-o` the image goes to {}", outputs.image.display()),
        });
    }
    args.outputs = Some(outputs);
    Ok((args, guard))
}

/// Refuses folders that are not there.
fn check_folders(args: &RenderArgs) -> Result<(), String> {
    match args.data.iter().find(|folder| !folder.is_dir()) {
        Some(folder) => Err(format!("there is no folder {}", folder.display())),
        None => Ok(()),
    }
}

/// Renders what was decided.
fn render(
    args: &RenderArgs,
    loaded: &Loaded,
    amount: SampleBudget,
    onlookers: &Onlookers,
) -> Result<Rendered, Diagnostic> {
    let mut plan = amount.plan;
    if let Some(part) = args.part {
        plan.share = Some(share(part, plan.replicates)?);
    }
    let keeping = args.resume.then(|| Checkpointing {
        path: sample_budget::checkpoint(args),
        facts: sample_budget::checkpoint_facts(args, amount.pilot),
        earlier: amount.earlier,
        failed: |reason| say::remark(&format!("warning: there is no checkpoint: {reason}\n")),
    });
    let size = loaded.compiled.film.crop_size;
    let finished = keeping.as_ref().map_or(0, |keeping| keeping.finished().0);
    let here = plan.share().count.saturating_sub(finished);
    let samples = u64::from(here) * u64::from(plan.samples_per_replicate);
    let begun = keeping.as_ref().map_or(0, Checkpointing::samples_begun);
    let samples = (samples * u64::from(size.x) * u64::from(size.y)).saturating_sub(begun);
    let name = args.frame.map_or_else(String::new, |frame| frame.label());
    onlookers.begin(&name, samples);
    let bar = Bar::new(samples, args.quiet, interrupt::flag()).named(name);
    let manner = RenderControls {
        counts: amount.counts,
        keeping,
        watcher: onlookers.watcher(),
        features: args.features,
    };
    let seen = Seen {
        bar: &bar,
        onlookers,
    };
    let rendered = pipeline::render_as(loaded, &plan, manner, &seen);
    bar.finish();
    rendered
}

/// The replicates of one part of many.
fn share(part: PartOfMany, replicates: u32) -> Result<ReplicateRange, Diagnostic> {
    let PartOfMany { number, count } = part;
    ReplicateRange::of(replicates, number - 1, count).ok_or_else(|| {
        let message = format!(
            "`--part {number}/{count}`: {replicates} replicates cannot be dealt to {count} parts"
        );
        Diagnostic::error_nowhere(message).help(format!(
            "every part renders one replicate at least: split into {replicates} parts at most, or \
             ask for more with `--replicates {count}` (the same for every part)"
        ))
    })
}
