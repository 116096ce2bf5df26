//! `cargo xtask calibrate`: shows that the validation's error rates are what they are said to be.

use etalon_images::write_atomically;
use etalon_validation::calibrate::null::{self, NullRuns};
use etalon_validation::calibrate::pool::Pool;
use etalon_validation::calibrate::single::{self, Single};
use etalon_validation::calibrate::verdict::{self, Promise};
use etalon_validation::calibrate::{CONFIDENCE, NULL_RUNS, REPETITIONS, page};
use etalon_validation::claim::Claim;
use etalon_validation::folders;
use etalon_validation::run::{self, Options, Task};
use etalon_validation::state::State;
use etalon_validation::tier::Tier;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// How much to calibrate.
#[derive(Clone, Debug, clap::Args)]
#[command(
    after_help = "Exit code: 0 if every promise is kept, 1 if one is not, 2 if it could not be made.\n\nExamples:\n  cargo xtask calibrate\n  cargo xtask calibrate --small --runs 200 --repetitions 100"
)]
pub(crate) struct Arguments {
    /// The comparisons and budgets of the default run, not of the thorough run
    #[arg(long)]
    small: bool,
    /// Only the claim of this name, or those whose names contain it, take part in the null runs
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
    /// Null runs of the whole decision
    #[arg(long, default_value_t = NULL_RUNS)]
    runs: u32,
    /// Repetitions of every single comparison between fresh renders
    #[arg(long, default_value_t = REPETITIONS)]
    repetitions: u32,
    /// The seed of everything
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Where to put the page and its JSON [default: target/calibration]
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
}

/// Runs the calibration.
pub(crate) fn run(arguments: &Arguments) -> ExitCode {
    match calibrate(arguments) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

fn calibrate(arguments: &Arguments) -> Result<bool, String> {
    let claims = Claim::read_named(&folders::claims(), arguments.only.as_deref())?;
    let options = Options {
        only: arguments.only.clone(),
        tier: if arguments.small {
            Tier::Default
        } else {
            Tier::Thorough
        },
        seed: arguments.seed,
        part: None,
    };
    let mut tasks = run::tasks(&claims, &options);
    tasks.retain(|task| task.fault.is_none());
    if tasks.is_empty() {
        return Err("there is nothing to compare: every comparison has a planted fault".to_owned());
    }
    let folder = arguments.report.clone();
    let folder = folder.unwrap_or_else(|| folders::root().join("target/calibration"));
    let state = State::open(&folder.join(options.tier.name()), &options)?;
    let start = Instant::now();
    let pools = pools(&tasks, &options, &state)?;
    progress_ends();
    println!(
        "replicates of {} comparisons in {:.0} s",
        tasks.len(),
        start.elapsed().as_secs_f64()
    );
    let confidence = verdict::confidence_of_each(single::SETTINGS.len());
    let start = Instant::now();
    let runs = (arguments.runs, arguments.seed);
    let null = null::run(&tasks, &pools, options.tier, runs, CONFIDENCE, |done| {
        progress(
            &format!("null run {done} of {}", arguments.runs),
            start,
            done,
            arguments.runs,
        );
    })?;
    progress_ends();
    println!(
        "{} null runs in {:.0} s",
        arguments.runs,
        start.elapsed().as_secs_f64()
    );
    let mut singles = Vec::new();
    for setting in &single::SETTINGS {
        let start = Instant::now();
        let repeated = (arguments.repetitions, arguments.seed);
        singles.extend(single::repeat(
            setting,
            &claims,
            repeated,
            confidence,
            |done| {
                let name = format!("{}, {done} of {}", setting.claim, arguments.repetitions);
                progress(&name, start, done, arguments.repetitions);
            },
        )?);
        progress_ends();
        println!(
            "{} repetitions of {} in {:.0} s",
            arguments.repetitions,
            setting.claim,
            start.elapsed().as_secs_f64()
        );
    }
    let mut promises = verdict::of_null_runs(&null);
    for single in &singles {
        promises.extend(verdict::of_single(single, confidence));
    }
    tell(&tasks, &null, &singles, &promises);
    let json = verdict::json(&tasks, &null, &singles, &promises);
    write(&folder.join("calibration.json"), &format!("{json:#}\n"))?;
    let html = folder.join("calibration.html");
    write(&html, &page::page(&tasks, &null, &singles, &promises))?;
    println!("report: {}", html.display());
    Ok(promises.iter().all(|promise| promise.holds))
}

/// Renders the replicates that are dealt from, or takes up those of an earlier run of this build.
fn pools(tasks: &[Task<'_>], options: &Options, state: &State) -> Result<Vec<Pool>, String> {
    let start = Instant::now();
    let total = tasks.len() as u32;
    (tasks.iter().zip(0..))
        .map(|(task, done)| {
            let name = format!("{} {}", task.claim.name, task.label());
            progress(&name, start, done, total);
            Pool::render(*task, options.tier, options.seed, state)
                .map_err(|message| format!("{name}: {message}"))
        })
        .collect()
}

fn tell(tasks: &[Task<'_>], null: &NullRuns, singles: &[Single], promises: &[Promise]) {
    println!();
    for promise in promises {
        let kept = if promise.holds { "kept" } else { "BROKEN" };
        println!("{kept:<7} {}: {}", promise.what, promise.seen);
    }
    println!(
        "\nshare of p-values at most        1e-1      1e-2      1e-3      1e-4      1e-5   of"
    );
    let questions = null.p_values.iter();
    let questions = questions.map(|(question, p)| (question.to_string(), p));
    let fresh = singles.iter().map(|s| (s.name.clone(), &s.p_values));
    for (name, p_values) in questions.chain(fresh) {
        let rates = verdict::decades(p_values);
        let rates = rates.iter().skip(1);
        let shares: String = rates
            .map(|rate| format!("{:>10.1e}", rate.observed()))
            .collect();
        println!("{name:<26}{shares}   {}", p_values.len());
    }
    println!("\n{} null runs left something undecided", null.undecided);
    for (task, counts) in tasks.iter().zip(&null.comparisons) {
        if counts.failed + counts.undecided + counts.broken > 0 {
            println!(
                "{:<26} {:<30} {} alarms, {} undecided, {} broken",
                task.claim.name,
                task.label(),
                counts.failed,
                counts.undecided,
                counts.broken
            );
        }
    }
}

/// Says how far the work is, on one line of a terminal.
fn progress(what: &str, start: Instant, done: u32, total: u32) {
    if !std::io::stderr().is_terminal() {
        return;
    }
    let spent = start.elapsed().as_secs_f64();
    let left = match done {
        0 => String::new(),
        done => {
            let left = spent * f64::from(total - done) / f64::from(done);
            format!(", about {left:.0} s left")
        }
    };
    eprint!("\r\x1b[K{what} (after {spent:.0} s{left})\r");
}

/// Clears the line of progress.
fn progress_ends() {
    if std::io::stderr().is_terminal() {
        eprint!("\r\x1b[K");
    }
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    write_atomically(path, |file| file.write_all(text.as_bytes()))
        .map_err(|e| format!("{}: {e}", path.display()))
}
