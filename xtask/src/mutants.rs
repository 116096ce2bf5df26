//! `cargo xtask mutants`: plants physical faults in a worktree of the last commit, one at a time, and
//! shows that the claims of the validation find them.
//!
//! The list is `validation/mutants.toml`. Each mutant is built with the `fast` profile and put to
//! the claims that must fail, then to the whole default suite if those let it pass. A comparison
//! that also fails in the sound program kills no mutant.

mod list;
mod record;
mod workspace;

use etalon_images::write_atomically;
use list::Mutant;
use record::{Fate, Killer, Record, Records, Setup};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::process::ExitCode;
use std::time::{Duration, Instant};
use workspace::{Program, Run, Workspace};

/// The share of all mutants that must be killed.
const LEAST_SHARE: f64 = 0.95;

/// Which mutants to run.
#[derive(Clone, Debug, clap::Args)]
#[command(
    after_help = "Exit code: 0 if every fault that moves energy and 95 % of all are killed, 1 otherwise, 2 if the run could not be made.\n\nExamples:\n  cargo xtask mutants --check\n  cargo xtask mutants --only fresnel\n  nice cargo xtask mutants --named-only"
)]
pub(crate) struct Arguments {
    /// Only the mutants whose names contain this
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
    /// Say which mutants there are, and build nothing
    #[arg(long)]
    list: bool,
    /// Only see whether every mutant applies to the sources as they are
    #[arg(long, conflicts_with = "list")]
    check: bool,
    /// Only the claims that each mutant names, not the default suite after them
    #[arg(long)]
    named_only: bool,
    /// The seed of all pictures
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Begin with the last commit, and run these mutants whether or not they have a result
    #[arg(long)]
    fresh: bool,
    /// Seconds after which a run of claims is given up
    #[arg(long, default_value_t = 900)]
    timeout: u64,
}

impl Arguments {
    /// The report's name: that of some mutants is no report of all.
    fn report(&self) -> &'static str {
        match self.only {
            Some(_) => "report-only.json",
            None => "report.json",
        }
    }
}

/// Runs the mutants.
pub(crate) fn run(arguments: &Arguments) -> ExitCode {
    match mutants(arguments) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

fn mutants(arguments: &Arguments) -> Result<bool, String> {
    let mut mutants = list::read()?;
    if arguments.check {
        let mistakes = list::mistakes(&mutants)?;
        for mistake in &mistakes {
            eprintln!("error: {mistake}");
        }
        println!("{} mutants, {} mistakes", mutants.len(), mistakes.len());
        return Ok(mistakes.is_empty());
    }
    if let Some(part) = &arguments.only {
        mutants.retain(|mutant| mutant.name.contains(part.as_str()));
    }
    if mutants.is_empty() {
        return Err("no mutant has such a name: see `cargo xtask mutants --list`".to_owned());
    }
    if arguments.list {
        for mutant in &mutants {
            let energy = if mutant.moves_energy { "energy" } else { "" };
            println!("{:<42} {energy:<6} {}", mutant.name, mutant.fault);
        }
        return Ok(true);
    }
    let limit = Duration::from_secs(arguments.timeout);
    let workspace = Workspace::open(arguments.fresh, limit)?;
    let setup = Setup {
        commit: workspace.commit.clone(),
        seed: arguments.seed,
        named_only: arguments.named_only,
    };
    let records = put_to_the_claims(workspace, &mutants, &setup, arguments.fresh)?;
    conclude(&mutants, &records, arguments, &setup)
}

/// Runs what has no record yet, or all if `fresh`; the records of all, in the order of the list.
fn put_to_the_claims(
    workspace: Workspace,
    mutants: &[Mutant],
    setup: &Setup,
    fresh: bool,
) -> Result<Vec<Record>, String> {
    let mut records = Records::open(&workspace::folder().join("results.jsonl"));
    let waits = |mutant: &&Mutant| fresh || records.of(mutant, setup).is_none();
    let waiting: Vec<&Mutant> = mutants.iter().filter(waits).collect();
    let known = mutants.len() - waiting.len();
    eprintln!(
        "commit {:.12}: {} mutants, {known} of them already run",
        setup.commit,
        mutants.len()
    );
    if !waiting.is_empty() {
        eprintln!("the sound program first");
        workspace.build_sound()?;
    }
    let mut examiner = Examiner {
        workspace,
        setup,
        unsound: BTreeMap::new(),
    };
    let start = Instant::now();
    // What does not apply or build is told of, too, though it will be tried again.
    let mut run = Vec::new();
    for (done, mutant) in waiting.iter().enumerate() {
        let record = examiner.examine(mutant)?;
        let rate = start.elapsed().as_secs_f64() / (done + 1) as f64;
        let rest = rate * (waiting.len() - done - 1) as f64 / 60.0;
        eprintln!(
            "{} of {}, about {rest:.0} min left: {}",
            done + 1,
            waiting.len(),
            line(&record)
        );
        run.push(record.clone());
        records.push(record)?;
    }
    let told = |mutant: &Mutant| {
        let now = run.iter().find(|record| record.name == mutant.name);
        now.or_else(|| records.of(mutant, setup)).cloned()
    };
    Ok(mutants.iter().filter_map(told).collect())
}

/// A comparison: claim, estimator, and the planted fault it looks for.
type Comparison = [String; 3];

fn comparison(row: &Value) -> Comparison {
    ["claim", "estimator", "mutant"].map(|key| row[key].as_str().unwrap_or_default().to_owned())
}

/// Whether a comparison says that something is wrong: undecided is no verdict.
fn fails(row: &Value) -> bool {
    matches!(row["outcome"].as_str(), Some("failed" | "broken"))
}

fn killer(row: &Value) -> Killer {
    let text = |key: &str| row[key].as_str().map(str::to_owned);
    Killer {
        claim: text("claim").unwrap_or_default(),
        estimator: text("estimator").unwrap_or_default(),
        outcome: text("outcome").unwrap_or_default(),
        verdict: text("verdict").or_else(|| text("error")),
        p: row["p_corrected"].as_f64(),
    }
}

/// Plants, builds and validates mutants.
struct Examiner<'a> {
    workspace: Workspace,
    setup: &'a Setup,
    /// Comparisons that fail in the sound program, too, for each choice of claims that was asked for.
    unsound: BTreeMap<Option<String>, BTreeSet<Comparison>>,
}

impl Examiner<'_> {
    fn examine(&mut self, mutant: &Mutant) -> Result<Record, String> {
        let start = Instant::now();
        let mut record = Record::new(mutant, self.setup);
        if let Err(message) = self.workspace.plant(mutant) {
            record.fate = Fate::DoesNotApply;
            record.message = Some(message);
        } else if let Err(message) = self.workspace.build()? {
            record.fate = Fate::DoesNotBuild;
            record.message = Some(message);
        } else {
            self.judge(mutant, &mut record)?;
        }
        record.seconds = start.elapsed().as_secs_f64();
        Ok(record)
    }

    /// Runs claims until one fails.
    fn judge(&mut self, mutant: &Mutant, record: &mut Record) -> Result<(), String> {
        // The commit may be older than the list.
        let there = mutant.claims.iter();
        let there = there.filter(|claim| self.workspace.has_claim(claim));
        let mut choices: Vec<Option<&str>> = there.map(|claim| Some(claim.as_str())).collect();
        if choices.is_empty() && self.setup.named_only {
            record.fate = Fate::DoesNotApply;
            record.message =
                Some("the commit has none of its claims: `--fresh` takes the last".into());
            return Ok(());
        }
        if !self.setup.named_only {
            choices.push(None);
        }
        for only in choices {
            let seed = self.setup.seed;
            record.killer = match self.workspace.validate(Program::Mutated, only, seed)? {
                Run::Rows(rows) => {
                    let mut failing: Vec<&Value> = rows.iter().filter(|row| fails(row)).collect();
                    if !failing.is_empty() {
                        let unsound = self.unsound(only)?;
                        failing.retain(|row| !unsound.contains(&comparison(row)));
                    }
                    // A comparison without a planted fault says most.
                    let plain = failing.iter().find(|row| row["mutant"].is_null());
                    plain.or(failing.first()).map(|row| killer(row))
                }
                Run::TimedOut => {
                    record.fate = Fate::TimedOut;
                    record.message = Some(format!("{} did not end", only.unwrap_or("the suite")));
                    return Ok(());
                }
                Run::Crashed(said) => {
                    // The sound program must not.
                    self.unsound(only)?;
                    Some(Killer {
                        claim: only.unwrap_or("the suite").to_owned(),
                        estimator: String::new(),
                        outcome: "crashed".to_owned(),
                        verdict: Some(said),
                        p: None,
                    })
                }
            };
            if record.killer.is_some() {
                record.fate = Fate::Killed;
                record.as_named = only.is_some();
                return Ok(());
            }
        }
        Ok(())
    }

    /// Comparisons that fail in the sound program, too, among the claims that `only` means.
    fn unsound(&mut self, only: Option<&str>) -> Result<&BTreeSet<Comparison>, String> {
        let key = only.map(str::to_owned);
        if !self.unsound.contains_key(&key) {
            let seed = self.setup.seed;
            let failing = match self.workspace.validate(Program::Sound, only, seed)? {
                Run::Rows(rows) => rows.iter().filter(|r| fails(r)).map(comparison).collect(),
                Run::TimedOut => return Err("the sound program's claims do not end".to_owned()),
                Run::Crashed(said) => return Err(format!("the sound program: {said}")),
            };
            self.unsound.insert(key.clone(), failing);
        }
        Ok(&self.unsound[&key])
    }
}

/// A record in a line.
fn line(record: &Record) -> String {
    let by = match (&record.killer, &record.message) {
        (Some(k), _) => {
            let p = k.p.map_or(String::new(), |p| format!(", p = {p:.1e}"));
            let verdict = k.verdict.as_deref().unwrap_or(&k.outcome);
            let verdict = verdict.lines().next().unwrap_or_default();
            let other = if record.as_named { "" } else { " (not named)" };
            format!("by {} {}: {verdict}{p}{other}", k.claim, k.estimator)
        }
        (None, Some(message)) => message.lines().next().unwrap_or_default().to_owned(),
        (None, None) => String::new(),
    };
    format!(
        "{:<42} {:<14} {:>4.0} s  {by}",
        record.name, record.fate, record.seconds
    )
}

/// The table, its JSON, and whether enough was killed.
fn conclude(
    mutants: &[Mutant],
    records: &[Record],
    arguments: &Arguments,
    setup: &Setup,
) -> Result<bool, String> {
    println!("{:<42} {:<14}", "mutant", "fate");
    for record in records {
        println!("{}", line(record));
    }
    let fate = |mutant: &Mutant| {
        let record = records.iter().find(|record| record.name == mutant.name);
        record.map(|record| record.fate)
    };
    let killed = |mutant: &&Mutant| fate(mutant) == Some(Fate::Killed);
    let energy: Vec<&Mutant> = mutants.iter().filter(|m| m.moves_energy).collect();
    let of_energy = energy.iter().copied().filter(killed).count();
    let all = mutants.iter().filter(killed).count();
    println!(
        "\n{all} of {} mutants killed, {of_energy} of {} that move energy",
        mutants.len(),
        energy.len()
    );
    for mutant in mutants.iter().filter(|m| !killed(m)) {
        let state = fate(mutant).map_or("not run".to_owned(), |f| f.to_string());
        println!("  {} {state}", mutant.name);
    }
    let enough = all as f64 >= LEAST_SHARE * mutants.len() as f64;
    let passed = enough && of_energy == energy.len();
    let report = json!({
        "setup": setup,
        "only": arguments.only,
        "passed": passed,
        "mutants": mutants.len(),
        "killed": all,
        "moving_energy": energy.len(),
        "moving_energy_killed": of_energy,
        "records": records,
    });
    let path = workspace::folder().join(arguments.report());
    write_atomically(&path, |file| writeln!(file, "{report:#}"))
        .map_err(|e| format!("{}: {e}", path.display()))?;
    println!("report: {}", path.display());
    Ok(passed)
}
