//! Are stated error rates kept? Counts of alarms and of covered truths against what was promised.
//!
//! Under its hypothesis a p-value is at most q with probability q, for every q; of N independent
//! ones the number is binomial, with the exact interval of [`crate::proportion`]. Histograms show
//! the body; alarms matter in the tail, so levels go down by decades, as far as N can say anything.

use crate::interval::Interval;
use crate::proportion;

/// How often something happened that was promised to happen at a certain rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate {
    /// The promised rate.
    pub promised: f64,
    /// How often it happened.
    pub count: u64,
    /// Of how many trials.
    pub trials: u64,
    /// The exact interval of the true rate.
    pub interval: Interval,
}

impl Rate {
    /// A promise held against `count` of `trials`, at this confidence; `None` without trials or
    /// for more events than trials.
    #[must_use]
    pub fn new(promised: f64, count: u64, trials: u64, confidence: f64) -> Option<Self> {
        Some(Self {
            promised,
            count,
            trials,
            interval: proportion::interval(count, trials, confidence)?,
        })
    }

    /// The observed rate.
    #[must_use]
    pub fn observed(&self) -> f64 {
        self.count as f64 / self.trials as f64
    }

    /// Whether the promise is compatible with what happened.
    #[must_use]
    pub fn is_kept(&self) -> bool {
        self.interval.contains(self.promised)
    }

    /// Whether it does not happen more often than promised, as far as can be told; a cautious
    /// test's alarms need no more.
    #[must_use]
    pub fn is_not_exceeded(&self) -> bool {
        self.interval.low <= self.promised
    }
}

/// How often p-values are at most `level`; `None` of no p-values or of numbers that are none.
#[must_use]
pub fn alarms(p_values: &[f64], level: f64, confidence: f64) -> Option<Rate> {
    if p_values.iter().any(|p| !(0.0..=1.0).contains(p)) {
        return None;
    }
    let count = p_values.iter().filter(|&&p| p <= level).count();
    Rate::new(level, count as u64, p_values.len() as u64, confidence)
}

/// [`alarms`] at ½, 10⁻¹, 10⁻², … down to `least`, each interval at this confidence.
#[must_use]
pub fn decades(p_values: &[f64], least: f64, confidence: f64) -> Option<Vec<Rate>> {
    let mut rates = vec![alarms(p_values, 0.5, confidence)?];
    for decade in 1..=300 {
        // The nearest double to the decimal, not an accumulated product.
        let level = 1.0 / libm::pow(10.0, f64::from(decade));
        if level < least * (1.0 - 1e-9) {
            break;
        }
        rates.push(alarms(p_values, level, confidence)?);
    }
    Some(rates)
}

/// How often intervals of a stated confidence hold the truth; `None` of no intervals.
#[must_use]
pub fn coverage(
    intervals: impl IntoIterator<Item = Interval>,
    truth: f64,
    stated: f64,
    confidence: f64,
) -> Option<Rate> {
    let (mut covered, mut trials) = (0, 0);
    for interval in intervals {
        covered += u64::from(interval.contains(truth));
        trials += 1;
    }
    Rate::new(stated, covered, trials, confidence)
}

/// How many p-values fall into each of `bins` equal parts of [0, 1], the last closed; `None` of no
/// bins or of numbers that are no p-values.
#[must_use]
pub fn histogram(p_values: &[f64], bins: usize) -> Option<Vec<u64>> {
    if bins == 0 || p_values.iter().any(|p| !(0.0..=1.0).contains(p)) {
        return None;
    }
    let mut counts = vec![0; bins];
    for p in p_values {
        counts[((p * bins as f64) as usize).min(bins - 1)] += 1;
    }
    Some(counts)
}
