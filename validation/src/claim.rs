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

use crate::fault::PlantedFault;
use crate::matrix::{self, Matrix, SkippedIntegrator};
use crate::tasks::{named, unknown};
use etalon_render::decide::convergence::Part;
use rayon::iter::Either;
use rayon::prelude::*;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

pub use crate::budget::{BiasBounds, Budget};
pub use crate::oracle::Oracle;
pub use crate::sampler::Sampler;

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
    /// Bounds of what matters.
    #[serde(default)]
    pub bounds: BiasBounds,
    /// Whether the full run alone decides it: its estimators are too noisy for the minutes of the
    /// others.
    #[serde(default)]
    pub full_only: bool,
}

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
    /// Whether it stands in the matrix of integrators only.
    #[serde(skip)]
    pub in_matrix: Option<matrix::Place>,
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
        format!("{integrator}, {sampler}{chooser}{blocks}{adaptive}{defines}{change}")
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

/// All claims, or everything that is wrong with them.
fn whole(
    claims: impl ParallelIterator<Item = Result<Claim, String>>,
) -> Result<Vec<Claim>, String> {
    let (claims, errors): (Vec<Claim>, Vec<String>) = claims.partition_map(|claim| match claim {
        Ok(claim) => Either::Left(claim),
        Err(message) => Either::Right(message),
    });
    if errors.is_empty() {
        Ok(claims)
    } else {
        Err(errors.join("\n"))
    }
}

impl Claim {
    /// The scene's parameters as an estimator, or the oracle alone, has them.
    pub fn defines_of(&self, estimator: Option<&Estimator>) -> BTreeMap<String, toml::Value> {
        let mut all = self.defines.clone();
        all.extend(estimator.iter().flat_map(|e| e.defines.clone()));
        all
    }

    /// Reads the claim in a file.
    ///
    /// # Errors
    /// Says what is wrong with the file, and where.
    pub fn read(path: &Path) -> Result<Self, String> {
        let mut claim = Self::parse(path)?;
        claim.expand(path)?;
        Ok(claim)
    }

    /// The claim in a file as it is written, without the rows of its matrix: no scene is looked at.
    fn parse(path: &Path) -> Result<Self, String> {
        let error = |message: String| format!("{}: {message}", path.display());
        let text = std::fs::read_to_string(path).map_err(|e| error(e.to_string()))?;
        let mut claim: Self = toml::from_str(&text).map_err(|e| error(e.to_string()))?;
        claim.name = path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let bounded = text.parse::<toml::Table>();
        let bounded = bounded.is_ok_and(|table| table.contains_key("bounds"));
        claim.check(bounded).map_err(error)?;
        Ok(claim)
    }

    /// Adds the rows of the matrix: every integrator is asked about the scene.
    fn expand(&mut self, path: &Path) -> Result<(), String> {
        matrix::expand(self).map_err(|message| format!("{}: {message}", path.display()))
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
    fn check(&self, bounded: bool) -> Result<(), String> {
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

    /// Reads all claims in a folder, in the order of their names.
    ///
    /// # Errors
    /// Says what is wrong with every file that cannot be read.
    pub fn read_all(folder: &Path) -> Result<Vec<Self>, String> {
        Self::read_named(folder, None)
    }

    /// Reads the claims that `name` means ([`named`]), all if it is `None`. Every file must be well
    /// written, but the scenes of other claims are not looked at.
    ///
    /// # Errors
    /// Says what is wrong with every file that cannot be read, or that no claim has such a name.
    pub fn read_named(folder: &Path, name: Option<&str>) -> Result<Vec<Self>, String> {
        let entries =
            std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        let mut paths: Vec<PathBuf> = entries
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| path.extension().is_some_and(|e| e == "toml"))
            .collect();
        paths.sort();
        let mut claims = whole(paths.par_iter().map(|path| Self::parse(path)))?;
        if let Some(name) = name {
            let chosen: Vec<Self> = named(&claims, name).into_iter().cloned().collect();
            if chosen.is_empty() {
                return Err(unknown(&claims, name));
            }
            claims = chosen;
        }
        whole(claims.into_par_iter().map(|mut claim| {
            claim.expand(&folder.join(format!("{}.toml", claim.name)))?;
            Ok(claim)
        }))
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
