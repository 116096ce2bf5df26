//! `etalon estimators`.

use super::{BAD_INPUT, answer, fail};
use crate::args::EstimatorsArgs;
use crate::progress::Bar;
use crate::{diagnose, quoting};
use etalon_render::estimators::{Failure, Findings, Options, Trial, page, table};
use etalon_render::pipeline::LoadOptions;
use etalon_render::write_guard::{Destination, WriteGuard};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::AtomicBool;

/// Never set: Ctrl-C ends a comparison at once, which leaves nothing behind.
static CANCELLED: AtomicBool = AtomicBool::new(false);

/// Compares estimators.
pub fn run(args: &EstimatorsArgs) -> ExitCode {
    let folders = args.data.iter();
    if let Some(folder) = folders.into_iter().find(|folder| !folder.is_dir()) {
        return fail(format!("there is no folder {}", folder.display()));
    }
    let files = match Files::claim(args) {
        Ok(files) => files,
        Err(message) => return fail(message),
    };
    let threads = args.threads.unwrap_or(0) as usize;
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool.install(|| run_here(args, files)),
        Err(error) => fail(format!("cannot start threads: {error}")),
    }
}

/// What is written.
struct Files {
    guard: WriteGuard,
    report: Option<Destination>,
    json: Option<Destination>,
}

impl Files {
    fn claim(args: &EstimatorsArgs) -> Result<Self, String> {
        let mut guard = WriteGuard::of([&args.scene].into_iter().chain(&args.reference));
        let mut claim =
            |path: &Option<PathBuf>| path.as_deref().map(|path| guard.claim(path)).transpose();
        let (report, json) = (claim(&args.report)?, claim(&args.json)?);
        Ok(Self {
            guard,
            report,
            json,
        })
    }
}

/// Compares on the current thread pool.
fn run_here(args: &EstimatorsArgs, mut files: Files) -> ExitCode {
    let findings = match measure(args, &mut files.guard) {
        Ok(findings) => findings,
        Err(Failure::Refused(refusal)) => {
            diagnose::print(&refusal.diagnostics, &refusal.sources);
            return ExitCode::from(BAD_INPUT);
        }
        Err(failure) => return fail(failure),
    };
    let report = files.report.map_or(Ok(()), |file| {
        file.write_text(&page::page(&findings, &command(args)))
    });
    let written = report.and_then(|()| match &files.json {
        Some(file) => file.write_text(&format!("{:#}\n", serde_json::json!(findings))),
        None => Ok(()),
    });
    if let Err(message) = written {
        return fail(message);
    }
    answer(&table::text(&findings), ExitCode::SUCCESS)
}

fn measure(args: &EstimatorsArgs, guard: &mut WriteGuard) -> Result<Findings, Failure> {
    let options = Options {
        load: LoadOptions {
            defines: args.define.clone(),
            data: args.data.clone(),
            environment: args.environment.clone(),
            ..LoadOptions::default()
        },
        integrators: args.integrators.clone(),
        samplers: args.samplers.clone(),
        filters: args.filters.clone(),
        light_choosers: args.light_choosers.clone(),
        seconds: args.time,
        reference: args.reference.clone(),
        reference_share: args.reference_share,
        picture_seconds: args.picture_time,
        seed: args.seed,
    };
    let trial = Trial::prepare(&args.scene, &options)?;
    guard.reads(&trial.scene().inputs)?;
    if !args.quiet {
        diagnose::print(&trial.scene().notes, &trial.scene().sources);
    }
    let bar = Bar::new(trial.samples(), args.quiet, &CANCELLED);
    let findings = trial.run(&bar);
    bar.finish();
    findings
}

/// The command line that measures the same again.
fn command(args: &EstimatorsArgs) -> String {
    let mut words = vec![
        "etalon estimators".to_owned(),
        quoting::shell(&args.scene.display().to_string()),
    ];
    let choosers: Vec<String> = (args.light_choosers.iter())
        .map(|chooser| chooser.name().to_owned())
        .collect();
    let lists = [
        ("--integrators", &args.integrators),
        ("--samplers", &args.samplers),
        ("--filters", &args.filters),
        ("--light-choosers", &choosers),
    ];
    for (option, names) in lists.into_iter().filter(|(_, names)| !names.is_empty()) {
        words.push(format!("{option} {}", quoting::shell(&names.join(","))));
    }
    for (key, value) in &args.define {
        words.push(format!("-D {}", quoting::shell(&format!("{key}={value}"))));
    }
    for folder in &args.data {
        words.push(format!(
            "--data {}",
            quoting::shell(&folder.display().to_string())
        ));
    }
    match &args.reference {
        Some(path) => words.push(format!(
            "--reference {}",
            quoting::shell(&path.display().to_string())
        )),
        None => words.push(format!("--reference-share {}", args.reference_share)),
    }
    if let Some(length) = args.picture_time {
        words.push(format!("--picture-time {length}"));
    }
    words.push(format!("--time {} --seed {}", args.time, args.seed));
    if let Some(threads) = args.threads {
        words.push(format!("--threads {threads}"));
    }
    words.join(" ")
}
