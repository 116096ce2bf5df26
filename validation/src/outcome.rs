//! What became of a run: every comparison's outcome, corrected over all of them.
//!
//! The error level of the whole run, α = 10⁻³, is the probability that a run without any fault
//! in the renderer shows a failure. Intervals and questions of equivalence share it equally
//! (Bonferroni: each comparison decides at α over the number of comparisons); the p-values of
//! exact null hypotheses (closed forms, Etalon against itself) go through Holm's procedure.

use crate::run::{Compared, Task};
use etalon_statistics::{Family, Verdict};
use serde::Serialize;

/// The probability that a run without faults shows a failure.
pub const ALPHA: f64 = 1e-3;

/// What a comparison came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// It agrees; or it has a planted fault, which was found.
    Passed,
    /// It differs; or a planted fault was not found.
    Failed,
    /// There were too few samples to say.
    Undecided,
    /// The comparison could not be made.
    Broken,
}

impl std::fmt::Display for Outcome {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Passed => "passed",
            Self::Failed => "FAILED",
            Self::Undecided => "UNDECIDED",
            Self::Broken => "BROKEN",
        })
    }
}

/// A comparison and what it came to.
pub struct Row<'a> {
    /// What was compared.
    pub task: Task<'a>,
    /// The comparison, or why it could not be made.
    pub compared: Result<Compared, String>,
    /// The p-value of equality, corrected over the whole run; for exact null hypotheses.
    pub p_corrected: Option<f64>,
    /// Agrees, differs or undecided, corrected over the whole run.
    pub verdict: Option<Verdict>,
    /// What that means.
    pub outcome: Outcome,
}

/// Decides all comparisons of a run together.
pub fn decide<'a>(compared: Vec<(Task<'a>, Result<Compared, String>)>) -> Vec<Row<'a>> {
    let corrected = corrected_p_values(&compared);
    compared
        .into_iter()
        .zip(corrected)
        .map(|((task, compared), p_corrected)| {
            let verdict = compared.as_ref().ok().map(|compared| {
                let judged = compared.judgement.verdict;
                match p_corrected {
                    Some(p) if p <= ALPHA => Verdict::Differs,
                    _ => judged,
                }
            });
            let outcome = match (verdict, task.fault) {
                (None, _) => Outcome::Broken,
                (Some(Verdict::Agrees), None) | (Some(Verdict::Differs), Some(_)) => {
                    Outcome::Passed
                }
                (Some(Verdict::Undecided), None) => Outcome::Undecided,
                (Some(_), _) => Outcome::Failed,
            };
            Row {
                task,
                compared,
                p_corrected,
                verdict,
                outcome,
            }
        })
        .collect()
}

/// Holm's corrected p-values of the exact null hypotheses. Planted faults are another family:
/// their hypotheses are known to be false.
fn corrected_p_values(compared: &[(Task<'_>, Result<Compared, String>)]) -> Vec<Option<f64>> {
    let mut corrected = vec![None; compared.len()];
    for with_fault in [false, true] {
        let Some(mut family) = Family::new(ALPHA) else {
            continue;
        };
        let mut places = Vec::new();
        for (place, (task, compared)) in compared.iter().enumerate() {
            let Ok(compared) = compared else { continue };
            let belongs = task.fault.is_some() == with_fault && task.claim.oracle.is_exact();
            if belongs
                && family
                    .push(&task.claim.name, compared.judgement.p_exact)
                    .is_ok()
            {
                places.push(place);
            }
        }
        for (place, decision) in places.into_iter().zip(family.decide()) {
            corrected[place] = Some(decision.adjusted);
        }
    }
    corrected
}

/// How many rows came to each outcome: passed, failed, undecided, broken.
pub fn counts(rows: &[Row<'_>]) -> [usize; 4] {
    [
        Outcome::Passed,
        Outcome::Failed,
        Outcome::Undecided,
        Outcome::Broken,
    ]
    .map(|outcome| rows.iter().filter(|row| row.outcome == outcome).count())
}
