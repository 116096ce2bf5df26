//! A full run goes on where it was interrupted, and takes up nothing but its own.

use etalon_validation::claim::Claim;
use etalon_validation::outcome;
use etalon_validation::run::{self, Options};
use etalon_validation::state::State;
use etalon_validation::tier::Tier;
use etalon_validation::{folders, rendering};

#[test]
fn an_interrupted_run_goes_on_with_the_same_result() {
    let folder = std::env::temp_dir().join(format!("etalon-state-{}", std::process::id()));
    let mut claims = Claim::read_all(&folders::claims()).expect("claims can be read");
    claims.retain(|claim| claim.name == "furnace");
    for estimator in &mut claims[0].estimators {
        estimator.default.spp = 256;
        estimator.mutants.clear();
    }
    let options = Options {
        only: None,
        tier: Tier::Full,
        seed: 5,
    };
    let bias = |state: &State| {
        let tasks = run::tasks(&claims, &options);
        let rows = outcome::run(tasks, &options, Some(state), |_| ()).expect("a plan");
        let compared = rows[0].compared.as_ref().expect("it can be compared");
        compared.judgement().expect("pictures").images[0].bias
    };
    let state = State::open(&folder, &options).expect("a folder");
    assert!(state.is_empty());
    let first = bias(&state);
    let kept = state.len();
    assert!(kept > 0);
    let again = State::open(&folder, &options).expect("the same folder");
    assert_eq!(bias(&again), first);
    assert_eq!(again.len(), kept, "nothing is rendered twice");

    // Another seed has a state of its own; a batch of another plan or half a file is not taken up.
    let estimator = &claims[0].estimators[0];
    let loaded = rendering::load_for(&claims[0], estimator).expect("a scene");
    let plan = rendering::plan(&loaded, estimator, estimator.default, options.seed);
    let name = "furnace-0-own-0";
    assert!(again.read(name, &plan, &loaded).is_some());
    let mut other = plan;
    other.seed += 1;
    assert!(again.read(name, &other, &loaded).is_none());
    other = plan;
    other.samples_per_replicate *= 2;
    assert!(again.read(name, &other, &loaded).is_none());
    let seed = Options { seed: 6, ..options };
    let elsewhere = State::open(&folder, &seed).expect("a folder");
    assert!(elsewhere.is_empty());
    for entry in std::fs::read_dir(&folder).expect("a folder") {
        let file = entry.expect("readable").path().join(format!("{name}.exr"));
        if let Ok(bytes) = std::fs::read(&file) {
            std::fs::write(&file, &bytes[..bytes.len() / 2]).expect("written");
        }
    }
    assert!(again.read(name, &plan, &loaded).is_none());
    again.finish().expect("removed");
    let _ = std::fs::remove_dir_all(&folder);
}
