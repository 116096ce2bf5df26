//! How thorough a run is: default, thorough or full.

use crate::claim::{Budget, Estimator};
use etalon_render::decide::looks::{FINE_LOOKS, FULL_LOOKS, Multiple};
use serde::Serialize;

/// How thorough a run is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Tier {
    /// The essential rows of every claim, within three minutes on two cores.
    Default,
    /// Every row that minutes can decide: about a quarter of an hour.
    Thorough,
    /// Until every bias is bounded below 0.5 %; hours, if need be.
    Full,
}

/// The relative bias of an image's mean that a full run excludes in every row, unless the claim's
/// own bound is tighter still.
pub const FULL_BOUND: f64 = 0.005;

impl Tier {
    /// Whether each row must exclude a bias of its image's mean by itself, at the level
    /// [`STATED`](etalon_render::decide::looks::STATED);
    /// in other tiers the bias is excluded for all rows together.
    pub fn states_bounds(self) -> bool {
        self == Self::Full
    }

    /// The bias of an image's mean that a row must exclude whose claim's own bound is `own`: a full
    /// run asks [`FULL_BOUND`], or the claim's own if that is tighter.
    pub fn image_bound(self, own: f64) -> f64 {
        match self {
            Self::Default | Self::Thorough => own,
            Self::Full => own.min(FULL_BOUND),
        }
    }

    /// Replicates at each look, in multiples of the budget's.
    pub fn looks(self) -> &'static [Multiple] {
        match self {
            Self::Default | Self::Thorough => FINE_LOOKS,
            Self::Full => FULL_LOOKS,
        }
    }

    /// The first look's budget of an estimator; that of the thorough run where the default run,
    /// which then makes no row of it unless it is asked for by name, states none.
    pub fn budget(self, estimator: &Estimator) -> Budget {
        match self {
            Self::Default => estimator.least_budget(),
            Self::Thorough | Self::Full => estimator.thorough,
        }
    }

    /// Its name, as on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Default => "default",
            Self::Thorough => "thorough",
            Self::Full => "full",
        }
    }
}
