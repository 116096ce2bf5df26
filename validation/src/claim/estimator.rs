//! How a claim's picture is rendered: an estimator, its budgets, and the faults that must be found in it.

use super::budget::Budget;
use super::matrix::Place;
use super::sampler::Sampler;
use crate::fault::PlantedFault;
use etalon_render::decide::convergence::Part;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// What an invariance claim changes, beside an estimator's parameters.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Change {
    /// 1, 2 and 16 threads: the same bits.
    Threads,
    /// The replicates' two halves one after the other or the other way round: the same bits.
    Order,
    /// Rendered in parts, which pass through files and are merged: the same bits.
    Parts,
    /// A linear scan for the hierarchy of boxes: the same bits.
    Accelerator,
    /// A part of the film for the whole, as the estimator's `defines` cut it out: the same bits in
    /// every pixel of the part.
    Crop,
    /// Another seed: no replicate is like any other, of either picture.
    Seed,
    /// Another of the four wavelengths of each path chooses: the same statistics.
    Wavelengths,
}

impl Change {
    /// Whether it is judged by bits, and not by statistics.
    pub fn is_of_bits(self) -> bool {
        self != Self::Wavelengths
    }
}

/// How a picture is rendered.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Estimator {
    /// Another description of the scene, below `scenes/`, if not the claim's; the claim's `defines` are not for it.
    pub scene: Option<PathBuf>,
    /// The integrator, if not the scene's.
    pub integrator: Option<String>,
    /// The sampler, if not the scene's.
    pub sampler: Option<Sampler>,
    /// How points choose the light that they ask, if not as the scene says.
    pub light_chooser: Option<String>,
    /// Whether its replicates are blocks of one sequence, as `render` has them by default; otherwise they
    /// are independent.
    #[serde(default)]
    pub blocks: bool,
    /// Samples per pixel of a pilot that deals the samples to pixels, as `render --adaptive` does;
    /// without one every pixel has equally many.
    pub adaptive: Option<u32>,
    /// Further parameters of the scene, of this estimator only.
    #[serde(default)]
    pub defines: BTreeMap<String, toml::Value>,
    /// Work of the default run, which makes no row of estimators that state none.
    pub default: Option<Budget>,
    /// Work of the thorough run, and of the full run's first look.
    pub thorough: Budget,
    /// What is changed, in an invariance claim.
    pub change: Option<Change>,
    /// Between which numbers the exponent of the squared error must lie, in a convergence claim.
    pub exponent: Option<[f64; 2]>,
    /// Which part of the squared error that is.
    #[serde(default)]
    pub part: Part,
    /// Faults that must be found.
    #[serde(default)]
    pub mutants: Vec<PlantedFault>,
    /// Its place, if it is in the matrix of integrators only.
    #[serde(skip)]
    pub in_matrix: Option<Place>,
}

/// The least bias of a picture that a fault may plant in claims about whole pictures, relative to the mean.
const LEAST_FAULT: f64 = 0.02;

impl Estimator {
    /// Its name in reports.
    pub fn label(&self) -> String {
        // A parameter of a scene may name the integrator, whose other parameters then stay, or bring it whole.
        let defined = ["integrator", "method"]
            .iter()
            .find_map(|key| self.defines.get(*key)?.as_str());
        let integrator = self.integrator.as_deref().or(defined).unwrap_or("path");
        let sampler = self.sampler.unwrap_or(Sampler::Sobol).name();
        let defines: String = pairs(&self.defines)
            .filter(|(key, _)| !["integrator", "method"].contains(&key.as_str()))
            .map(|(key, value)| format!(", {key}={value}"))
            .collect();
        let change = (self.change)
            .map(|change| format!(", {change:?}").to_lowercase())
            .unwrap_or_default();
        let chooser = (self.light_chooser.as_ref())
            .map(|name| format!(", {name} lights"))
            .unwrap_or_default();
        let adaptive = self.adaptive.map_or("", |_| ", adaptive");
        let blocks = if self.blocks { ", blocks" } else { "" };
        let language = (self.scene.as_ref())
            .and_then(|scene| scene.extension())
            .map(|ending| format!(", .{}", ending.to_string_lossy()))
            .unwrap_or_default();
        format!("{integrator}, {sampler}{chooser}{blocks}{adaptive}{language}{defines}{change}")
    }

    /// The work of the first run that makes its row.
    pub fn least_budget(&self) -> Budget {
        self.default.unwrap_or(self.thorough)
    }

    /// Whether the default run looks for its faults: not with a budget that is content with a `bound` as wide as the
    /// least of them ([`PlantedFault::Energy`]).
    pub fn finds_faults_by_default(&self) -> bool {
        (self.least_budget().bound).is_none_or(|bound| bound < LEAST_FAULT)
    }

    /// The budget that must suffice to find a fault: an eighth of the first run's that looks for it.
    pub fn fault_budget(&self) -> Budget {
        let budget = match self.default {
            Some(budget) if self.finds_faults_by_default() => budget,
            _ => self.thorough,
        };
        Budget {
            spp: (budget.spp / 8).max(budget.replicates),
            ..budget
        }
    }
}

/// Scene parameters as texts.
pub fn pairs(
    defines: &BTreeMap<String, toml::Value>,
) -> impl Iterator<Item = (String, String)> + '_ {
    defines.iter().map(|(key, value)| {
        let text = match value {
            toml::Value::String(text) => text.clone(),
            other => other.to_string(),
        };
        (key.clone(), text)
    })
}
