//! Null runs: nothing is wrong, and the decision says so at its level.

use crate::claims::claims;
use etalon_statistics::proportion;
use etalon_validation::null_runs::{self, Deck};
use etalon_validation::outcome::Outcome;
use etalon_validation::run::{self, Options};
use etalon_validation::tier::Tier;

#[test]
fn the_decision_keeps_its_level_where_nothing_is_wrong() {
    let claims = claims();
    let options = Options {
        only: Some("furnace".to_owned()),
        tier: Tier::Default,
        seed: 1,
        part: None,
    };
    let tasks = run::tasks(&claims, &options).into_iter();
    let decks = tasks.filter_map(|task| Deck::render(task, 1).expect("it renders"));
    let decks: Vec<Deck<'_>> = decks.collect();
    // Planted faults are not dealt.
    assert_eq!(decks.len(), 1);
    let runs = null_runs::run(&decks, 400, 1).expect("a plan");
    // Mutants rejected: hands that share replicates (too few small p-values), a standard error too small by √2.
    let outcomes = runs.iter().flat_map(|run| &run.outcomes);
    assert!(outcomes.clone().all(|outcome| *outcome != Outcome::Failed));
    assert!(outcomes.clone().any(|outcome| *outcome == Outcome::Passed));
    let p_values: Vec<f64> = runs.iter().flat_map(|run| run.p_values.clone()).collect();
    assert_eq!(p_values.len(), 400);
    for level in [0.1, 0.01] {
        let count = p_values.iter().filter(|p| **p <= level).count() as u64;
        let rate = proportion::interval(count, 400, 0.999).expect("trials");
        assert!(rate.low <= level, "{level}: {rate:?}");
    }
    assert!(p_values.iter().any(|p| *p < 0.1), "it can reject");
}
