//! Is a bias small enough? Two one-sided tests, absolute and relative.
//!
//! Equivalence within ±Δ is shown by rejecting both β ≤ −Δ and β ≥ Δ, each at level α (Schuirmann
//! 1987, "TOST"); the p-value is the larger of the two, and both reject exactly when the interval
//! of confidence 1 − 2α lies inside ±Δ. No correction is needed for the two, nor for requiring
//! several equivalences together (Berger 1982, intersection–union); choosing *which* of several
//! to claim afterwards does need one.
//!
//! A *relative* bias is β over a denominator that must not vanish where a quantity is nearly
//! absent: [`denominator`] is the greater of the quantity's own mean and 5 % of a companion's,
//! such as the red channel's mean and the luminance's. It is taken as known; where it is itself
//! uncertain, see [`crate::ratio`].

use crate::estimate::Estimate;
use crate::interval::Interval;
use crate::verdict::Verdict;

/// The share of the companion's mean below which a quantity counts as nearly absent.
pub const FLOOR_SHARE: f64 = 0.05;

/// The denominator of a relative bias: the greater of |`mean`| and [`FLOOR_SHARE`] · |`companion`|;
/// `None` if both are zero or either is not finite.
#[must_use]
pub fn denominator(mean: f64, companion: f64) -> Option<f64> {
    let greater = mean.abs().max(FLOOR_SHARE * companion.abs());
    (mean.is_finite() && companion.is_finite() && greater > 0.0).then_some(greater)
}

/// A bias known up to a t-distributed error, with the number it is relative to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bias {
    absolute: Estimate,
    relative: Estimate,
    denominator: f64,
}

/// The outcome of two one-sided tests at level α.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equivalence {
    /// The p-value of β ≤ −Δ.
    pub p_below: f64,
    /// The p-value of β ≥ Δ.
    pub p_above: f64,
    /// The p-value of "not equivalent": the larger of the two.
    pub p_value: f64,
    /// The interval of confidence 1 − 2α.
    pub interval: Interval,
    /// Agrees if equivalence is shown; differs if the interval lies outside ±Δ; else undecided.
    pub verdict: Verdict,
}

/// Tests at level `alpha` whether a number is within ±`margin`. Agreement and difference are each
/// false with probability at most `alpha`.
#[must_use]
pub fn test(estimate: &Estimate, margin: f64, alpha: f64) -> Equivalence {
    let certain = estimate.standard_error() == 0.0;
    let one_sided = |distance: f64| {
        if certain {
            return if distance > 0.0 { 0.0 } else { 1.0 };
        }
        crate::student_t::sf(
            distance / estimate.standard_error(),
            estimate.degrees_of_freedom(),
        )
    };
    let p_below = one_sided(estimate.value() + margin);
    let p_above = one_sided(margin - estimate.value());
    let p_value = p_below.max(p_above);
    let interval = estimate.interval(1.0 - 2.0 * alpha);
    let verdict = if p_value <= alpha {
        Verdict::Agrees
    } else if interval.low > margin || interval.high < -margin {
        Verdict::Differs
    } else {
        Verdict::Undecided
    };
    Equivalence {
        p_below,
        p_above,
        p_value,
        interval,
        verdict,
    }
}

impl Bias {
    /// The bias `absolute`, relative to `denominator`; `None` unless that is positive and finite
    /// and the quotient is finite.
    #[must_use]
    pub fn new(absolute: Estimate, denominator: f64) -> Option<Self> {
        let usable = denominator > 0.0 && denominator.is_finite();
        let relative = absolute.scaled(1.0 / denominator).filter(|_| usable)?;
        Some(Self {
            absolute,
            relative,
            denominator,
        })
    }

    /// The bias in the quantity's own units.
    #[must_use]
    pub fn absolute(&self) -> Estimate {
        self.absolute
    }

    /// The bias as a share of the denominator.
    #[must_use]
    pub fn relative(&self) -> Estimate {
        self.relative
    }

    /// What the bias is relative to.
    #[must_use]
    pub fn denominator(&self) -> f64 {
        self.denominator
    }

    /// Two one-sided tests of the relative bias against ±`margin`.
    #[must_use]
    pub fn test(&self, margin: f64, alpha: f64) -> Equivalence {
        test(&self.relative(), margin, alpha)
    }

    /// The bound on the relative bias: the greatest distance from zero of its interval of this
    /// confidence.
    #[must_use]
    pub fn bound(&self, confidence: f64) -> f64 {
        self.relative().interval(confidence).bound()
    }
}
