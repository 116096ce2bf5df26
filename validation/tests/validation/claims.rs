//! What every claim must be: readable, about a scene that is there, with a reference that belongs
//! to the scene's present state, and a number of mutants over all of them.

use etalon_validation::claim::{Claim, Counting, Ladder, Oracle, Sampler};
use etalon_validation::tier::{FULL_BOUND, Tier};
use etalon_validation::{closed_form, folders, povray, reference, run};
use std::collections::BTreeSet;
use std::sync::OnceLock;

/// All claims. They are read once, as every scene is asked what each integrator objects to.
pub(crate) fn claims() -> Vec<Claim> {
    static ALL: OnceLock<Vec<Claim>> = OnceLock::new();
    let read = || Claim::read_all(&folders::claims()).expect("claims can be read");
    ALL.get_or_init(read).clone()
}

#[test]
fn scenes_load_and_oracles_belong_to_them() {
    for claim in claims() {
        let name = &claim.name;
        let loaded = run::load(&claim, &run::defines(&claim, None), None)
            .unwrap_or_else(|message| panic!("{name}: {message}"));
        let size = loaded.compiled.film.crop_size.to_array();
        match &claim.oracle {
            Oracle::ClosedForm { formula }
            | Oracle::Energy { formula }
            | Oracle::Convergence(Ladder { formula, .. })
            | Oracle::Noise(Counting { formula, .. }) => {
                let pixels = (size[0] * size[1]) as usize;
                for estimator in &claim.estimators {
                    let known = closed_form::picture(formula, &claim, estimator, size)
                        .unwrap_or_else(|message| panic!("{name}: {message}"));
                    for (channel, values) in &known.channels {
                        assert_eq!(values.len(), pixels, "{name}, {channel}");
                        assert!(values.iter().all(|v| v.is_finite()), "{name}, {channel}");
                    }
                }
            }
            Oracle::Reference { seeds, .. } => {
                let picture =
                    reference::read(&claim).unwrap_or_else(|message| panic!("{name}: {message}"));
                let metadata = picture.metadata.expect("references have statistics");
                assert_eq!(metadata.replicates, *seeds, "{name}");
                assert_eq!(metadata.film.crop_size, size, "{name}");
                assert!(size.iter().all(|n| *n <= 192), "{name} is too large");
                assert!(*seeds >= 32, "{name} has too few seeds");
            }
            Oracle::Povray { .. } => {
                let twins = povray::twins(&claim).unwrap_or_else(|e| panic!("{name}: {e}"));
                povray::read_in(&folders::references(), name, &twins)
                    .unwrap_or_else(|message| panic!("{name}: {message}"));
                assert!(size.iter().all(|n| *n <= 256), "{name} is too large");
            }
            Oracle::Agreement { .. } | Oracle::Invariance { .. } => {}
        }
    }
}

/// Who stands in the matrix, and who objects: `forward` needs a lens that it can hit, `naive` lamps
/// that it can. Mutants: objections that are not asked for, rows in the default run.
#[test]
fn the_matrix_asks_all_who_do_not_object() {
    let claims = claims();
    let names = |claim: &str, tier| -> Vec<String> {
        let options = run::Options {
            only: Some(claim.to_owned()),
            tier,
            seed: 1,
            part: None,
        };
        let tasks = run::tasks(&claims, &options);
        let rows = tasks.iter().filter(|t| t.estimator.in_matrix.is_some());
        rows.filter_map(|t| t.estimator.integrator.clone())
            .collect()
    };
    let rectangle = names("irradiance-rectangle", Tier::Thorough);
    for name in ["naive", "bdpt", "ptracer"] {
        assert!(rectangle.iter().any(|n| n == name), "{name}");
    }
    // The claim's own estimator is no second row.
    assert!(!rectangle.iter().any(|n| n == "forward" || n == "path"));
    let point = names("irradiance-point", Tier::Thorough);
    assert!(point.iter().any(|n| n == "bdpt") && !point.iter().any(|n| n == "naive"));
    assert_eq!(names("irradiance-rectangle", Tier::Default), [""; 0]);
    // Who does not take part is told, and why: nothing vanishes.
    for (claim, integrator, why) in [
        ("irradiance-point", "naive", "running into them"),
        ("mirror-room", "ptracer", "smooth"),
        ("prism", "ptracer", "smooth"),
        ("furnace", "mmlt", "max_depth"),
    ] {
        let claim = claims.iter().find(|c| c.name == claim).expect("a claim");
        let absence = claim.absent.iter().find(|a| a.integrator == integrator);
        let reason = &absence.expect("an absence").reason;
        assert!(reason.contains(why), "{integrator}: {reason}");
        let unbiased = etalon_integrators::list::unbiased();
        let present = unbiased.iter().filter(|name| {
            let own = |e: &&etalon_validation::claim::Estimator| {
                e.integrator.as_deref().unwrap_or("path") == **name
            };
            claim.estimators.iter().any(|e| own(&e))
        });
        assert_eq!(
            present.count() + claim.absent.len(),
            unbiased.len(),
            "{}",
            claim.name
        );
    }
    // What a claim leaves to the full run.
    let has = |tier| names("prism", tier).iter().any(|n| n == "mmlt");
    assert!(has(Tier::Full) && !has(Tier::Thorough));
}

/// The most samples that the first looks of a default run may take, over all pixels, as each comparison would
/// take them by itself: two cores need somewhat less than three minutes, further looks included.
const DEFAULT_SAMPLES: f64 = 4.5e8;

#[test]
fn the_default_run_decides_every_claim_within_its_budget() {
    // Mutant rejected: a claim that it forgets (but for those of the full run alone); a budget that nobody adds up.
    let claims = claims();
    let options = run::Options {
        only: None,
        tier: Tier::Default,
        seed: 1,
        part: None,
    };
    let tasks = run::tasks(&claims, &options);
    let made: BTreeSet<&str> = tasks.iter().map(|t| t.claim.name.as_str()).collect();
    let left_out = claims.iter().filter(|c| !made.contains(c.name.as_str()));
    assert!(left_out.clone().all(|c| c.full_only));
    assert!(left_out.count() < 8, "few claims wait for the full run");
    let samples: f64 = tasks.iter().map(|task| task.samples(options.tier)).sum();
    assert!(
        samples < DEFAULT_SAMPLES,
        "{samples:.2e} samples are declared"
    );
    let more = Tier::Thorough;
    let options = run::Options {
        tier: more,
        ..options
    };
    let thorough: f64 = (run::tasks(&claims, &options).iter())
        .map(|t| t.samples(more))
        .sum();
    assert!(thorough > 2.0 * samples, "{thorough:.2e}");
}

#[test]
fn what_edges_excuse_is_what_was_agreed() {
    let mut found = Vec::new();
    for claim in claims() {
        let Oracle::Povray { edges, excused } = claim.oracle else {
            continue;
        };
        // One pixel in 2000 at most, and no noise to hide behind.
        assert_eq!(excused, 0.0005, "{}", claim.name);
        found.push(format!("{}: {edges}", claim.name));
        for estimator in &claim.estimators {
            assert_eq!(
                estimator.sampler,
                Some(Sampler::Midpoints),
                "{}",
                claim.name
            );
            for budget in [estimator.least_budget(), estimator.thorough] {
                let points = budget.spp / budget.replicates;
                assert!([1, 36].contains(&points), "{}: {points}", claim.name);
            }
        }
        let mutants = claim.estimators.iter().any(|e| !e.mutants.is_empty());
        assert!(mutants && !claim.full_only, "{}", claim.name);
    }
    assert_eq!(
        found,
        [
            "povray-checkerboard: 0.3",
            "povray-formulas: 0.17",
            "povray-fresnel: 0.21",
            "povray-hard-shadows: 0.22",
            "povray-meshes: 0.12",
            "povray-mirrors: 0.4",
            "povray-parallel-light: 0.18",
            "povray-phong-lamps: 0.21",
            "povray-profiles: 0.18",
            "povray-refraction: 0.42",
            "povray-signature-orthographic: 0.12",
            "povray-signature-perspective: 0.12",
            "povray-signature-transforms: 0.12",
            "povray-soft-shadow: 0.18",
            "povray-solids: 0.15",
            "povray-spheres: 0.12",
            "povray-transforms: 0.18",
        ]
    );
}

#[test]
fn every_kind_of_claim_has_a_mutant() {
    for kind in [
        "closed_form",
        "reference",
        "agreement",
        "energy",
        "invariance",
        "convergence",
        "noise",
        "povray",
    ] {
        let mutants = |claim: &Claim| claim.estimators.iter().any(|e| !e.mutants.is_empty());
        let any = claims()
            .iter()
            .any(|claim| claim.oracle.kind() == kind && mutants(claim));
        assert!(any, "no claim of kind {kind} has a mutant");
    }
}

#[test]
fn every_fault_is_planted_somewhere() {
    let planted: BTreeSet<String> = claims()
        .iter()
        .flat_map(|claim| claim.estimators.iter().flat_map(|e| &e.mutants))
        .map(ToString::to_string)
        .collect();
    let expected = [
        "another seed",
        "dropped cosine",
        "energy x 1.01",
        "energy x 1.02",
        "energy x 1.2",
        "independent samples",
        "mirrored",
        "shifted by a pixel",
        "standard error / sqrt 2",
        "wrong light density",
    ];
    assert_eq!(planted, expected.map(str::to_owned).into());
}

#[test]
fn a_wrong_claim_says_what_is_wrong() {
    let folder = std::env::temp_dir().join(format!("etalon-claims-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let path = folder.join("wrong.toml");
    let good = "title = \"t\"\nscene = \"s.xml\"\noracle = { kind = \"reference\", spp = 4 }\n\
                [[estimators]]\ndefault = { spp = 4, replicates = 2 }\nthorough = { spp = 4, replicates = 2 }\n";
    let matrix =
        |more: &str| format!("{good}[matrix]\nthorough = {{ spp = 4, replicates = 2 }}\n{more}\n");
    let cases = [
        (good.replace("title", "tilte"), "tilte"),
        (good.replace("\"reference\"", "\"hearsay\""), "hearsay"),
        (
            good.replace(
                "\"reference\", spp = 4",
                "\"povray\", edges = 0.1, excused = 0.2",
            ),
            "`excused`",
        ),
        (
            good.replace("replicates = 2", "replicates = 1"),
            "even number of replicates",
        ),
        (good.replace("[[estimators]]", "[estimator]"), "estimator"),
        (
            good.replace(
                "[[estimators]]\ndefault = { spp = 4, replicates = 2",
                "[[estimators]]\ndefault = { spp = 4, replicates = 2, bound = 0.001",
            ),
            "wider than the claim's own",
        ),
        // Mutant rejected: a claim that the default run leaves out without a word.
        (
            good.replace("default = { spp = 4, replicates = 2 }\n", ""),
            "`full_only`",
        ),
        (
            good.replace("thorough =", "exponent = [-1.0, -2.0]\nthorough ="),
            "exponent",
        ),
        (
            good.replace("thorough =", "change = \"threads\"\nthorough ="),
            "change",
        ),
        (
            good.replace(
                "[[estimators]]",
                "bounds = { image = -1.0 }\n[[estimators]]",
            ),
            "bounds",
        ),
        (
            good.replace(
                "[[estimators]]",
                "bounds = { rounding = 0.01 }\n[[estimators]]",
            ),
            "rounding",
        ),
        (
            good.replace(
                "[[estimators]]",
                "bounds = { rounding = -1e-6 }\n[[estimators]]",
            ),
            "rounding",
        ),
        // Mutant rejected: a scene that is not there as everybody's objection to it.
        (matrix("bound = 0.02"), "s.xml"),
        (matrix("full_only = true"), "s.xml"),
        (matrix("bound = 2"), "between 0 and 1"),
        (
            matrix("bound = 0.02\nfull_only = true"),
            "there is no `bound`",
        ),
    ];
    for (text, expected) in cases {
        std::fs::write(&path, text).expect("written");
        let message = Claim::read(&path).expect_err("it is wrong");
        assert!(
            Claim::read_all(&folder).is_err(),
            "one wrong claim stops the run"
        );
        assert!(message.contains("wrong.toml"), "{message}");
        assert!(message.contains(expected), "{message}");
    }
    // Mutant rejected: a claim that is asked for by its name waits for the scenes of the others.
    std::fs::write(&path, matrix("bound = 0.02")).expect("written");
    std::fs::write(folder.join("right.toml"), good).expect("written");
    let named = |name| Claim::read_named(&folder, Some(name));
    assert_eq!(named("right").expect("it is right")[0].name, "right");
    assert!(named("wrong").expect_err("its scene").contains("s.xml"));
    assert!(named("rihgt").expect_err("a slip").contains("right"));
    std::fs::write(&path, good).expect("written");
    Claim::read(&path).expect("it is right");
    std::fs::remove_dir_all(&folder).expect("removed");
}

/// What is said of a claim of ours after a change of its text.
fn said_of(name: &str, change: impl FnOnce(String) -> String) -> Result<Claim, String> {
    let path = folders::claims().join(format!("{name}.toml"));
    let text = change(std::fs::read_to_string(&path).expect("a claim"));
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(format!("{name}.toml"));
    std::fs::write(&path, text).expect("written");
    Claim::read(&path)
}

#[test]
fn bounds_are_stated_where_they_are_asked_for() {
    // Mutant rejected: bounds that nobody looks at.
    for name in [
        "noise-furnace",
        "convergence-sobol",
        "povray-spheres",
        "invariance-bits",
    ] {
        said_of(name, |text| text).expect("it is right");
        let stated = said_of(name, |text| text + "\n[bounds]\nimage = 0.005\n");
        let message = stated.expect_err("it has bounds");
        assert!(message.contains("`bounds` belong to"), "{name}: {message}");
    }
    said_of("invariance-wavelengths", |text| {
        text + "\n[bounds]\nimage = 0.005\n"
    })
    .expect("statistics have bounds");
}

#[test]
fn a_matrix_states_the_bound_of_its_rows_in_the_thorough_run_and_no_other() {
    let name = "material-plastic";
    let claim = said_of(name, |text| text).expect("it is right");
    let places = |later| {
        let places = claim.estimators.iter().filter_map(|e| e.in_matrix);
        places.filter(move |place| place.later == later)
    };
    // Mutant rejected: the thorough run's bound for rows that it does not make.
    assert!(places(true).count() > 0 && places(true).all(|place| place.bound == FULL_BOUND));
    assert!(places(false).count() > 0);
    let bound = claim.matrix.as_ref().and_then(|matrix| matrix.bound);
    assert!(places(false).all(|place| Some(place.bound) == bound));
    let line = format!("bound = {}\n", bound.expect("stated"));
    let missing = said_of(name, |text| text.replace(&line, ""));
    let message = missing.expect_err("no bound");
    assert!(message.contains("`bound` is missing"), "{message}");
    // Everybody is left to the full run, one by one. Mutant rejected: a bound of no row.
    let everybody = |text: String| {
        let waiting = claim.estimators.iter();
        let waiting = waiting.filter(|e| e.in_matrix.is_some_and(|place| !place.later));
        let waiting: String = waiting
            .filter_map(|e| e.integrator.as_deref())
            .map(|name| format!("{name} = {{ spp = 64, replicates = 32 }}\n"))
            .collect();
        text.replace("[matrix.later]\n", &format!("[matrix.later]\n{waiting}"))
    };
    let message = said_of(name, everybody).expect_err("a bound of no row");
    assert!(message.contains("there is no `bound`"), "{message}");
    said_of(name, |text| everybody(text).replace(&line, "")).expect("it is right");
}

#[test]
fn the_list_says_whether_the_default_run_decides_a_claim() {
    // Mutant rejected: a claim that only the full run makes is said to be decided by default.
    let mut claims = claims();
    claims.truncate(1);
    for full_only in [false, true] {
        let decides = !full_only;
        claims[0].full_only = full_only;
        let list = etalon_validation::json::list(&claims);
        assert_eq!(list["claims"][0]["default"], decides);
        let options = run::Options {
            only: None,
            tier: Tier::Default,
            seed: 1,
            part: None,
        };
        assert_eq!(!run::tasks(&claims, &options).is_empty(), decides);
    }
}
