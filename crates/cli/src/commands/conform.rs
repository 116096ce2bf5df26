//! `etalon conform`.

use super::{answer, fail, note};
use crate::args::{AskedArgs, ConformArgs, ConformCommand, ConformExportArgs, ConformRunArgs};
use crate::interrupt;
use etalon_conform::badge::badge;
use etalon_conform::driver::{Driver, Programs};
use etalon_conform::page::{Run, page};
use etalon_conform::plan::{Plan, STRICT_BOUND};
use etalon_conform::report::{self, Report};
use etalon_conform::runner::{Outcome, Runner};
use etalon_conform::suite::Suite;
use etalon_conform::tile::{self, TILES};
use etalon_conform::{drivers, questions};
use etalon_render::write_guard::{Destination, WriteGuard};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

/// Asks a program, or says what it would be asked.
pub fn run(args: &ConformArgs) -> ExitCode {
    let outcome = match &args.command {
        ConformCommand::List => Ok(answer(&list(), ExitCode::SUCCESS)),
        ConformCommand::Truth { question } => {
            truth(question).map(|text| answer(&text, ExitCode::SUCCESS))
        }
        ConformCommand::Run(args) => ask(args),
        ConformCommand::Export(args) => export(args),
        ConformCommand::Judge { folder, program } => judge(folder, program.as_deref()),
        ConformCommand::Page { reports, output } => together(reports, output),
        ConformCommand::Diff { old, new } => diff(old, new),
    };
    outcome.unwrap_or_else(fail)
}

fn list() -> String {
    let mut text = String::from("Questions (samples per pixel of one picture):\n");
    let width = (questions::ALL.iter())
        .map(|question| question.name.len())
        .max();
    let width = width.unwrap_or(0);
    for question in questions::ALL {
        let (name, samples, title) = (question.name, question.samples, question.title);
        let _ = writeln!(text, "  {name:width$} {samples:>6}  {title}");
    }
    text += "\nDrivers:\n";
    for driver in drivers::ALL {
        let _ = writeln!(text, "  {}", driver.name);
    }
    text
}

fn truth(name: &str) -> Result<String, String> {
    let question = questions::by_name(name).ok_or_else(|| unknown(name))?;
    let (_, picture) = (question.ask)();
    let mut text = format!(
        "{}\n\n  {}\n  {}\n\nMean of the picture: {}\nMeans of its tiles:\n",
        question.title,
        question.formula,
        question.source,
        picture.mean()
    );
    for row in 0..TILES {
        let mean = |column| tile::mean(&picture.means, picture.pixels, [column, row]);
        let row = (0..TILES).map(|column| format!("{:>12.6}", mean(column)));
        let _ = writeln!(text, "{}", row.collect::<String>());
    }
    Ok(text)
}

fn unknown(name: &str) -> String {
    let names = questions::ALL.iter().map(|question| question.name);
    let near = etalon_params::suggest::nearest(name, names);
    let hint = near.map_or_else(
        || "`etalon conform list` names all".to_owned(),
        |near| format!("did you mean `{near}`?"),
    );
    format!("there is no question `{name}`: {hint}")
}

fn plan(asked: &AskedArgs) -> Result<Plan, String> {
    let fits = |name: &str| asked.only.iter().any(|glob| fits(glob, name));
    let mut plan = Plan::new(asked.pose_seed, asked.tier, asked.mode, fits);
    if asked.strict {
        plan.bound = STRICT_BOUND;
    }
    match plan.questions.is_empty() {
        true => Err(format!(
            "no question of the tier fits `{}`: `etalon conform list` names all",
            asked.only.join(",")
        )),
        false => Ok(plan),
    }
}

/// Whether a name fits a pattern in which `*` stands for anything.
fn fits(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == name,
        Some((begin, rest)) => name.strip_prefix(begin).is_some_and(|name| {
            (0..=name.len()).any(|at| name.is_char_boundary(at) && fits(rest, &name[at..]))
        }),
    }
}

fn ask(args: &ConformRunArgs) -> Result<ExitCode, String> {
    let baseline = args.baseline.as_deref().map(read_report).transpose()?;
    let python = args.python.clone().unwrap_or_else(|| {
        std::env::var_os("ETALON_PYTHON").map_or_else(|| "python3".into(), PathBuf::from)
    });
    let etalon = std::env::current_exe().map_err(|error| error.to_string())?;
    let programs = Programs { python, etalon };
    let path = Path::new(&args.driver);
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let output = (args.output.clone()).unwrap_or_else(|| format!("conform-{name}").into());
    let driver = match args.driver.ends_with(".toml") {
        true => Driver::read(path, &programs)?,
        false => Driver::named(&args.driver, &output.join("driver"), &programs)?,
    };
    let plan = Plan {
        part: args.part.map_or([1, 1], |part| [part.number, part.count]),
        ..plan(&args.asked)?
    };
    let version = driver.version()?;
    if !args.quiet {
        note(format!(
            "{} says that it is `{version}`; pictures go to {}",
            driver.description.title,
            output.display()
        ));
    }
    let mut suite = Suite::create(&output, plan.of(&driver, version))?;
    let places = places(&output, args.baseline.as_ref())?;
    let bar = progress(args.quiet);
    // Pictures that are being rendered are waited for; the same command goes on with the others.
    if let Err(error) = interrupt::listen() {
        note(format!("a signal will end the process: {error}"));
    }
    let workers = args
        .workers
        .map_or_else(processors, |workers| workers as usize);
    let runner = Runner {
        workers,
        limit: Duration::from_secs(args.limit.into()),
        done: &|job, outcome| {
            bar.inc(1);
            bar.set_message(job.question.clone());
            if let Outcome::Broken(how) = outcome {
                bar.suspend(|| note(format!("{}, seed {}: {how}", job.question, job.seed)));
            }
        },
        stop: interrupt::flag(),
    };
    let report = suite.run(&driver, &runner, |step, count| {
        bar.set_length(count as u64);
        bar.set_position(0);
        bar.set_prefix(step.to_owned());
        if bar.is_hidden() && !args.quiet && count > 0 {
            note(format!("{step}: {count} pictures"));
        }
    })?;
    bar.finish_and_clear();
    if interrupt::asked() {
        note("stopped; the same command goes on from here");
        return Ok(ExitCode::from(interrupt::STOPPED));
    }
    keep(&suite, &report, &places)?;
    let mut code = report.exit_code();
    let mut text = report.table();
    if let Some(baseline) = baseline {
        let (changes, worse) = changes(&baseline, &report);
        text += &changes;
        code = u8::from(worse);
    }
    Ok(answer(&text, ExitCode::from(code)))
}

fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

fn progress(quiet: bool) -> ProgressBar {
    let target = match quiet {
        true => ProgressDrawTarget::hidden(),
        false => ProgressDrawTarget::stderr_with_hz(8),
    };
    let bar = ProgressBar::with_draw_target(Some(0), target);
    let style =
        ProgressStyle::with_template("{prefix} {wide_bar} {pos} of {len}, {eta} left, {msg}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

fn export(args: &ConformExportArgs) -> Result<ExitCode, String> {
    let suite = Suite::create(&args.to, plan(&args.asked)?)?;
    let jobs = suite.first_look()?;
    let mut lines = String::new();
    for job in &jobs {
        let scene = format!("scenes/{}", job.scene_name());
        let out = job.picture(Path::new(""));
        let line = serde_json::json!({
            "scene": format!("{scene}.json"), "xml": format!("{scene}.xml"), "pbrt": format!("{scene}.pbrt"),
            "samples": job.samples, "seed": job.seed, "mode": suite.plan.mode.name(),
            "out": out.display().to_string(),
        });
        let _ = writeln!(lines, "{line}");
    }
    let file = args.to.join("jobs.jsonl");
    fs::write(&file, lines).map_err(|e| format!("{}: {e}", file.display()))?;
    let text = format!(
        "{} scenes and {} with {} pictures to be rendered; then `etalon conform judge {}`\n",
        suite.plan.questions.len(),
        file.display(),
        jobs.len(),
        args.to.display()
    );
    Ok(answer(&text, ExitCode::SUCCESS))
}

fn judge(folder: &Path, program: Option<&str>) -> Result<ExitCode, String> {
    let suite = Suite::open(folder)?;
    let mut report = suite.judge();
    if let Some(program) = program {
        report.plan.title = program.to_owned();
    }
    keep(&suite, &report, &places(folder, None)?)?;
    let code = ExitCode::from(report.exit_code());
    Ok(answer(&report.table(), code))
}

/// The files of a run's report, its page and its badge; none is one of those that were read.
fn places(folder: &Path, read: Option<&PathBuf>) -> Result<[Destination; 3], String> {
    let mut guard = WriteGuard::of(read);
    let mut claim = |name: &str| guard.claim(&folder.join(name));
    Ok([
        claim("report.json")?,
        claim("index.html")?,
        claim("badge.svg")?,
    ])
}

/// Writes them.
fn keep(
    suite: &Suite,
    report: &Report,
    [json, html, svg]: &[Destination; 3],
) -> Result<(), String> {
    json.write_text(&report.to_json())?;
    html.write_text(&page(&[suite.run_for_page(report)]))?;
    svg.write_text(&badge(report))
}

/// Several reports on one page, with the pictures of those that lie in the folder of their run.
fn together(reports: &[PathBuf], output: &Path) -> Result<ExitCode, String> {
    let destination = WriteGuard::of(reports.iter().cloned()).claim(output)?;
    let read = reports.iter().map(|path| read_report(path));
    let read: Vec<Report> = read.collect::<Result<_, _>>()?;
    let runs = reports.iter().zip(&read).map(|(path, report)| {
        let folder = path.parent().unwrap_or(Path::new("."));
        let suite = Suite::open(folder).ok();
        let suite = suite.filter(|suite| suite.plan == report.plan);
        suite.map_or_else(
            || Run::without_pictures(report),
            |suite| suite.run_for_page(report),
        )
    });
    let text = page(&runs.collect::<Vec<_>>());
    destination.write_text(&text)?;
    Ok(ExitCode::SUCCESS)
}

fn read_report(path: &Path) -> Result<Report, String> {
    let text = fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let report: Report =
        serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?;
    match report.version {
        report::VERSION => Ok(report),
        other => Err(format!(
            "{}: version {other} of the report, and this program knows {}",
            path.display(),
            report::VERSION
        )),
    }
}

fn diff(old: &Path, new: &Path) -> Result<ExitCode, String> {
    let (text, worse) = changes(&read_report(old)?, &read_report(new)?);
    Ok(answer(&text, ExitCode::from(u8::from(worse))))
}

/// What changed from one report to another, and whether anything became worse.
fn changes(old: &Report, new: &Report) -> (String, bool) {
    let (mut text, mut worse) = (String::new(), false);
    if old.plan.fingerprint != new.plan.fingerprint {
        text.push_str("the questions are not the same\n");
    }
    for row in &new.rows {
        let word = row.finding.verdict.word();
        let before = old
            .rows
            .iter()
            .find(|before| before.question == row.question);
        let before = before.map_or("not asked", |before| before.finding.verdict.word());
        if before == word {
            continue;
        }
        let bad = matches!(word, "differs" | "broken");
        worse |= bad;
        let mark = if bad { "  worse" } else { "" };
        let _ = writeln!(text, "{}: {before}, now {word}{mark}", row.question);
    }
    if text.is_empty() {
        text.push_str("nothing changed\n");
    }
    (text, worse)
}

#[cfg(test)]
mod tests {
    use super::fits;

    #[test]
    fn a_star_stands_for_anything() {
        for (pattern, name, expected) in [
            ("*", "wall", true),
            ("wall", "wall", true),
            ("wall", "walls", false),
            ("sphere-*", "sphere-light-small", true),
            ("*-small", "sphere-light-small", true),
            ("s*-l*t-*", "sphere-light-small", true),
            ("s*x", "sphere", false),
        ] {
            assert_eq!(fits(pattern, name), expected, "{pattern} {name}");
        }
    }
}
