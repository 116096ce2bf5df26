//! What a decision rests on: bounds, error rates, and how bright a sample may be.

use crate::plan;
use crate::tile::{self, TILES};

/// No sample of a sound program that looks for lights is brighter than this many times the truth's brightest pixel. Of one that finds
/// them by chance none is brighter than that, or than a light.
pub const BRIGHTEST: f64 = 10.0;

/// What is asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// δ: the relative difference of means within which a program agrees.
    pub bound: f64,
    /// The relative difference of a tile beyond which a program differs, of its own mean; δ of the picture's is added.
    pub tile_bound: f64,
    /// The probability that any interval of a run misses.
    pub miss: f64,
    /// The probability that a sound program is accused of anything in a run.
    pub alarm: f64,
    /// How many questions and looks share these.
    pub family: u32,
    /// Samples per pixel of a picture.
    pub samples: u32,
    /// The radiance that no sample of a sound program exceeds.
    pub brightest: f64,
}

impl Rules {
    /// δ = 0.5 %; 3 % of a tile; 10⁻³ and 10⁻⁵ for this many questions, each looked at so often.
    pub fn new(questions: usize, looks: u32, samples: u32, brightest: f64) -> Self {
        Self {
            bound: plan::BOUND,
            tile_bound: tile::BOUND,
            miss: 1e-3,
            alarm: 1e-5,
            family: (questions as u32 * looks).max(1),
            samples,
            brightest,
        }
    }

    /// The level of an interval that may not miss.
    pub(crate) fn miss_level(&self) -> f64 {
        self.miss / f64::from(self.family)
    }

    /// The level of each of the means, of a picture or a tile, by which a program may be accused.
    pub(crate) fn alarm_level(&self) -> f64 {
        self.alarm / (f64::from(self.family) * f64::from(1 + TILES * TILES))
    }
}
