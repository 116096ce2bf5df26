//! The decision as JSON, and where its numbers come from. `docs/validation-json.md` describes it;
//! a test holds that page to what is written here.

use crate::claim::{Claim, Oracle};
use crate::outcome::{ALPHA, Conclusion, FALSE_POSITIVE_LEVEL, Row, counts};
use crate::run::{Compared, Evidence, Options, RunPlan};
use crate::{folders, povray, program, reference, table};
use serde::Serialize;
use serde_json::{Value, json};

/// The version of the description.
pub const FORMAT: u32 = 5;

/// Where a run's numbers come from.
#[derive(Clone, Debug, Serialize)]
pub struct Provenance {
    /// The version of the program.
    pub version: String,
    /// What tells its build from others, if it could be read.
    pub program: Option<String>,
    /// The fingerprint of its floating-point arithmetic.
    pub floating_point: String,
    /// Operating system and processor family.
    pub machine: String,
    /// Threads.
    pub threads: usize,
    /// The seed of everything.
    pub seed: u64,
    /// Default, thorough or full.
    pub tier: &'static str,
    /// Which part of the run this is, as I/N, if it is not the whole.
    pub part: Option<String>,
    /// Comparisons of the whole run, those of its other parts included.
    pub hypotheses: usize,
    /// What tells their plan from others: parts of one run have the same.
    pub plan: String,
    /// Seconds of the whole run.
    pub seconds: f64,
}

impl Provenance {
    /// Of a run on this machine.
    pub fn of(options: &Options, plan: RunPlan, seconds: f64) -> Self {
        Self {
            version: etalon_render::VERSION.to_owned(),
            program: program::fingerprint().ok().map(str::to_owned),
            floating_point: etalon_film::floating_point_fingerprint(),
            machine: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            threads: rayon::current_num_threads(),
            seed: options.seed,
            tier: options.tier.name(),
            part: options.part.map(|part| part.to_string()),
            hypotheses: plan.hypotheses,
            plan: plan.hash,
            seconds,
        }
    }
}

/// The command that makes a row's pictures again.
pub fn command(row: &Row<'_>, provenance: &Provenance) -> String {
    let tier = match provenance.tier {
        "default" => String::new(),
        other => format!(" --{other}"),
    };
    let (name, seed) = (&row.task.claim.name, provenance.seed);
    format!("cargo xtask validate{tier} --only {name} --seed {seed}")
}

/// The whole run.
pub fn of(rows: &[Row<'_>], provenance: &Provenance) -> Value {
    let [passed, failed, undecided, broken] = counts(rows);
    let [below, asked] = table::bounded(rows);
    let conclusion = Conclusion::of(rows);
    json!({
        "format": FORMAT,
        "provenance": provenance,
        "alpha": ALPHA,
        "alarm": FALSE_POSITIVE_LEVEL,
        "exit_code": conclusion.exit_code(),
        "counts": {
            "passed": passed, "failed": failed, "undecided": undecided, "broken": broken,
        },
        "bounded_below_half_per_cent": { "rows": below, "of": asked },
        "absent": table::absent(rows).into_iter().map(|(claim, absence)| json!({
            "claim": claim, "integrator": absence.integrator, "reason": absence.reason,
        })).collect::<Vec<_>>(),
        "rows": rows.iter().map(|row| self::row(row, provenance)).collect::<Vec<_>>(),
    })
}

/// How a claim's reference was made, by either program.
pub(crate) fn reference(claim: &Claim) -> Option<Value> {
    match claim.oracle {
        Oracle::Reference { .. } => reference::provenance(&claim.name).ok().map(|p| json!(p)),
        Oracle::Povray { .. } => {
            let made = povray::provenance(&folders::references(), &claim.name);
            made.ok().map(|p| json!(p))
        }
        _ => None,
    }
}

fn row(row: &Row<'_>, provenance: &Provenance) -> Value {
    let compared = row.compared.as_ref();
    let refusals = compared.ok().and_then(|c| match &c.evidence {
        Evidence::Pictures { refusals, .. } => Some(refusals),
        Evidence::Measures(_) => None,
    });
    json!({
        "claim": row.task.claim.name,
        "title": row.task.claim.title,
        "kind": row.task.claim.oracle.kind(),
        "scene": row.task.claim.scene,
        "scene_hash": compared.map(|c| &c.scene_hash).ok(),
        "estimator": row.task.estimator.label(),
        "mutant": row.task.fault.map(|fault| fault.to_string()),
        "command": command(row, provenance),
        "reference": reference(row.task.claim),
        "spp": compared.map(|c| c.spp).ok(),
        "replicates": compared.map(|c| c.replicates).ok(),
        "looks": row.decision.looks,
        "level": row.decision.level,
        "seconds": row.decision.seconds,
        "p_corrected": row.decision.p_corrected,
        "bias_bound": compared.ok().and_then(|compared| compared.bias_bound),
        "verdict": row.decision.verdict.map(|v| v.to_string()),
        "in_doubt": row.decision.in_doubt,
        "outcome": row.outcome,
        "judgement": compared.ok().and_then(Compared::judgement),
        "measures": compared.map(Compared::measures).ok(),
        "refusals": refusals,
        "history": row.history,
        "fall": compared.ok().and_then(|c| c.fall.as_ref()),
        "error": compared.err(),
    })
}

/// The claims of a run, without running it.
pub fn list(claims: &[Claim]) -> Value {
    let claims: Vec<Value> = claims
        .iter()
        .map(|claim| {
            json!({
                "claim": claim.name,
                "title": claim.title,
                "kind": claim.oracle.kind(),
                "scene": claim.scene,
                "default": !claim.full_only,
                "estimators": claim.estimators.iter().map(|e| json!({
                    "estimator": e.label(),
                    "default": !claim.full_only && e.default.is_some(),
                    "mutants": e.mutants.iter().map(ToString::to_string).collect::<Vec<_>>(),
                })).collect::<Vec<_>>(),
            })
        })
        .collect();
    json!({ "format": FORMAT, "claims": claims })
}
