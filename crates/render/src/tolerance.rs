//! How far a tile may be off.

use crate::judge::Tolerances;

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
