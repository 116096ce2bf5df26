//! A claim: a scene, an oracle, and the estimators that must agree with it.
//!
//! ```toml
//! title = "The Cornell box, against Mitsuba 3"
//! scene = "cornell-box/scene.xml"
//!
//! [defines]                    # scene parameters; closed forms take their numbers from here
//! resx = 96
//! resy = 96
//!
//! [oracle]
//! kind = "reference"           # or one of the others: see `Oracle`
//! spp = 256                    # how `cargo xtask references` renders it
//! seeds = 32
//!
//! [[estimators]]
//! sampler = "sobol"
//! default = { spp = 512, replicates = 32 }    # absent: no row of the default run
//! thorough = { spp = 4096, replicates = 32 }
//! mutants = ["dropped cosine"] # faults that this very comparison must find
//! ```

mod budget;
mod counting;
mod estimator;
mod ladder;
mod matrix;
mod oracle;
mod sampler;

use etalon_render::decide::convergence::Part;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

pub use budget::{BiasBounds, Budget};
pub use counting::{Counting, Effort, Means};
pub use estimator::{Change, Estimator, pairs};
pub use ladder::Ladder;
pub use matrix::{Matrix, Place, SkippedIntegrator};
pub use oracle::Oracle;
pub use sampler::Sampler;

/// A claim as its file states it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// The name of its file, without extension.
    #[serde(skip)]
    pub name: String,
    /// What is claimed, in a line.
    pub title: String,
    /// The scene, below `scenes/`.
    pub scene: PathBuf,
    /// Parameters of the scene, and the numbers of its closed form.
    #[serde(default)]
    pub defines: BTreeMap<String, toml::Value>,
    /// What is known of the picture.
    pub oracle: Oracle,
    /// Who must agree with it.
    pub estimators: Vec<Estimator>,
    /// How all other unbiased integrators must agree with it.
    pub matrix: Option<Matrix>,
    /// Those of them that do not take part.
    #[serde(skip)]
    pub absent: Vec<SkippedIntegrator>,
    /// Bounds of the bias that matters.
    #[serde(default)]
    pub bounds: BiasBounds,
    /// Whether the full run alone decides it: its estimators are too noisy for the minutes of the
    /// others.
    #[serde(default)]
    pub full_only: bool,
}

impl Claim {
    /// The scene's parameters as an estimator, or the oracle alone, has them.
    pub fn defines_of(&self, estimator: Option<&Estimator>) -> BTreeMap<String, toml::Value> {
        let own_scene = estimator.is_some_and(|e| e.scene.is_some());
        let mut all = if own_scene {
            BTreeMap::new()
        } else {
            self.defines.clone()
        };
        all.extend(estimator.iter().flat_map(|e| e.defines.clone()));
        all
    }

    /// Whether `bounds` have a say in what it claims.
    fn is_bounded(&self) -> bool {
        match self.oracle {
            Oracle::Convergence(_) | Oracle::Noise(_) | Oracle::Povray { .. } => false,
            // Bits have none.
            _ => (self.estimators.iter()).any(|e| !e.change.is_some_and(Change::is_of_bits)),
        }
    }

    /// What no type can say: sensible numbers, fields (`bounds`, if stated) that belong to the kind.
    pub(crate) fn check(&self, bounded: bool) -> Result<(), String> {
        if self.estimators.is_empty() {
            return Err("a claim needs at least one estimator".to_owned());
        }
        if !self.full_only && self.estimators.iter().all(|e| e.default.is_none()) {
            return Err(
                "the default run decides every claim, or `full_only` says that it does not: at least \
                 one estimator needs a budget `default`"
                    .to_owned(),
            );
        }
        let sensible = |x: f64| x > 0.0 && x < 1.0;
        self.bounds.check()?;
        if bounded && !self.is_bounded() {
            return Err("`bounds` belong to claims about means of pictures".to_owned());
        }
        let oracle = match &self.oracle {
            Oracle::Agreement { estimator } | Oracle::Invariance { estimator } => {
                Some(estimator.as_ref())
            }
            Oracle::Convergence(ladder) => {
                ladder.check()?;
                None
            }
            Oracle::Noise(counting) => {
                counting.check()?;
                None
            }
            Oracle::Povray { edges, excused } => {
                if !sensible(*edges) || !sensible(*excused) || excused > edges {
                    let message = "`edges` and `excused` must be shares, the latter the smaller";
                    return Err(message.to_owned());
                }
                None
            }
            _ => None,
        };
        for estimator in self.estimators.iter().chain(oracle) {
            for budget in [estimator.least_budget(), estimator.thorough] {
                if budget.replicates < 2
                    || !budget.replicates.is_multiple_of(2)
                    || budget.spp < budget.replicates
                {
                    return Err(
                        "a budget needs an even number of replicates of at least 1 sample each"
                            .to_owned(),
                    );
                }
            }
        }
        let mut own = self.estimators.iter();
        let wide = |budget: Budget| {
            budget
                .bound
                .is_some_and(|b| !(b > self.bounds.image && b < 1.0))
        };
        if own.any(|e| e.thorough.bound.is_some() || e.default.is_some_and(wide))
            || oracle.is_some_and(|e| e.least_budget().bound.is_some())
        {
            return Err(
                "a `bound` belongs to an estimator's budget `default`, and is wider than the claim's own"
                    .to_owned(),
            );
        }
        for estimator in &self.estimators {
            let convergence = matches!(self.oracle, Oracle::Convergence(_));
            let invariance = matches!(self.oracle, Oracle::Invariance { .. });
            match estimator.exponent {
                Some([low, high]) if low < high && convergence => {}
                None if !convergence => {}
                _ => {
                    return Err(
                        "`exponent = [low, high]` belongs to every estimator of a convergence \
                         claim, and to no other"
                            .to_owned(),
                    );
                }
            }
            if estimator.part != Part::Whole && !convergence {
                return Err("`part` belongs to convergence claims only".to_owned());
            }
            if estimator.change.is_some() && !invariance {
                return Err("`change` belongs to invariance claims only".to_owned());
            }
        }
        Ok(())
    }

    /// Pixels of its pictures, as its parameters state; those against POV-Ray have the size of the
    /// scene, 256² at most.
    pub fn pixels(&self) -> f64 {
        let side = |key| self.number(key).unwrap_or(256.0);
        side("resx") * side("resy")
    }

    /// A number among the scene's parameters.
    ///
    /// # Errors
    /// If it is not there or not a number.
    pub fn number(&self, key: &str) -> Result<f64, String> {
        let missing = || format!("`defines.{key}` must be a number: the closed form needs it");
        let value = self.defines.get(key).ok_or_else(missing)?;
        value
            .as_float()
            .or(value.as_integer().map(|n| n as f64))
            .ok_or_else(missing)
    }

    /// A text among the scene's parameters.
    ///
    /// # Errors
    /// If it is not there or not a text.
    pub fn text(&self, key: &str) -> Result<&str, String> {
        let value = self.defines.get(key).and_then(toml::Value::as_str);
        value.ok_or_else(|| format!("`defines.{key}` must be a text: the closed form needs it"))
    }
}
