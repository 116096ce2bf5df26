//! How far images and their tiles may be off.

use serde::Serialize;

/// How large a bias matters, and how sure the verdict must be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Tolerances {
    /// Bias of an image's mean that matters, relative to the channel's mean.
    pub image_bound: f64,
    /// Bias of a tile that matters, relative to its own mean, plus `image_bound` of the image's.
    pub tile_bound: f64,
    /// Probability of calling equal images different, over everything that is asked.
    pub alpha: f64,
    /// What "no bias at all" leaves to rounding, relative to the mean; zero asks for equality.
    pub rounding: f64,
}

impl Default for Tolerances {
    fn default() -> Self {
        Self {
            image_bound: 0.005,
            tile_bound: 0.03,
            alpha: 1e-3,
            rounding: 0.0,
        }
    }
}

/// What a tile's mean may differ by: a share of the tile's own mean, and one of the image's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Relative to the tile's own mean.
    own: f64,
    /// In units of the channel.
    fixed: f64,
}

impl Tolerance {
    /// What bias does not matter, where the channel's mean counts `image_scale`.
    pub fn bounded(rules: Tolerances, image_scale: f64) -> Self {
        Self {
            own: rules.tile_bound,
            fixed: rules.image_bound * image_scale,
        }
    }

    /// What rounding may do to equal numbers.
    pub fn exact(rules: Tolerances, image_scale: f64) -> Self {
        Self {
            own: rules.rounding,
            fixed: rules.rounding * image_scale,
        }
    }

    /// For a tile whose mean ought to be this.
    pub fn at(self, mean: f64) -> f64 {
        self.own * mean.abs() + self.fixed
    }
}
