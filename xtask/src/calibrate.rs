//! `cargo xtask calibrate`: shows by null runs that the validation's error rates are what they are
//! said to be.

use etalon_render::decide::decision::FALSE_POSITIVE_LEVEL;
use etalon_statistics::proportion;
use etalon_validation::claim::Claim;
use etalon_validation::folders;
use etalon_validation::null_runs::{self, Deck, NullRun};
use etalon_validation::outcome::Outcome;
use etalon_validation::run::{self, Options};
use etalon_validation::tier::Tier;
use std::process::ExitCode;

/// Levels at which rejections of single comparisons are counted.
const LEVELS: [f64; 3] = [0.1, 0.01, 0.001];

/// The confidence of the intervals of all counted rates together.
const CONFIDENCE: f64 = 0.99;

/// The greatest share of the null runs that may leave one comparison undecided: what is never decided is
/// never rejected, and shows nothing.
const MOST_UNDECIDED: f64 = 0.99;

/// How much to calibrate.
#[derive(Clone, Debug, clap::Args)]
#[command(
    after_help = "Exit code: 0 if every promise is kept, 1 if one is not, 2 if it could not be made.\n\nExamples:\n  cargo xtask calibrate\n  cargo xtask calibrate --only furnace --runs 200"
)]
pub(crate) struct Arguments {
    /// Only the claim of this name, or those whose names contain it
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
    /// Null runs of the whole decision
    #[arg(long, default_value_t = 1000)]
    runs: u32,
    /// The seed of everything
    #[arg(long, default_value_t = 1)]
    seed: u64,
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
        tier: Tier::Default,
        seed: arguments.seed,
        part: None,
    };
    let decks = run::tasks(&claims, &options).into_iter();
    let decks = decks.filter_map(|task| Deck::render(task, arguments.seed).transpose());
    let decks = decks.collect::<Result<Vec<Deck<'_>>, String>>()?;
    if decks.is_empty() || arguments.runs == 0 {
        return Err("there is nothing to compare: no means of pictures, or no runs".to_owned());
    }
    println!(
        "{} null runs of {} comparisons",
        arguments.runs,
        decks.len()
    );
    let runs = null_runs::run(&decks, arguments.runs, arguments.seed)?;
    Ok(tell(&decks, &runs))
}

/// Prints each promise and what was seen of it; whether all are kept.
fn tell(decks: &[Deck<'_>], runs: &[NullRun]) -> bool {
    let mut all = true;
    let mut promise = |holds: bool, text: String| {
        println!("{:<7} {text}", if holds { "kept" } else { "BROKEN" });
        all &= holds;
    };
    // A test may reject more rarely than its level, never more often.
    let confidence = 1.0 - (1.0 - CONFIDENCE) / (LEVELS.len() + 1) as f64;
    let mut rate = |what: &str, level: f64, count: usize, trials: usize| {
        let seen = proportion::interval(count as u64, trials as u64, confidence);
        let [low, high] = seen.map_or([0.0, 1.0], |seen| [seen.low, seen.high]);
        let text = format!(
            "{what}: {count} of {trials}, a rate of {low:.1e} to {high:.1e}; at most {level:.0e} is promised"
        );
        promise(low <= level, text);
    };
    let rejects = |run: &&NullRun| run.outcomes.contains(&Outcome::Failed);
    let rejecting = runs.iter().filter(rejects).count();
    let what = "runs with a rejection";
    rate(what, FALSE_POSITIVE_LEVEL, rejecting, runs.len());
    let p_values: Vec<f64> = runs.iter().flat_map(|r| r.p_values.clone()).collect();
    for level in LEVELS {
        let count = p_values.iter().filter(|p| **p <= level).count();
        let what = format!("comparisons rejected at {level} at their first look");
        rate(&what, level, count, p_values.len());
    }
    for (place, deck) in decks.iter().enumerate() {
        let count = |outcome| runs.iter().filter(|r| r.outcomes[place] == outcome).count();
        let (undecided, broken) = (count(Outcome::Undecided), count(Outcome::Broken));
        if undecided as f64 > MOST_UNDECIDED * runs.len() as f64 || broken > 0 {
            let name = deck.task().question(Tier::Default).name;
            let text = format!("{name}: {undecided} times undecided, {broken} times broken");
            promise(false, text);
        }
    }
    all
}
