//! `etalon farm`.

use super::{BAD_INPUT, fail, note, options, sample_budget};
use crate::args::{FarmArgs, RenderArgs};
use crate::farm::{Engine, Job, Work};
use crate::{diagnose, quoting, say};
use etalon_render::pipeline::{self, LoadOptions};
use etalon_render::write_guard::WriteGuard;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Writes the job files.
pub fn run(args: &FarmArgs) -> ExitCode {
    if let Err(message) = check(&args.render) {
        return fail(message);
    }
    let render = &args.render;
    // Mistakes are found here, not by every task.
    let loaded = pipeline::load(
        &render.scene,
        &LoadOptions {
            defines: render.define.clone(),
            integrator: render.integrator.clone(),
            data: render.data.clone(),
            environment: render.environment.clone(),
            light_chooser: render.light_chooser,
            accelerator: render.accelerator.unwrap_or_default(),
            time: 0.0,
            sensor: render.framing.sensor.clone(),
            framing: render.framing.framing(),
        },
    );
    let loaded = match loaded {
        Ok(loaded) => loaded,
        Err(refusal) => {
            diagnose::print(&refusal.diagnostics, &refusal.sources);
            return ExitCode::from(BAD_INPUT);
        }
    };
    let replicates = sample_budget::plan(render, &loaded).replicates;
    let work = match render.frames {
        Some(range) => Work::Frames {
            first: range.first,
            last: range.last,
        },
        None => Work::Parts(args.parts.unwrap_or(replicates)),
    };
    if let Work::Parts(parts) = work
        && parts > replicates
    {
        return fail(format!(
            "{replicates} replicates cannot be dealt to {parts} parts: ask for {replicates} parts at most, or for more replicates \
             with `--replicates {parts}`"
        ));
    }
    match write(args, work, &loaded.inputs) {
        Ok(job) => hand_over(args, &job),
        Err(message) => fail(message),
    }
}

/// Refuses what a task has by itself, or cannot have.
fn check(args: &RenderArgs) -> Result<(), String> {
    let refused = [
        ("--part", args.part.is_some()),
        ("--resume", args.resume),
        ("--replay", args.replay.is_some()),
        ("--strategies", args.strategies.is_some()),
        ("--features", args.features),
        ("--stats", args.stats.is_some()),
        ("--preview", args.preview.preview.is_some()),
        ("--tev", args.preview.tev.is_some()),
        ("--time", args.time.is_some() && args.frames.is_none()),
        ("--error", args.error.is_some() && args.frames.is_none()),
    ];
    if let Some((name, _)) = refused.iter().find(|(_, given)| *given) {
        return Err(format!(
            "`{name}` has no place in a render that is dealt to tasks"
        ));
    }
    let Some(folder) = &args.output else {
        return Err("a folder for the job files is missing: -o DIR".to_owned());
    };
    match folder.is_file() {
        true => Err(format!(
            "{} is a file, and a folder is wanted",
            folder.display()
        )),
        false => Ok(()),
    }
}

/// A path that holds wherever a task is started.
fn absolute(path: &Path) -> Result<PathBuf, String> {
    fs::canonicalize(path).map_err(|error| format!("cannot find {}: {error}", path.display()))
}

/// Writes the files of a job.
fn write(args: &FarmArgs, work: Work, inputs: &[PathBuf]) -> Result<Job, String> {
    let render = &args.render;
    let folder = render.output.clone().unwrap_or_default();
    for name in ["log", "parts", "frames"] {
        let unused = (name == "parts") != matches!(work, Work::Parts(_)) && name != "log";
        if !unused {
            let folder = folder.join(name);
            let failed = |error| format!("cannot make {}: {error}", folder.display());
            fs::create_dir_all(&folder).map_err(failed)?;
        }
    }
    // Where the cluster has it: by the first map that knows the folder.
    let seen = |path: PathBuf| {
        args.map
            .iter()
            .find_map(|map| map.seen(&path))
            .unwrap_or(path)
    };
    let data: Result<Vec<PathBuf>, String> = (render.data.iter())
        .map(|path| absolute(path).map(seen))
        .collect();
    let environment = render.environment.as_deref().map(absolute).transpose()?;
    let render = RenderArgs {
        data: data?,
        environment: environment.map(seen),
        ..render.clone()
    };
    let mut words = options::of(&render);
    words.extend(render.frames.map(|_| format!("--fps {}", render.fps)));
    let scene = absolute(&render.scene)?;
    let stem = scene
        .file_stem()
        .map(|stem| stem.to_string_lossy().into_owned());
    // A scene called `scene.xml` has the name of its folder.
    let name = match stem.as_deref() {
        Some("scene") => scene
            .parent()
            .and_then(Path::file_name)
            .map(|n| n.to_string_lossy().into_owned()),
        _ => stem,
    };
    let program = match &args.program {
        Some(program) => program.clone(),
        None => {
            let here = std::env::current_exe();
            seen(here.map_err(|error| format!("cannot find this program: {error}"))?)
        }
    };
    let here = absolute(&folder)?;
    let job = Job {
        engine: args.engine,
        work,
        name: name.unwrap_or_else(|| "image".to_owned()),
        program,
        scene: seen(scene),
        folder: seen(here.clone()),
        options: words.iter().map(|word| format!(" {word}")).collect(),
    };
    let mut guard = WriteGuard::of(inputs);
    for (name, text) in job.files() {
        guard.claim(&here.join(name))?.write_text(&text)?;
    }
    tell_stale(&job, &here);
    Ok(job)
}

/// Names the pictures in a job's folder that are not of this job, which the job leaves out.
fn tell_stale(job: &Job, here: &Path) {
    let folder = here.join(job.pieces_folder());
    let entries = fs::read_dir(&folder).into_iter().flatten().flatten();
    let names: Vec<String> = entries
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    let mut stale = job.stale(&names);
    stale.sort_unstable();
    if let [first, others @ ..] = stale.as_slice() {
        let more = match others {
            [] => String::new(),
            [.., last] => format!(" and {} more, to {last}", others.len()),
        };
        note(format!(
            "{}{more}: of another job, and left out of this one",
            folder.join(first).display()
        ));
    }
}

/// Says how to submit a job, or does.
fn hand_over(args: &FarmArgs, job: &Job) -> ExitCode {
    let script = job.folder.join("submit.sh");
    let command = format!("sh {}", quoting::shell(&script.display().to_string()));
    if !args.submit {
        let what = match job.work {
            Work::Parts(_) => "parts",
            Work::Frames { .. } => "frames",
        };
        if !args.render.quiet {
            note(format!(
                "{} {what} in {}; submit them with",
                job.work.count(),
                job.folder.display()
            ));
        }
        return super::answer(&format!("{command}\n"), ExitCode::SUCCESS);
    }
    let needed = match job.engine {
        Engine::Slurm => "sbatch",
        Engine::Openjd => "openjd",
        Engine::Parallel => "parallel",
    };
    match Command::new("sh").arg(&script).status() {
        Ok(status) if status.success() => ExitCode::SUCCESS,
        Ok(status) => fail(format!(
            "`{command}` failed ({status}); it needs `{needed}`, and may be run again: finished parts stay"
        )),
        Err(error) => {
            say::remark(&format!("error: cannot run `{command}`: {error}\n"));
            ExitCode::from(BAD_INPUT)
        }
    }
}
