//! The agreement matrix: every unbiased integrator against every oracle.
//!
//! A claim names the integrators that it is about. With a table `matrix` all others take part, too,
//! each as one more comparison of the thorough and the full run, unless they cannot render the
//! scene ([`etalon_render::pipeline::Loaded::complete`]): then the report says so, and why. A new
//! integrator is thus included in all these rows without further changes.
//!
//! ```toml
//! [matrix]
//! thorough = { spp = 256, replicates = 32 }
//! bound = 0.02                 # of the bias of the image's mean; half a per cent in a full run
//! without = { ptracer = "sees nothing in a mirror" }
//!
//! [matrix.later]               # too noisy here for the thorough run: in the full run only
//! naive = { spp = 4096, replicates = 32 }
//! ```
//!
//! `full_only = true` leaves all rows of a matrix to the full run. Rows of that run alone have its own
//! bound; if it makes all rows, there is no `bound` to state.

use crate::claim::{Claim, Estimator, Matrix, Oracle, Place, SkippedIntegrator};
use crate::rendering;
use crate::tier::{FULL_BOUND, Tier};
use etalon_integrators::list;
use etalon_render::pipeline::Loaded;

impl Matrix {
    /// Refuses a bound that is no share, or that is stated where a full run's holds.
    ///
    /// # Errors
    /// Says which.
    fn check(&self) -> Result<(), String> {
        match self.bound {
            Some(bound) if !(bound > 0.0 && bound < 1.0) => Err(format!(
                "`matrix`: a bound between 0 and 1 is expected, not {bound}"
            )),
            Some(_) if self.full_only => Err(without_bound("with `full_only`")),
            _ => Ok(()),
        }
    }

    /// What its rows must exclude if the full run alone makes them, or if the thorough run does, too.
    fn bound(&self, later: bool) -> Result<f64, String> {
        match self.bound {
            _ if later => Ok(FULL_BOUND),
            Some(bound) => Ok(bound),
            None => Err("`matrix`: `bound` is missing".to_owned()),
        }
    }
}

/// What to say of a bound that no row has.
fn without_bound(why: &str) -> String {
    format!("`matrix`: {why} there is no `bound`: a full run's is {FULL_BOUND} for every row")
}

impl Place {
    /// Whether a run makes the comparison.
    pub fn belongs_to(self, tier: Tier) -> bool {
        match tier {
            Tier::Default => false,
            Tier::Thorough => !self.later,
            Tier::Full => true,
        }
    }
}

/// Adds a claim's rows of the matrix to its estimators.
///
/// # Errors
/// If the matrix makes no sense.
pub(crate) fn expand(claim: &mut Claim) -> Result<(), String> {
    let Some(matrix) = &claim.matrix else {
        return Ok(());
    };
    if !matches!(
        claim.oracle,
        Oracle::ClosedForm { .. } | Oracle::Agreement { .. } | Oracle::Reference { .. }
    ) {
        return Err("`matrix` belongs to claims about pictures".to_owned());
    }
    let unbiased = list::unbiased();
    for name in matrix.without.keys().chain(matrix.later.keys()) {
        if !unbiased.contains(&name.as_str()) {
            return Err(format!(
                "`matrix`: there is no unbiased integrator `{name}`"
            ));
        }
    }
    let mut budgets = matrix.later.values().chain([&matrix.thorough]);
    let poor = budgets.any(|budget| budget.replicates < 2 || budget.spp < budget.replicates);
    if poor {
        return Err("`matrix`: a budget of at least 2 replicates".to_owned());
    }
    matrix.check()?;
    let listed = |name: &str| {
        let own = |e: &Estimator| e.integrator.as_deref().unwrap_or("path") == name;
        claim
            .estimators
            .iter()
            .any(|e| own(e) && e.defines.is_empty())
    };
    let oracle = match &claim.oracle {
        Oracle::Agreement { estimator } => Some(estimator.integrator.as_deref().unwrap_or("path")),
        _ => None,
    };
    let defines = rendering::defines(claim, None);
    let (mut rows, mut absent) = (Vec::new(), Vec::new());
    for name in unbiased {
        if listed(name) || oracle == Some(name) {
            continue;
        }
        let reason = match matrix.without.get(name) {
            Some(reason) => Some(reason.clone()),
            None => objection(rendering::load(claim, &defines, Some(name)), || {
                rendering::load(claim, &defines, None).map(drop)
            })?,
        };
        if let Some(reason) = reason {
            absent.push(SkippedIntegrator {
                integrator: name.to_owned(),
                reason,
            });
            continue;
        }
        let own = matrix.later.get(name);
        let budget = *own.unwrap_or(&matrix.thorough);
        let later = matrix.full_only || own.is_some();
        rows.push(Estimator {
            adaptive: None,
            blocks: false,
            scene: None,
            integrator: Some(name.to_owned()),
            sampler: None,
            light_chooser: None,
            defines: Default::default(),
            default: None,
            thorough: budget,
            change: None,
            exponent: None,
            part: Default::default(),
            mutants: Vec::new(),
            in_matrix: Some(Place {
                bound: matrix.bound(later)?,
                later,
            }),
        });
    }
    let later = |row: &Estimator| row.in_matrix.is_some_and(|place| place.later);
    if matrix.bound.is_some() && rows.iter().all(later) {
        return Err(without_bound(
            "where the thorough run makes none of its rows",
        ));
    }
    claim.estimators.extend(rows);
    claim.absent = absent;
    Ok(())
}

/// What an integrator objects to in a scene, if anything, in a line. A scene that does not load with
/// its own integrator either, as `sound` tells, is objected to by nobody: it is wrong.
///
/// # Errors
/// The scene's mistakes.
fn objection(
    loaded: Result<Loaded, String>,
    sound: impl FnOnce() -> Result<(), String>,
) -> Result<Option<String>, String> {
    Ok(match loaded {
        Ok(loaded) if loaded.complete => None,
        Ok(loaded) => {
            let notes: Vec<&str> = loaded.notes.iter().map(|n| n.message.as_str()).collect();
            Some(notes.join("; "))
        }
        Err(mistakes) => {
            sound()?;
            let first = mistakes.lines().next().unwrap_or_default();
            let message = first
                .split_once(": error: ")
                .map_or(first, |(_, text)| text);
            Some(message.to_owned())
        }
    })
}
