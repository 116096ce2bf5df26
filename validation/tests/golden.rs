//! The list of all claims, what each comparison costs and which biases it must exclude, as it was
//! agreed: `claims.golden`. No claim vanishes or is loosened without a line of it changing.

use etalon_validation::claim::{Budget, Claim, Estimator, Oracle, pairs};
use etalon_validation::{convergence, folders};
use std::fmt::Write;

/// Set to rewrite the list.
const BLESS: &str = "ETALON_BLESS";

/// What to run after a change that is meant.
const COMMAND: &str = "ETALON_BLESS=1 cargo test -p etalon-validation --test golden";

/// Samples per pixel, and in how many replicates.
fn work(budget: Budget) -> String {
    format!("{}/{}", budget.spp, budget.replicates)
}

/// An estimator and its budgets, of the quick run and of the default run.
fn estimator(estimator: &Estimator) -> String {
    let [quick, default] = [estimator.quick, estimator.default].map(work);
    let pilot = estimator.adaptive.map(|spp| format!(", pilot of {spp}"));
    format!(
        "{} | {quick}, {default}{}",
        estimator.label(),
        pilot.unwrap_or_default()
    )
}

/// What is known of the picture, and how well.
fn oracle(claim: &Claim) -> String {
    let kind = claim.oracle.kind();
    match &claim.oracle {
        Oracle::ClosedForm { formula } | Oracle::Energy { formula } => format!("{kind} {formula}"),
        Oracle::Reference {
            spp,
            seeds,
            integrator,
        } => {
            let by = integrator.iter().map(|name| format!(" by {name}"));
            format!("{kind} {spp} x {seeds} seeds{}", by.collect::<String>())
        }
        Oracle::Agreement { estimator: of } | Oracle::Invariance { estimator: of } => {
            format!("{kind} {}", estimator(of))
        }
        Oracle::Convergence(ladder) => {
            let over = ladder.over.as_deref().unwrap_or("samples");
            format!("{kind} {} over {over} {:?}", ladder.formula, ladder.rungs)
        }
        Oracle::Noise {
            of,
            formula,
            seeds,
            tolerance,
        } => format!("{kind} {of:?} {formula}, {seeds} seeds, {tolerance}"),
        Oracle::Povray { edges, excused } => format!("{kind} edges {edges}, excused {excused}"),
    }
}

/// One line for the claim, one for each estimator, and one for each that is absent.
fn lines(claim: &Claim, text: &mut String) -> std::fmt::Result {
    let name = &claim.name;
    let runs = match (claim.quick, claim.full_only) {
        (_, true) => "full only",
        (true, false) => "quick",
        (false, false) => "default",
    };
    let bounds = claim.bounds;
    let defines: String = pairs(&claim.defines)
        .map(|(key, value)| format!(" {key}={value}"))
        .collect();
    writeln!(
        text,
        "{name}: {runs} | {} | image {}, tile {}, rounding {} | {}{defines}",
        oracle(claim),
        bounds.image,
        bounds.tile,
        bounds.rounding,
        claim.scene.display(),
    )?;
    for own in &claim.estimators {
        write!(text, "{name}: {}", estimator(own))?;
        if let Some(place) = own.in_matrix {
            let when = if place.later { ", full only" } else { "" };
            write!(text, " | matrix {}{when}", place.bound)?;
        }
        if let Some([low, high]) = own.exponent {
            write!(text, " | exponent {low} … {high}")?;
        }
        if own.part != convergence::Part::Whole {
            write!(text, " of {}", own.part.name())?;
        }
        for mutant in &own.mutants {
            write!(text, " | mutant {mutant}")?;
        }
        writeln!(text)?;
    }
    for absence in &claim.absent {
        writeln!(text, "{name}: {} is absent", absence.integrator)?;
    }
    Ok(())
}

fn list(claims: &[Claim]) -> String {
    let mut text = String::new();
    for claim in claims {
        lines(claim, &mut text).expect("texts can be written");
    }
    text
}

fn claims() -> Vec<Claim> {
    Claim::read_all(&folders::claims()).expect("claims can be read")
}

/// Lines of the one that the other has not.
fn missing<'a>(one: &'a str, other: &str) -> Vec<&'a str> {
    let other: Vec<&str> = other.lines().collect();
    one.lines().filter(|line| !other.contains(line)).collect()
}

#[test]
fn claims_are_those_that_were_agreed() {
    let path = folders::root().join("validation/tests/claims.golden");
    let found = list(&claims());
    if std::env::var_os(BLESS).is_some_and(|value| value == "1") {
        std::fs::write(&path, &found).expect("written");
    }
    let agreed = std::fs::read_to_string(&path).unwrap_or_default();
    let (gone, new) = (missing(&agreed, &found), missing(&found, &agreed));
    assert!(
        agreed == found,
        "claims are not those of validation/tests/claims.golden. Agreed, and not found:\n  {}\n\
         found, and not agreed:\n  {}\nIf that is meant: {COMMAND}",
        gone.join("\n  "),
        new.join("\n  "),
    );
}

#[test]
fn whatever_loosens_a_claim_changes_the_list() {
    // Mutants rejected: a list of names alone, or of claims without what they cost.
    let claims = claims();
    let sound = list(&claims);
    let changed = |name: &str, change: &dyn Fn(&mut Claim)| {
        let mut claims = claims.clone();
        let claim = claims.iter_mut().find(|claim| claim.name == name);
        change(claim.expect("a claim"));
        list(&claims) != sound
    };
    let every = |change: &dyn Fn(&mut Claim)| changed("irradiance-rectangle", change);
    assert!(list(&claims[1..]) != sound, "a claim vanishes");
    assert!(every(&|claim| claim.quick = false));
    assert!(every(&|claim| claim.full_only = true));
    assert!(every(&|claim| claim.bounds.rounding = 1e-3));
    assert!(every(&|claim| claim.bounds.tile = 0.5));
    assert!(every(&|claim| claim.defines.clear()));
    assert!(every(&|claim| claim.estimators[0].default.spp /= 2));
    assert!(every(&|claim| claim.estimators[0].quick.replicates = 2));
    assert!(every(&|claim| claim.estimators[0].mutants.clear()));
    assert!(every(&|claim| drop(claim.estimators.pop())));
    assert!(every(&|claim| {
        for place in claim
            .estimators
            .iter_mut()
            .filter_map(|e| e.in_matrix.as_mut())
        {
            place.later = true;
        }
    }));
    assert!(every(&|claim| {
        for place in claim
            .estimators
            .iter_mut()
            .filter_map(|e| e.in_matrix.as_mut())
        {
            place.bound *= 2.0;
        }
    }));
    assert!(changed("prism", &|claim| claim.absent.clear()));
    assert!(changed("cornell-box", &|claim| {
        claim.oracle = Oracle::Reference {
            spp: 1,
            seeds: 32,
            integrator: None,
        };
    }));
    assert!(changed("convergence-sobol", &|claim| {
        claim.estimators[0].exponent = Some([-9.0, -0.1]);
    }));
}
