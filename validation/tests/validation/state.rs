//! A full run goes on where it was interrupted, and takes up nothing but its own.

use crate::claims::claims;
use etalon_validation::claim::{Budget, Claim, Oracle};
use etalon_validation::outcome;
use etalon_validation::run::{self, Options};
use etalon_validation::state::State;
use etalon_validation::tier::Tier;
use etalon_validation::{folders, rendering};

#[test]
fn an_interrupted_run_goes_on_with_the_same_result() {
    let folder = std::env::temp_dir().join(format!("etalon-state-{}", std::process::id()));
    let mut claims = claims();
    claims.retain(|claim| claim.name == "furnace");
    for estimator in &mut claims[0].estimators {
        estimator.thorough.spp = 256;
        estimator.mutants.clear();
    }
    let options = Options {
        only: None,
        tier: Tier::Full,
        seed: 5,
        part: None,
    };
    let bias = |claims: &[Claim], state: &State| {
        let tasks = run::tasks(claims, &options);
        let rows = outcome::run(tasks, &options, Some(state), |_, _| ()).expect("a plan");
        let compared = rows[0].compared.as_ref().expect("it can be compared");
        compared.judgement().expect("pictures").images[0].bias
    };
    let state = State::open(&folder, &options).expect("a folder");
    assert!(state.is_empty());
    let first = bias(&claims, &state);
    let kept = state.len();
    assert!(kept > 0);
    let again = State::open(&folder, &options).expect("the same folder");
    assert_eq!(bias(&claims, &again), first);
    assert_eq!(again.len(), kept, "nothing is rendered twice");

    // Nor is the batch of an estimator that has been edited since, though its plan and scene are the same.
    let mut edited = claims.clone();
    edited[0].estimators[0].adaptive = Some(16);
    bias(&edited, &again);
    assert_eq!(again.len(), kept + 1);

    // Another seed has a state of its own; a batch of another plan or half a file is not taken up.
    let estimator = &claims[0].estimators[0];
    let loaded = rendering::load_for(&claims[0], estimator).expect("a scene");
    let plan = rendering::plan(&loaded, estimator, estimator.thorough, options.seed);
    let files = std::fs::read_dir(again.folder()).expect("a folder");
    let name = files
        .map(|file| file.expect("readable").path())
        .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
        .find(|name| name.starts_with("furnace-0-own-0-"))
        .expect("the first estimator's batch");
    let name = name.as_str();
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

#[test]
fn the_oracle_of_several_estimators_is_rendered_once() {
    let folder = std::env::temp_dir().join(format!("etalon-oracle-{}", std::process::id()));
    let mut claims = claims();
    claims.retain(|claim| claim.name == "camera-obscura-naive");
    // One look shall do, at all estimators.
    claims[0].bounds.image = 0.5;
    let budget = claims[0].estimators[0].default;
    let budget = budget.map(|budget| Budget {
        bound: None,
        ..budget
    });
    for estimator in &mut claims[0].estimators {
        estimator.default = budget;
    }
    let options = Options {
        only: Some("camera-obscura-naive".to_owned()),
        tier: Tier::Default,
        seed: 5,
        part: None,
    };
    let tasks = run::tasks(&claims, &options);
    let estimators = tasks.len();
    assert!(estimators > 1);
    let state = State::open(&folder, &options).expect("a folder");
    let shared = outcome::run(tasks, &options, Some(&state), |_, _| ()).expect("a plan");
    // One batch each, and the oracle's. Mutant rejected: an oracle that is told from the next one's by the estimator.
    assert!(shared.iter().all(|row| row.decision.looks == 1));
    assert_eq!(state.len(), estimators + 1);
    // It is the picture that each would have had alone, without any folder, too.
    for row in &shared {
        let mut one = vec![row.task.claim.clone()];
        one[0].estimators = vec![row.task.estimator.clone()];
        let alone = outcome::run(run::tasks(&one, &options), &options, None, |_, _| ());
        let alone = alone.expect("a plan").remove(0);
        let bias = |row: &outcome::Row<'_>| {
            let compared = row.compared.as_ref().expect("it can be compared");
            compared.judgement().expect("pictures").images[0].bias
        };
        assert_eq!(bias(&alone), bias(row));
    }
    let _ = std::fs::remove_dir_all(&folder);
}

#[test]
fn replicates_of_a_noise_claim_are_those_of_all_its_pictures() {
    // Its samples are. Mutant rejected: replicates of one picture, of which each would have as many
    // samples as there are pictures.
    let claim = Claim::read(&folders::claims().join("noise-furnace.toml")).expect("a claim");
    let mut claims = vec![claim];
    claims[0].estimators.truncate(1);
    let estimator = &mut claims[0].estimators[0];
    estimator.mutants.clear();
    estimator.default = Some(Budget {
        spp: 32,
        replicates: 8,
        bound: None,
    });
    let Oracle::Noise(counting) = &mut claims[0].oracle else {
        panic!("a claim about noise");
    };
    counting.seeds = 3;
    let options = Options {
        only: None,
        tier: Tier::Default,
        seed: 5,
        part: None,
    };
    let rows = outcome::run(run::tasks(&claims, &options), &options, None, |_, _| ());
    for look in &rows.expect("a plan")[0].history {
        assert_eq!(look.spp, u64::from(look.replicates) * 4);
        assert_eq!(look.replicates % (3 * 8), 0);
    }
}
