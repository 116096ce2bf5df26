//! What the estimators of a claim are held against: a formula, another renderer's picture, another
//! estimator of ours, or a property that their errors must have.

use super::counting::Counting;
use super::estimator::Estimator;
use super::ladder::Ladder;
use serde::Deserialize;

/// What an estimator is held against.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Oracle {
    /// A formula: the null hypothesis is equality.
    ClosedForm {
        /// Its name, see [`crate::closed_form`].
        formula: String,
    },
    /// A picture by Mitsuba 3: the question is equivalence.
    Reference {
        /// Samples per pixel and seed.
        spp: u32,
        /// Independent seeds.
        #[serde(default = "seeds")]
        seeds: u32,
        /// Mitsuba's integrator, as the scene's parameter `integrator`, if not the scene's: its
        /// `volpath` alone sees lamps without extent through masks. It counts no passage through
        /// them as a segment of a path, so `max_depth` must be large.
        integrator: Option<String>,
    },
    /// Another estimator of ours, chosen so that it converges here: the null hypothesis is
    /// equality.
    Agreement {
        /// The estimator.
        estimator: Box<Estimator>,
    },
    /// A closed form that states what becomes of energy, as in a furnace: the null hypothesis is
    /// that none is made and none is lost.
    Energy {
        /// The name of the closed form.
        formula: String,
    },
    /// What must not change when something else does: see [`super::Change`]. The null hypothesis is
    /// equality, of bits or of statistics.
    Invariance {
        /// The estimator without the change.
        estimator: Box<Estimator>,
    },
    /// How fast the squared error, or a `part` of it, falls: its exponent must be shown to lie within
    /// each estimator's `exponent`.
    Convergence(Ladder),
    /// Whether standard errors are right: Student's intervals of 68, 95 and 99 % about a mean must be
    /// shown to cover the truth at their rate, and squared errors to be as large as reported.
    Noise(Counting),
    /// A picture by POV-Ray of the scene's twin: every pixel agrees, see [`crate::pixelwise`].
    Povray {
        /// The greatest share of pixels next to an edge.
        edges: f64,
        /// The greatest share of pixels that are next to an edge and differ.
        excused: f64,
    },
}

fn seeds() -> u32 {
    32
}

impl Oracle {
    /// Whether equality is claimed, not only equivalence.
    pub fn is_exact(&self) -> bool {
        !matches!(self, Self::Reference { .. })
    }

    /// Mitsuba's integrator, if it is stated and not the scene's.
    pub fn integrator(&self) -> Option<&str> {
        match self {
            Self::Reference { integrator, .. } => integrator.as_deref(),
            _ => None,
        }
    }

    /// The kind, as claims spell it.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::ClosedForm { .. } => "closed_form",
            Self::Reference { .. } => "reference",
            Self::Agreement { .. } => "agreement",
            Self::Energy { .. } => "energy",
            Self::Invariance { .. } => "invariance",
            Self::Convergence(_) => "convergence",
            Self::Noise(_) => "noise",
            Self::Povray { .. } => "povray",
        }
    }
}
