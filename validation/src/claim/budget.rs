//! What a claim may cost, and which biases it must exclude: written down before a run.

use serde::Deserialize;

/// How much work to spend.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Budget {
    /// Samples per pixel, all replicates together.
    pub spp: u32,
    /// Independent replicates.
    pub replicates: u32,
    /// The bias of the image's mean that the default run must exclude with it, relative to it, if
    /// not the claim's own bound: where seconds are too few for that.
    pub bound: Option<f64>,
}

/// The most that equality may leave to rounding, relative to the mean: what the coarsest of the
/// formulas leaves to its quadrature (`rough-coat`). More would be a bias.
const ROUNDING: f64 = 2e-3;

/// Which biases matter.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BiasBounds {
    /// Of the image's mean, relative to it.
    pub image: f64,
    /// Of a tile's mean, relative to it (`image` of the image's mean is added).
    pub tile: f64,
    /// What equality leaves to rounding in single precision, relative to the mean.
    pub rounding: f64,
}

impl Default for BiasBounds {
    fn default() -> Self {
        Self {
            image: 0.005,
            tile: 0.03,
            rounding: 2e-5,
        }
    }
}

impl BiasBounds {
    /// Refuses numbers that make no sense.
    ///
    /// # Errors
    /// Says which.
    pub(crate) fn check(&self) -> Result<(), String> {
        let sensible = |x: f64| x > 0.0 && x < 1.0;
        if !sensible(self.image) || !sensible(self.tile) {
            return Err("`bounds` must lie between 0 and 1".to_owned());
        }
        if !(0.0..=ROUNDING).contains(&self.rounding) {
            return Err(format!(
                "`bounds.rounding` must lie between 0 and {ROUNDING}"
            ));
        }
        Ok(())
    }
}
