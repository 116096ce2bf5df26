//! `etalon estimators`.

use super::{BAD_INPUT, answer, fail};
use crate::args::EstimatorsArgs;
use crate::diagnose;
use crate::estimators::{Failure, Findings, Options, Trial, page, table};
use crate::outputs::check_place;
use crate::pipeline::LoadOptions;
use crate::progress::Bar;
use etalon_images::write_atomically;
use std::io::Write;
use std::path::Path;
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
    let mut places = [&args.report, &args.json].into_iter().flatten();
    if let Err(message) = places.try_for_each(|path| check_place(path)) {
        return fail(message);
    }
    let threads = args.threads.unwrap_or(0) as usize;
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool.install(|| run_here(args)),
        Err(error) => fail(format!("cannot start threads: {error}")),
    }
}

/// Compares on the current thread pool.
fn run_here(args: &EstimatorsArgs) -> ExitCode {
    let findings = match measure(args) {
        Ok(findings) => findings,
        Err(Failure::Refused(refusal)) => {
            diagnose::print(&refusal.diagnostics, &refusal.sources);
            return ExitCode::from(BAD_INPUT);
        }
        Err(failure) => return fail(failure),
    };
    let written = args
        .report
        .as_ref()
        .map_or(Ok(()), |path| {
            write(path, &page::page(&findings, &command(args)))
        })
        .and_then(|()| match &args.json {
            Some(path) => write(path, &format!("{:#}\n", serde_json::json!(findings))),
            None => Ok(()),
        });
    if let Err(message) = written {
        return fail(message);
    }
    answer(&table::text(&findings), ExitCode::SUCCESS)
}

fn measure(args: &EstimatorsArgs) -> Result<Findings, Failure> {
    let options = Options {
        load: LoadOptions {
            defines: args.define.clone(),
            data: args.data.clone(),
            ..LoadOptions::default()
        },
        integrators: args.integrators.clone(),
        samplers: args.samplers.clone(),
        filters: args.filters.clone(),
        light_choosers: args.light_choosers.clone(),
        seconds: args.time,
        reference: args.reference.clone(),
        reference_share: args.reference_share,
        seed: args.seed,
    };
    let trial = Trial::prepare(&args.scene, &options)?;
    if !args.quiet {
        diagnose::print(&trial.scene().notes, &trial.scene().sources);
    }
    let bar = Bar::new(trial.samples(), args.quiet, &CANCELLED);
    let findings = trial.run(&bar);
    bar.finish();
    findings
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    write_atomically(path, |file| file.write_all(text.as_bytes()))
        .map_err(|error| format!("cannot write {}: {error}", path.display()))
}

/// The command line that measures the same again.
fn command(args: &EstimatorsArgs) -> String {
    let mut words = vec![
        "etalon estimators".to_owned(),
        quoted(&args.scene.display().to_string()),
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
        words.push(format!("{option} {}", quoted(&names.join(","))));
    }
    for (key, value) in &args.define {
        words.push(format!("-D {}", quoted(&format!("{key}={value}"))));
    }
    for folder in &args.data {
        words.push(format!("--data {}", quoted(&folder.display().to_string())));
    }
    match &args.reference {
        Some(path) => words.push(format!(
            "--reference {}",
            quoted(&path.display().to_string())
        )),
        None => words.push(format!("--reference-share {}", args.reference_share)),
    }
    words.push(format!("--time {} --seed {}", args.time, args.seed));
    if let Some(threads) = args.threads {
        words.push(format!("--threads {threads}"));
    }
    words.join(" ")
}

/// A word as a shell would take it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,=:+".contains(c);
    match !word.is_empty() && word.chars().all(plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    }
}
