//! `cargo xtask calibrate-conform`: shows on simulated sound programs that `etalon conform` accuses as rarely as it says.

use etalon_conform::null_programs::{Answers, Noise, NullProgram};
use etalon_conform::questions;
use etalon_conform::rules::Rules;
use etalon_conform::tier::Tier;
use etalon_statistics::proportion;
use rayon::prelude::*;
use std::process::ExitCode;

/// The confidence of the intervals of all counted rates together.
const CONFIDENCE: f64 = 0.99;

/// Counted rates.
const RATES: f64 = 4.0;

/// Single means at most that are tested.
const MEANS: u32 = 400_000;

/// Levels at which single means are tested.
const LEVELS: [f64; 2] = [1e-2, 1e-3];

/// How much to calibrate.
#[derive(Clone, Debug, clap::Args)]
#[command(
    after_help = "Exit code: 0 if every promise is kept, 1 if one is not.\n\nExamples:\n  cargo xtask calibrate-conform\n  cargo xtask calibrate-conform --programs 160000    # a quarter of an hour"
)]
pub(crate) struct CalibrateConformArguments {
    /// Simulated programs
    #[arg(long, default_value_t = 10_000)]
    programs: u32,
    /// The seed of everything
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Runs the calibration.
pub(crate) fn run(arguments: &CalibrateConformArguments) -> ExitCode {
    let runs = whole_runs(arguments);
    let rules = rules();
    let mut kept = true;
    let mut tell = |what: &str, count: usize, trials: usize, level: f64, exact: bool| {
        let seen = proportion::interval(
            count as u64,
            trials as u64,
            1.0 - (1.0 - CONFIDENCE) / RATES,
        );
        let [low, high] = seen.map_or([0.0, 1.0], |seen| [seen.low, seen.high]);
        let holds = low <= level && (!exact || level <= high);
        let promise = if exact { "is" } else { "at most" };
        println!(
            "{:<7} {what}: {count} of {trials}, a rate of {low:.1e} to {high:.1e}; {promise} {level:.0e}",
            if holds { "kept" } else { "BROKEN" }
        );
        kept &= holds;
    };
    let accused = runs.iter().filter(|(_, answers)| answers.differs > 0);
    tell(
        "sound programs accused",
        accused.count(),
        runs.len(),
        rules.alarm,
        false,
    );
    let at_bound = |by_chance: bool| -> [usize; 2] {
        let of_kind = |program: &NullProgram| {
            program.error != 0.0 && program.noise.finds_lights_by_chance() == by_chance
        };
        let runs = runs.iter().filter(|(program, _)| of_kind(program));
        let missed = runs.clone().filter(|(_, answers)| answers.agrees > 0);
        [missed.count(), runs.count()]
    };
    let [missed, trials] = at_bound(false);
    let what = "an error of the bound, and an interval within it";
    tell(what, missed, trials, rules.miss, false);
    let [missed, trials] = at_bound(true);
    println!(
        "        {what}: {missed} of {trials} programs that find lights by chance; nothing is promised"
    );
    for level in LEVELS {
        let trials = MEANS.min(100 * arguments.programs);
        let count = alarms_of_a_mean(level, trials, arguments.seed);
        tell(
            "single means at the bound accused",
            count,
            trials as usize,
            level,
            true,
        );
    }
    println!("\nOf all questions to programs whose means are right:");
    for noise in Noise::ALL {
        let own = runs
            .iter()
            .filter(|(program, _)| program.noise == noise && program.error == 0.0);
        let (mut undecided, mut agree) = (0, 0);
        own.for_each(|(_, answers)| {
            undecided += answers.undecided;
            agree += answers.agrees;
        });
        let all = f64::from(undecided + agree).max(1.0);
        let [undecided, agree] = [undecided, agree].map(|count| 100.0 * f64::from(count) / all);
        println!("  {noise:?}: {agree:.1} % agree, {undecided:.1} % undecided");
    }
    ExitCode::from(u8::from(!kept))
}

/// Those of the standard tier; samples and their brightness are the programs' own.
fn rules() -> Rules {
    Rules::new(
        questions::ALL.len(),
        Tier::Standard.looks().len() as u32,
        0,
        0.0,
    )
}

/// All questions of the standard tier to programs of all kinds, a third of each right in its means, a third at either end of the bound.
fn whole_runs(arguments: &CalibrateConformArguments) -> Vec<(NullProgram, Answers)> {
    let kinds = Noise::ALL.len();
    let program = |index: u32| {
        let index = index as usize;
        NullProgram {
            noise: Noise::ALL[index % kinds],
            error: [0.0, 1.0, -1.0][index / kinds % 3],
        }
    };
    let seed = |index: u32| (arguments.seed << 32) + u64::from(index);
    let (rules, looks) = (rules(), Tier::Standard.looks());
    (0..arguments.programs)
        .into_par_iter()
        .map(|index| {
            let program = program(index);
            let answers = program.ask(questions::ALL.len() as u32, looks, &rules, seed(index));
            (program, answers)
        })
        .collect()
}

/// How often one mean of normal pictures, at the bound, is accused at a level, where nothing else is asked.
fn alarms_of_a_mean(level: f64, trials: u32, seed: u64) -> usize {
    let program = NullProgram {
        noise: Noise::Normal,
        error: 1.0,
    };
    // An interval of twice the level, of which one end counts, shared with tiles that nothing accuses.
    let shared = f64::from(1 + etalon_conform::tile::TILES * etalon_conform::tile::TILES);
    let rules = Rules {
        alarm: 2.0 * level * shared,
        tile_bound: 1e9,
        ..Rules::new(1, 1, 0, 0.0)
    };
    let accused = |index: u32| {
        let seed = (seed << 32) + u64::from(index);
        program.ask(1, &[32], &rules, seed).differs > 0
    };
    (0..trials)
        .into_par_iter()
        .filter(|index| accused(*index))
        .count()
}
