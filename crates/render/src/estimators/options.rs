//! What is asked of a comparison.

use crate::load_options::LoadOptions;
use etalon_scene::LightSamplerKind;
use std::path::PathBuf;

/// What to compare, and for how long.
#[derive(Clone, Debug)]
pub struct Options {
    /// How to read the scene; its integrator is replaced by each of `integrators`.
    pub load: LoadOptions,
    /// The integrators; empty for the scene's own.
    pub integrators: Vec<String>,
    /// The samplers; empty for the scene's own.
    pub samplers: Vec<String>,
    /// The reconstruction filters; empty for the scene's own.
    pub filters: Vec<String>,
    /// Rules of light selection; empty for the scene's own.
    pub light_choosers: Vec<LightSamplerKind>,
    /// The time for all rendering together (s).
    pub seconds: f64,
    /// The reference; without one it is rendered.
    pub reference: Option<PathBuf>,
    /// The share of the time that rendering a reference is given.
    pub reference_share: f64,
    /// The time that a picture at equal time takes (s); without one, what there is time for.
    pub picture_seconds: Option<f64>,
    /// Seed of all randomness.
    pub seed: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            load: LoadOptions::default(),
            integrators: Vec::new(),
            samplers: Vec::new(),
            filters: Vec::new(),
            light_choosers: Vec::new(),
            seconds: 60.0,
            reference: None,
            reference_share: 0.3,
            picture_seconds: None,
            seed: 0,
        }
    }
}
