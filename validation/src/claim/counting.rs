//! What a claim about noise counts, and how much of it.

use serde::Deserialize;

/// The means whose errors a noise claim is about.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Means {
    /// Those of single pixels.
    #[default]
    Pixels,
    /// Those of tiles of 16² pixels, which comparisons are decided by.
    Tiles,
}

/// What a noise claim counts, and how much of it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Counting {
    /// Whose means.
    #[serde(default)]
    pub of: Means,
    /// The closed form that tells the truth.
    pub formula: String,
    /// How many pictures, each with its own seed.
    pub seeds: u32,
    /// How far a rate may be from what it ought to be.
    pub tolerance: f64,
    /// What the default run makes instead, where seconds do not suffice for that tolerance.
    pub default: Option<Effort>,
}

/// How much is counted, and how far off what is counted may be.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Effort {
    /// How many pictures, each with its own seed.
    pub seeds: u32,
    /// How far a rate may be from what it ought to be.
    pub tolerance: f64,
}

impl Counting {
    /// Refuses numbers that make no sense.
    ///
    /// # Errors
    /// Says which.
    pub fn check(&self) -> Result<(), String> {
        let sensible = |x: f64| x > 0.0 && x < 1.0;
        // Looks add a half of them.
        let even = |seeds: u32| seeds > 0 && seeds.is_multiple_of(2);
        if !even(self.seeds) || !sensible(self.tolerance) {
            return Err("`seeds` must be even, `tolerance` above 0".to_owned());
        }
        let less = |e: Effort| even(e.seeds) && e.seeds < self.seeds && sensible(e.tolerance);
        if !self.default.is_none_or(less) {
            return Err("`default` needs fewer `seeds`, and a `tolerance` above 0".to_owned());
        }
        Ok(())
    }
}
