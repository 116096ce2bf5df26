//! The table `matrix` of a claim, and the rows that it becomes ([`crate::matrix`]).

use super::budget::Budget;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// How all unbiased integrators are held against a claim's oracle.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Matrix {
    /// Work of the thorough run for each.
    pub thorough: Budget,
    /// Which bias of the image's mean the thorough run must exclude, relative to it; stated unless
    /// the full run alone makes all rows.
    pub bound: Option<f64>,
    /// Whether only a full run makes these comparisons, with `thorough` for its first look.
    #[serde(default)]
    pub full_only: bool,
    /// Integrators that cannot render the scene, though they do not object, and why.
    #[serde(default)]
    pub without: BTreeMap<String, String>,
    /// Integrators that only a full run asks, and their work at its first look.
    #[serde(default)]
    pub later: BTreeMap<String, Budget>,
}

/// An unbiased integrator that has no row of its own in a claim's matrix.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SkippedIntegrator {
    /// Its name.
    pub integrator: String,
    /// What it objects to in the scene, or what the claim says of it.
    pub reason: String,
}

/// A row of the matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Which bias of the image's mean the first run that makes the comparison must exclude, relative
    /// to it.
    pub bound: f64,
    /// Whether only a full run makes the comparison.
    pub later: bool,
}
