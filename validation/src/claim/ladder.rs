//! What grows in a claim of convergence while the error falls.

use serde::Deserialize;

/// What is climbed while the error falls.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ladder {
    /// The closed form that tells the error.
    pub formula: String,
    /// Growing numbers: samples per replicate, powers of two for Sobol' points, or the values of a
    /// parameter.
    pub rungs: Vec<u32>,
    /// The scene parameter that takes these values, if it is not the samples that grow: a replicate then has
    /// as many on every rung, all of them together a budget's `spp`.
    pub over: Option<String>,
}

impl Ladder {
    /// # Errors
    /// If it cannot be climbed.
    pub(crate) fn check(&self) -> Result<(), String> {
        if self.rungs.len() < 3 || self.rungs.windows(2).any(|pair| pair[0] >= pair[1]) {
            return Err("`rungs` must be three or more growing numbers".to_owned());
        }
        Ok(())
    }
}
