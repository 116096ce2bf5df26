//! What differs at the level of the intervals and not at that of alarms.

use crate::claims::claims;
use etalon_statistics::Verdict;
use etalon_validation::decision::{self, Seen, Stage};
use etalon_validation::fault::PlantedFault;
use etalon_validation::run::{self, Options};
use etalon_validation::tier::{Multiple, Tier};

#[test]
fn a_doubt_gets_more_replicates_and_never_passes() {
    // What `see` makes of the looks at one comparison: the verdict, whether it is in doubt, and how many
    // looks there were.
    let mut claims = claims();
    claims.retain(|claim| claim.name == "irradiance-disk");
    claims[0].estimators.truncate(1);
    claims[0].estimators[0].mutants = vec![PlantedFault::Energy];
    let options = Options {
        only: None,
        tier: Tier::Thorough,
        seed: 1,
        part: None,
    };
    let tasks = run::tasks(&claims, &options);
    let decide = |place: usize, see: &dyn Fn(Stage) -> Seen| {
        let all = decision::decide(&tasks, Tier::Thorough, |turn| Some(see(turn)), |_| {});
        let decision = all.expect("a plan")[place];
        let verdict = decision.verdict.expect("decided");
        (verdict, decision.in_doubt, decision.looks)
    };
    let all = Tier::Thorough.looks().len();
    let seen = |verdict, p| Seen { verdict, p };
    let doubt = |turn: Stage| seen(Verdict::Differs, 0.5 * turn.alpha);
    // Mutants rejected: a failure at the level of the intervals; a doubt that passes, or ends the looks.
    assert_eq!(decide(0, &doubt), (Verdict::Undecided, true, all));
    // Equality in doubt, though the bias is within its bounds. Mutant rejected: that passes.
    let equality = |turn: Stage| seen(Verdict::Agrees, 0.5 * turn.alpha);
    assert_eq!(decide(0, &equality), (Verdict::Undecided, true, all));
    // Too wide an interval is no doubt. Mutant rejected: all that is undecided is in doubt.
    let wide = |_: Stage| seen(Verdict::Undecided, 0.5);
    assert_eq!(decide(0, &wide), (Verdict::Undecided, false, all));
    // Chance: more replicates dispel it. Mutant rejected: a first look that is never forgotten.
    let chance = |turn: Stage| match turn.multiple {
        Multiple::ONE => doubt(turn),
        _ => seen(Verdict::Agrees, 0.5),
    };
    assert_eq!(decide(0, &chance), (Verdict::Agrees, false, 2));
    // A fault is shown as soon as it can be. Mutant rejected: all looks are made.
    let fault = |turn: Stage| seen(Verdict::Differs, 0.5 * turn.alarm);
    assert_eq!(decide(0, &fault), (Verdict::Differs, false, 1));
    // Planted ones need no more than the level of the intervals.
    assert_eq!(decide(1, &doubt), (Verdict::Differs, false, 1));
}
