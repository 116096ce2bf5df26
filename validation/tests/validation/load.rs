//! The same verdicts and numbers, whatever else the machine does.

use crate::decision::poor;
use etalon_validation::claim::Claim;
use etalon_validation::folders;
use etalon_validation::json::{self, Provenance};
use etalon_validation::outcome;
use etalon_validation::run::{self, Options};
use etalon_validation::tier::Tier;
use std::sync::atomic::{AtomicBool, Ordering};

/// A run's JSON without what tells of the machine: `seconds`, wherever they are, and `threads`.
fn without_times(mut value: serde_json::Value) -> serde_json::Value {
    match &mut value {
        serde_json::Value::Object(fields) => {
            fields.retain(|name, _| name != "seconds" && name != "threads");
            for field in fields.values_mut() {
                *field = without_times(field.take());
            }
        }
        serde_json::Value::Array(items) => {
            for item in items {
                *item = without_times(item.take());
            }
        }
        _ => {}
    }
    value
}

#[test]
fn a_slow_machine_comes_to_the_same_verdicts_and_numbers() {
    // A plan with a row that needs all its looks, once as fast as it goes and once on one thread that is held
    // up before every look, beside a busy loop. Mutant rejected: looks that end by a clock.
    let mut claims = poor(1e-4);
    claims.extend(
        Claim::read_named(&folders::claims(), Some("furnace")).expect("claims can be read"),
    );
    let options = Options {
        only: None,
        tier: Tier::Default,
        seed: 2,
        part: None,
    };
    let run = |pause: std::time::Duration| {
        let tasks = run::tasks(&claims, &options);
        let plan = run::RunPlan::of(&tasks, &options);
        let rows = outcome::run(tasks, &options, None, |_, _| std::thread::sleep(pause));
        let rows = rows.expect("a plan");
        let looks: Vec<usize> = rows.iter().map(|row| row.decision.looks).collect();
        let seconds = rows.iter().map(|row| row.decision.seconds).sum();
        let value = json::of(&rows, &Provenance::of(&options, plan, seconds));
        (looks, without_times(value))
    };
    let (looks, fast) = run(std::time::Duration::ZERO);
    assert_eq!(looks.iter().max(), Some(&Tier::Default.looks().len()));
    let busy = AtomicBool::new(true);
    let (_, slow) = std::thread::scope(|scope| {
        scope.spawn(|| {
            while busy.load(Ordering::Relaxed) {
                std::hint::spin_loop();
            }
        });
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        let slow = pool
            .expect("a pool")
            .install(|| run(std::time::Duration::from_millis(50)));
        busy.store(false, Ordering::Relaxed);
        slow
    });
    assert_eq!(fast, slow);
}
