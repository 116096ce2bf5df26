//! `cargo xtask validate`: renders every claim, decides it, and reports.

use etalon_validation::claim::Claim;
use etalon_validation::outcome::{self, Outcome};
use etalon_validation::run::{self, Options};
use etalon_validation::{folders, html, table};
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// What to validate.
#[derive(Clone, Debug, clap::Args)]
#[command(
    after_help = "Exit code: 0 if every claim holds, 1 if any does not or is undecided, 2 if the run could not start.\n\nExamples:\n  cargo xtask validate --quick\n  cargo xtask validate --only irradiance --seed 7\n  cargo xtask validate --list"
)]
pub(crate) struct Arguments {
    /// Small budgets: two minutes on two cores
    #[arg(long)]
    quick: bool,
    /// Only the claims whose names contain this
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
    /// The seed of all pictures
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Say which claims there are, and render nothing
    #[arg(long)]
    list: bool,
    /// Where to put the report and its JSON [default: target/validation]
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
}

/// Runs the validation.
pub(crate) fn run(arguments: &Arguments) -> ExitCode {
    match validate(arguments) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

fn validate(arguments: &Arguments) -> Result<bool, String> {
    let claims = Claim::read_all(&folders::claims())?;
    if arguments.list {
        for claim in &claims {
            println!("{:<26} {}", claim.name, claim.title);
        }
        return Ok(true);
    }
    let options = Options {
        only: arguments.only.clone(),
        quick: arguments.quick,
        seed: arguments.seed,
    };
    let tasks = run::tasks(&claims, &options);
    if tasks.is_empty() {
        return Err("no claim has such a name: see `cargo xtask validate --list`".to_owned());
    }
    let start = Instant::now();
    let alpha = outcome::ALPHA / tasks.len() as f64;
    let count = tasks.len();
    let mut compared = Vec::with_capacity(count);
    for (index, task) in tasks.into_iter().enumerate() {
        if std::io::stderr().is_terminal() {
            eprint!("\r\x1b[K{} of {count}: {}\r", index + 1, task.claim.name);
        }
        compared.push((task, run::compare(&task, &options, alpha)));
    }
    let rows = outcome::decide(compared);
    let seconds = start.elapsed().as_secs_f64();

    let mut text = table::head() + "\n";
    for row in &rows {
        text += &table::line(row);
        text += "\n";
    }
    text += &table::summary(&rows, seconds);
    text += "\n";
    // Whoever reads may stop reading; the report is written all the same.
    let _ = std::io::stdout().write_all(text.as_bytes());
    let folder = arguments.report.clone().unwrap_or_else(folders::report);
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let page = folder.join("report.html");
    write(&page, &html::page(&rows, options.seed, seconds))?;
    let json = table::to_json(&rows, options.seed, options.quick);
    write(&folder.join("report.json"), &format!("{json:#}\n"))?;
    let _ = writeln!(std::io::stdout(), "report: {}", page.display());
    Ok(rows.iter().all(|row| row.outcome == Outcome::Passed))
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|e| format!("{}: {e}", path.display()))
}
