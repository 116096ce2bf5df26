//! `cargo xtask validate`: renders every claim, decides it, and reports.

use etalon_images::write_atomically;
use etalon_render::part::PartOfMany;
use etalon_validation::claim::Claim;
use etalon_validation::json::{self, Provenance};
use etalon_validation::outcome::{self, Conclusion, Outcome, Progress};
use etalon_validation::run::{self, Options, Task};
use etalon_validation::state::State;
use etalon_validation::tier::Tier;
use etalon_validation::{folders, html, table};
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// What to validate.
#[derive(Clone, Debug, clap::Args)]
#[command(
    after_help = "Exit code: 0 if every claim holds, 1 if any does not, 2 if the run or a comparison could not be made, 3 if anything is undecided.\n\nExamples:\n  cargo xtask validate\n  cargo xtask validate --only irradiance --seed 7\n  cargo xtask validate --thorough\n  cargo xtask validate --full\n  cargo xtask validate --full --part 1/3   # and 2/3, 3/3 on other machines or days\n  cargo xtask validate --json\n  cargo xtask validate --list"
)]
pub(crate) struct Arguments {
    /// All rows that minutes can decide, the agreement of all integrators included: about a quarter
    /// of an hour on two cores
    #[arg(long, conflicts_with = "full")]
    thorough: bool,
    /// Go on until every bias is bounded below 0.5 %: hours; goes on where it was interrupted
    #[arg(long)]
    full: bool,
    /// Part I of N of a full run, decided as part of the whole: all claims hold if they do in every
    /// part
    #[arg(long, value_name = "I/N", requires = "full", conflicts_with = "list")]
    part: Option<PartOfMany>,
    /// Only the claim of this name or, if there is none, those whose names contain it
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
    /// The seed of all pictures
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Say which claims there are, and render nothing
    #[arg(long)]
    list: bool,
    /// Where to put the report and its JSON [default: target/validation; of parts, a folder each in
    /// it]
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    /// Write the decision as JSON to this file, or to standard output (the table then goes to
    /// standard error)
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "-")]
    json: Option<PathBuf>,
}

impl Arguments {
    /// Whether standard output is for JSON.
    fn json_to_stdout(&self) -> bool {
        self.json.as_deref() == Some(Path::new("-"))
    }

    /// Prints a line. A closed pipe is ignored; the reports are written all the same.
    fn say(&self, text: &str) {
        let _ = if self.json_to_stdout() {
            writeln!(std::io::stderr(), "{text}")
        } else {
            writeln!(std::io::stdout(), "{text}")
        };
    }

    /// Sees, before anything is rendered, whether there is a place for the report in `folder` and for
    /// JSON.
    fn check_paths(&self, folder: &Path) -> Result<(), String> {
        if let Some(path) = self.json.as_deref().filter(|_| !self.json_to_stdout()) {
            let parent = path.parent().filter(|p| !p.as_os_str().is_empty());
            if path.is_dir() || parent.is_some_and(|parent| !parent.is_dir()) {
                let reason = if path.is_dir() {
                    "it is a folder"
                } else {
                    "there is no such folder"
                };
                return Err(format!("--json {}: {reason}", path.display()));
            }
        }
        if !self.list {
            std::fs::create_dir_all(folder)
                .map_err(|e| format!("--report {}: {e}", folder.display()))?;
        }
        Ok(())
    }

    /// Writes JSON where it was asked for.
    fn write_json(&self, text: &str) -> Result<(), String> {
        match &self.json {
            Some(_) if self.json_to_stdout() => {
                let _ = std::io::stdout().write_all(text.as_bytes());
                Ok(())
            }
            Some(path) => write(path, text),
            None => Ok(()),
        }
    }
}

/// Runs the validation.
pub(crate) fn run(arguments: &Arguments) -> ExitCode {
    match validate(arguments) {
        Ok(conclusion) => ExitCode::from(conclusion.exit_code()),
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(Conclusion::Broken.exit_code())
        }
    }
}

fn validate(arguments: &Arguments) -> Result<Conclusion, String> {
    let folder = arguments.report.clone().unwrap_or_else(|| {
        let whole = folders::report();
        match arguments.part {
            Some(part) => whole.join(format!("part-{}-of-{}", part.number, part.count)),
            None => whole,
        }
    });
    arguments.check_paths(&folder)?;
    let claims = Claim::read_named(&folders::claims(), arguments.only.as_deref())?;
    if arguments.list {
        for claim in &claims {
            arguments.say(&format!(
                "{:<28} {:<12} {}",
                claim.name,
                claim.oracle.kind(),
                claim.title
            ));
        }
        arguments.write_json(&format!("{:#}\n", json::list(&claims)))?;
        return Ok(Conclusion::Passed);
    }
    let options = Options {
        only: arguments.only.clone(),
        tier: match (arguments.thorough, arguments.full) {
            (true, _) => Tier::Thorough,
            (_, true) => Tier::Full,
            _ => Tier::Default,
        },
        seed: arguments.seed,
        part: arguments.part,
    };
    let tasks = run::tasks(&claims, &options);
    let plan = run::RunPlan::of(&tasks, &options);
    if let Some(part) = options.part
        && tasks.iter().all(|task| task.elsewhere)
    {
        return Err(format!("--part {part}: there are fewer claims than parts"));
    }
    let state = match options.tier {
        Tier::Full => Some(State::open(&folders::report().join("full"), &options)?),
        Tier::Default | Tier::Thorough => None,
    };
    if let Some(kept) = state.as_ref().map(State::len).filter(|kept| *kept > 0) {
        eprintln!("going on with {kept} batches of an interrupted run");
    }
    let start = Instant::now();
    let mut watch = Watch::default();
    let rows = outcome::run(tasks, &options, state.as_ref(), |task, progress| {
        watch.show(task, progress);
    })?;
    if std::io::stderr().is_terminal() {
        eprint!("\r\x1b[K");
    }
    let provenance = Provenance::of(&options, plan, start.elapsed().as_secs_f64());
    let mut text = table::head();
    for row in &rows {
        text += "\n";
        text += &table::line(row);
    }
    text += "\n";
    text += &table::summary(&rows, provenance.seconds);
    if let Some(part) = &provenance.part {
        text += &format!(
            "\npart {part} of the plan {} of {} comparisons, made by the program {}: parts belong together only if their plan is the same; of one program they are of one build",
            provenance.plan,
            provenance.hypotheses,
            provenance.program.as_deref().unwrap_or("(unknown)")
        );
    }
    arguments.say(&text);
    let page = folder.join("report.html");
    write(&page, &html::page(&rows, &provenance))?;
    let json = format!("{:#}\n", json::of(&rows, &provenance));
    write(&folder.join("report.json"), &json)?;
    arguments.say(&format!("report: {}", page.display()));
    arguments.write_json(&json)?;
    if let Some(state) = state {
        end(state, rows.iter().map(|row| row.outcome));
    }
    Ok(Conclusion::of(&rows))
}

/// Removes the batches of a finished run. A run with a broken row keeps them, so that after a repair only
/// that row is rendered. The verdicts are written already: an error in removing does not affect them.
fn end(state: State, mut outcomes: impl Iterator<Item = Outcome>) {
    if outcomes.any(|outcome| outcome == Outcome::Broken) {
        return;
    }
    if let Err(message) = state.finish() {
        eprintln!("warning: what the run has kept cannot be removed: {message}");
    }
}

/// How often a log is told how far the run is.
const LOG_EVERY: Duration = Duration::from_secs(10);

/// Says how far the run is: on one line of a terminal, and in a log every ten seconds or so.
#[derive(Default)]
struct Watch {
    told: Option<Instant>,
}

impl Watch {
    fn show(&mut self, task: &Task<'_>, progress: &Progress) {
        if std::io::stderr().is_terminal() {
            eprint!("\r\x1b[K{}\r", line(task, progress));
        } else if self.told.is_none_or(|told| told.elapsed() >= LOG_EVERY) {
            eprintln!("{}", line(task, progress));
            self.told = Some(Instant::now());
        }
    }
}

/// Where the run is, and how long the rest takes. How many comparisons need a further look is not
/// known beforehand; each look tells its own rest.
fn line(task: &Task<'_>, progress: &Progress) -> String {
    let remaining = progress.remaining.map_or(String::new(), |rest| {
        format!(", about {} left", duration(rest))
    });
    let look = match progress.look {
        1 => String::new(),
        number => format!("look {number} at what is undecided, "),
    };
    format!(
        "{look}{} of {}: {} {} (after {}{remaining})",
        progress.done + 1,
        progress.total,
        task.claim.name,
        task.label(),
        duration(progress.elapsed),
    )
}

/// Hours, minutes and seconds.
fn duration(time: Duration) -> String {
    let seconds = time.as_secs();
    let (hours, minutes) = (seconds / 3600, seconds / 60 % 60);
    if hours > 0 {
        format!("{hours} h {minutes:02} min")
    } else if minutes > 0 {
        format!("{minutes} min {:02} s", seconds % 60)
    } else {
        format!("{seconds} s")
    }
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    write_atomically(path, |file| file.write_all(text.as_bytes()))
        .map_err(|e| format!("{}: {e}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(command: &str) -> String {
        #[derive(clap::Parser)]
        struct Line {
            #[command(flatten)]
            arguments: Arguments,
        }
        let line = <Line as clap::Parser>::parse_from(command.split(' '));
        validate(&line.arguments).expect_err("refused")
    }

    #[test]
    fn a_name_that_no_claim_has_is_an_error_for_lists_and_runs() {
        for more in ["", " --list", " --list --json"] {
            let near = message(&format!("validate --only furnance{more}"));
            assert!(near.contains("did you mean `furnace`?"), "{near}");
            let far = message(&format!("validate --only no-such-claim-at-all{more}"));
            assert!(far.contains("validate --list"), "{far}");
        }
    }

    #[test]
    fn what_cannot_be_written_is_said_before_the_run() {
        // Names that no claim has keep a mutant from running for minutes. Mutants rejected: paths that
        // are looked at after the claims, or when everything is rendered.
        let here = env!("CARGO_MANIFEST_DIR");
        for (path, reason) in [
            (format!("--json {here}/no/such.json"), "no such folder"),
            (format!("--json {here}"), "it is a folder"),
            (
                format!("--list --json {here}/no/such.json"),
                "no such folder",
            ),
            (format!("--report {here}/Cargo.toml"), "Cargo.toml: "),
            (
                format!("--report {here}/Cargo.toml/below"),
                "Cargo.toml/below: ",
            ),
        ] {
            let message = message(&format!("validate --only no-such-claim {path}"));
            assert!(
                message.contains(reason) && message.starts_with("--"),
                "{message}"
            );
        }
    }

    #[test]
    fn a_run_keeps_its_batches_if_something_broke() {
        // Mutants rejected: hours of batches are forgotten for one reference that is missing; a folder
        // that is gone makes the run fail.
        let folder = std::env::temp_dir().join(format!("etalon-end-{}", std::process::id()));
        let options = Options {
            only: None,
            tier: Tier::Full,
            seed: 1,
            part: None,
        };
        let open = || State::open(&folder, &options).expect("a folder");
        let below = open().folder().to_owned();
        end(open(), [Outcome::Passed, Outcome::Broken].into_iter());
        assert!(below.is_dir());
        let worse = [Outcome::Passed, Outcome::Failed, Outcome::Undecided];
        end(open(), worse.into_iter());
        assert!(!below.exists());
        let state = open();
        std::fs::remove_dir_all(&folder).expect("removed");
        end(state, worse.into_iter());
    }
}
