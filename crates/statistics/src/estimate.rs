//! An estimate with its uncertainty, and the questions one can ask of it.
//!
//! Every test of a mean here, Welch's, paired, one-sample or z, comes down to a difference d, its
//! standard error s and degrees of freedom n such that (d − β)/s is t-distributed around the
//! true value β. [`Estimate`] is that triple. It answers
//!
//! - the exact null hypothesis β = 0: [`Estimate::p_differs`] with a tolerance of 0;
//! - the interval hypothesis |β| ≤ δ: [`Estimate::p_differs`] with a tolerance of δ;
//! - equivalence, against the hypothesis |β| ≥ δ: [`Estimate::p_agrees`], the larger of the two
//!   one-sided tests (Schuirmann 1987, "TOST");
//! - both at once, by the confidence interval: [`Estimate::verdict`].
//!
//! A standard error of zero means certainty: the p-values are then 0 or 1.

use crate::interval::Interval;
use crate::student_t;
use crate::summary::Summary;
use crate::verdict::Verdict;

/// A number known up to a t-distributed error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    value: f64,
    standard_error: f64,
    degrees_of_freedom: f64,
}

impl Estimate {
    /// The estimate with these parts; `None` unless the value is finite, the standard error
    /// finite and not negative, and the degrees of freedom positive (they may be infinite).
    #[must_use]
    pub fn new(value: f64, standard_error: f64, degrees_of_freedom: f64) -> Option<Self> {
        let usable = value.is_finite()
            && standard_error.is_finite()
            && standard_error >= 0.0
            && degrees_of_freedom > 0.0;
        usable.then_some(Self {
            value,
            standard_error,
            degrees_of_freedom,
        })
    }

    /// A number whose standard error is known, not estimated (a z-test).
    #[must_use]
    pub fn with_known_error(value: f64, standard_error: f64) -> Option<Self> {
        Self::new(value, standard_error, f64::INFINITY)
    }

    /// The mean of the population a sample was drawn from.
    #[must_use]
    pub fn mean(sample: &Summary) -> Self {
        Self {
            value: sample.mean(),
            standard_error: sample.standard_error(),
            degrees_of_freedom: sample.count() as f64 - 1.0,
        }
    }

    /// The excess of a population's mean over a known number (the one-sample t-test).
    #[must_use]
    pub fn excess(sample: &Summary, known: f64) -> Self {
        let mean = Self::mean(sample);
        Self {
            value: mean.value - known,
            ..mean
        }
    }

    /// The difference of two populations' means, `a` − `b`, whose variances may differ (Welch
    /// 1947, with Satterthwaite's degrees of freedom).
    #[must_use]
    pub fn welch(a: &Summary, b: &Summary) -> Self {
        let (va, vb) = (a.variance_of_mean(), b.variance_of_mean());
        let (na, nb) = (a.count() as f64 - 1.0, b.count() as f64 - 1.0);
        let variance = va + vb;
        // By the shares of the variance, so that no square under- or overflows.
        let degrees_of_freedom = if variance > 0.0 {
            let (sa, sb) = (va / variance, vb / variance);
            1.0 / (sa * sa / na + sb * sb / nb)
        } else {
            na + nb
        };
        Self {
            value: a.mean() - b.mean(),
            standard_error: variance.sqrt(),
            degrees_of_freedom,
        }
    }

    /// The mean difference within pairs, `a` − `b`; `None` of unequal numbers, of fewer than two
    /// pairs or of non-finite numbers.
    #[must_use]
    pub fn paired(a: &[f64], b: &[f64]) -> Option<Self> {
        if a.len() != b.len() {
            return None;
        }
        let differences = a.iter().zip(b).map(|(a, b)| a - b);
        Summary::of_iter(differences).map(|sample| Self::mean(&sample))
    }

    /// The estimated number.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.value
    }

    /// Its standard error.
    #[must_use]
    pub fn standard_error(&self) -> f64 {
        self.standard_error
    }

    /// The degrees of freedom of the standard error; infinite if it is known.
    #[must_use]
    pub fn degrees_of_freedom(&self) -> f64 {
        self.degrees_of_freedom
    }

    /// The estimate of the number times a known factor, such as one over a reference's mean;
    /// `None` if that is not finite.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Option<Self> {
        Self::new(
            self.value * factor,
            self.standard_error * factor.abs(),
            self.degrees_of_freedom,
        )
    }

    /// The interval that covers the true number with probability `confidence`.
    #[must_use]
    pub fn interval(&self, confidence: f64) -> Interval {
        let reach = self.reach(0.5 * (1.0 - confidence));
        Interval {
            low: self.value - reach,
            high: self.value + reach,
        }
    }

    /// The p-value of the hypothesis that the true number is within ±`tolerance`; small means
    /// it is not.
    ///
    /// At the edge of the hypothesis this is exact: P(|d| ≥ observed) for β = ±`tolerance`.
    #[must_use]
    pub fn p_differs(&self, tolerance: f64) -> f64 {
        let distance = self.value.abs();
        (self.tail(distance - tolerance) + self.tail(distance + tolerance)).min(1.0)
    }

    /// The p-value of the hypothesis that the true number is at least `tolerance` from zero;
    /// small means it is nearer.
    #[must_use]
    pub fn p_agrees(&self, tolerance: f64) -> f64 {
        self.tail(tolerance - self.value.abs())
    }

    /// Whether the interval at `confidence` lies inside ±`tolerance`, outside, or neither.
    #[must_use]
    pub fn verdict(&self, tolerance: f64, confidence: f64) -> Verdict {
        self.interval(confidence).verdict(tolerance)
    }

    /// The smallest |β| that a two-sided t-test at level `alpha` finds with probability `power`,
    /// were the experiment done again with this standard error for the true one: by the noncentral
    /// t distribution ([`crate::power::detectable`]). NaN unless 0 < `alpha` < `power` < 1.
    #[must_use]
    pub fn smallest_detectable(&self, alpha: f64, power: f64) -> f64 {
        if self.standard_error == 0.0 {
            return 0.0;
        }
        crate::power::detectable(self.degrees_of_freedom, alpha, power) * self.standard_error
    }

    /// The distance an error exceeds with probability `tail`.
    fn reach(&self, tail: f64) -> f64 {
        if self.standard_error == 0.0 {
            return 0.0;
        }
        student_t::upper_quantile(tail, self.degrees_of_freedom) * self.standard_error
    }

    /// The probability of an error greater than `distance`. Certainty has no error.
    fn tail(&self, distance: f64) -> f64 {
        if self.standard_error == 0.0 {
            return if distance > 0.0 { 0.0 } else { 1.0 };
        }
        student_t::sf(distance / self.standard_error, self.degrees_of_freedom)
    }
}
