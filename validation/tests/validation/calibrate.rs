//! Calibration: it keeps silent about sound statistics, and speaks up about unsound ones.

use crate::claims::claims;
use etalon_statistics::error_rates::Rate;
use etalon_statistics::{Estimate, Summary};
use etalon_validation::calibrate::pool::Pool;
use etalon_validation::calibrate::single::{SETTINGS, Single};
use etalon_validation::calibrate::{CONFIDENCE, REPETITIONS, null, verdict};
use etalon_validation::claim::Claim;
use etalon_validation::folders;
use etalon_validation::run::{self, Options};
use etalon_validation::state::State;
use etalon_validation::tier::Tier;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Differences from zero of the means of eight nearly normal numbers, as `estimate` has them.
fn repeated(estimate: impl Fn(&Summary) -> Estimate) -> Single {
    let mut random = Pcg64Mcg::seed_from_u64(5);
    let mut normal = || {
        let sum: f64 = (0..12).map(|_| random.random::<f64>()).sum();
        sum - 6.0
    };
    let estimates: Vec<Estimate> = (0..REPETITIONS)
        .map(|_| {
            let sample: [f64; 8] = std::array::from_fn(|_| normal());
            estimate(&Summary::of(&sample).expect("eight numbers"))
        })
        .collect();
    let confidence = verdict::confidence_of_each(SETTINGS.len());
    Single::of("a mean".to_owned(), &estimates, confidence).expect("there are repetitions")
}

fn kept(single: &Single) -> Vec<bool> {
    let confidence = verdict::confidence_of_each(SETTINGS.len());
    let promises = verdict::of_single(single, confidence);
    promises.iter().map(|promise| promise.holds).collect()
}

#[test]
fn students_t_keeps_its_promises() {
    // Five promises, together at α = 10⁻² and the preset window of alarms; the seed is fixed.
    assert_eq!(kept(&repeated(Estimate::mean)), [true; 5]);
}

#[test]
fn a_normal_quantile_in_place_of_students_is_caught() {
    // Mutant: seven degrees of freedom taken for infinitely many. Alarms at 1 % come in 3.7 %.
    let unsound = |sample: &Summary| {
        Estimate::with_known_error(sample.mean(), sample.standard_error()).expect("finite")
    };
    let kept = kept(&repeated(unsound));
    assert!(!kept[0], "alarms come too often");
    assert!(!kept[4], "99 % intervals cover too little");
}

#[test]
fn a_standard_error_off_by_a_root_of_two_is_caught() {
    let unsound = |sample: &Summary| {
        let error = sample.standard_error() * std::f64::consts::SQRT_2;
        Estimate::new(sample.mean(), error, 7.0).expect("finite")
    };
    let kept = kept(&repeated(unsound));
    // Mutant: intervals that are too wide are as wrong as those that are too narrow.
    assert!(!kept[1] && !kept[2] && !kept[3], "{kept:?}");
}

#[test]
fn null_runs_raise_no_alarm() {
    let claims = claims();
    let options = Options {
        only: Some("furnace".to_owned()),
        tier: Tier::Default,
        seed: 1,
        part: None,
    };
    let mut tasks = run::tasks(&claims, &options);
    tasks.retain(|task| task.fault.is_none());
    let folder = tempfile::tempdir().expect("a folder");
    let state = State::open(folder.path(), &options).expect("a state");
    let pools: Vec<Pool> = tasks
        .iter()
        .map(|task| Pool::render(*task, Tier::Default, 1, &state).expect("it renders"))
        .collect();
    // Mutant rejected: a formula's world of 64, whose skewness by chance raises false alarms.
    assert!(pools.iter().all(|pool| pool.replicates() >= Some(256)));
    let runs = null::run(&tasks, &pools, Tier::Default, (200, 1), CONFIDENCE, |_| {});
    let runs = runs.expect("it runs");
    // The whole decision's α is 10⁻⁵: with 200 runs a rate of 5 % would be seen.
    assert_eq!(runs.alarms.count, 0);
    assert!(runs.alarms.interval.high < 0.05);
    assert!(runs.comparisons.iter().all(|counts| counts.broken == 0));
    let p_values = runs.p_values.iter().flat_map(|(_, p)| p);
    let p_values: Vec<f64> = p_values.copied().collect();
    assert_eq!(p_values.len(), 400, "an image mean and a tile of each run");
    // α = 10⁻² for each. Mutant: two hands that share replicates would have too few small ones.
    let rates = verdict::decades(&p_values);
    assert!(rates[..3].iter().all(|rate| rate.is_kept()), "{rates:?}");
}

#[test]
fn null_runs_that_decide_nothing_keep_no_promise() {
    // 1000 runs of two comparisons. Mutants rejected: no alarm is all that is asked, though what
    // breaks, and what is never decided, raises none.
    let kept = |second: null::Counts| {
        let runs = null::NullRuns {
            alarms: Rate::new(1e-3, u64::from(second.failed), 1000, CONFIDENCE).expect("a rate"),
            undecided: second.undecided,
            comparisons: vec![null::Counts::default(), second],
            p_values: Vec::new(),
        };
        let promises = verdict::of_null_runs(&runs);
        promises.iter().all(|promise| promise.holds)
    };
    let counts = |failed, undecided, broken| null::Counts {
        failed,
        undecided,
        broken,
    };
    assert!(kept(counts(0, 0, 0)) && kept(counts(0, 990, 0)));
    assert!(!kept(counts(1, 0, 0)) && !kept(counts(0, 991, 0)) && !kept(counts(0, 0, 1)));
}

#[test]
fn replicates_of_another_estimator_are_not_taken_up() {
    // The plan and the scene are the same. Mutant rejected: replicates that are told by the place of
    // their estimator alone.
    let claim = Claim::read(&folders::claims().join("furnace.toml")).expect("a claim");
    let mut claims = vec![claim];
    claims[0].estimators[0].mutants.clear();
    let options = Options {
        only: None,
        tier: Tier::Default,
        seed: 1,
        part: None,
    };
    let folder = tempfile::tempdir().expect("a folder");
    let state = State::open(folder.path(), &options).expect("a state");
    let render = |claims: &[Claim]| {
        let task = run::tasks(claims, &options)[0];
        Pool::render(task, Tier::Default, 1, &state).expect("it renders");
        state.len()
    };
    assert_eq!((render(&claims), render(&claims)), (1, 1));
    claims[0].estimators[0].adaptive = Some(16);
    assert_eq!(render(&claims), 2);
}
