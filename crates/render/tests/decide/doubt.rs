//! What differs at the level of the intervals and not at that of alarms.

use etalon_render::decide::decision::{self, Question, Seen, Stage};
use etalon_render::decide::looks::{FINE_LOOKS, Multiple};
use etalon_statistics::Verdict;

#[test]
fn a_doubt_gets_more_replicates_and_never_passes() {
    let question = |is_mutant| Question {
        name: format!("a mutant: {is_mutant}"),
        is_mutant,
        elsewhere: false,
        cost: 1.0,
    };
    let questions = [false, true].map(question);
    // What `see` makes of the looks at one comparison: the verdict, whether it is in doubt, and how many
    // looks there were.
    let decide = |place: usize, see: &dyn Fn(Stage) -> Seen| {
        let all = decision::decide(&questions, FINE_LOOKS, |turn| Some(see(turn)), |_| {});
        let decision = all.expect("a plan")[place];
        let verdict = decision.verdict.expect("decided");
        (verdict, decision.in_doubt, decision.looks)
    };
    let all = FINE_LOOKS.len();
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

#[test]
fn what_breaks_and_what_others_make_count_in_the_family() {
    // Beside another comparison, each has half the level. Mutants rejected: a family of what is made here;
    // what breaks is passed, or forgotten.
    let question = |name: &str, elsewhere| Question {
        name: name.to_owned(),
        is_mutant: false,
        elsewhere,
        cost: 1.0,
    };
    let alarms = |questions: &[Question], broken: Option<usize>| {
        let mut least: f64 = 1.0;
        let decisions = decision::decide(
            questions,
            FINE_LOOKS,
            |turn| {
                least = least.min(turn.alarm);
                (broken != Some(turn.place)).then_some(Seen {
                    verdict: Verdict::Agrees,
                    p: 0.5,
                })
            },
            |_| {},
        );
        let decisions = decisions.expect("a plan");
        (least, decisions.into_iter().map(|d| d.verdict).collect())
    };
    let (alone, verdicts): (f64, Vec<_>) = alarms(&[question("a", false)], None);
    assert_eq!(verdicts, [Some(Verdict::Agrees)]);
    let (shared, verdicts) = alarms(&[question("a", false), question("b", true)], None);
    assert_eq!(verdicts, [Some(Verdict::Agrees)]);
    assert!((alone / shared - 2.0).abs() < 1e-9, "{alone} {shared}");
    let (both, verdicts) = alarms(&[question("a", false), question("b", false)], Some(1));
    assert_eq!(verdicts, [Some(Verdict::Agrees), None]);
    assert!((alone / both - 2.0).abs() < 1e-9, "{alone} {both}");
}
