//! The bootstrap of independent numbers (Efron 1979), of anything that can be computed from them.
//!
//! Numbers are drawn from the sample with replacement, and the statistic is computed of each of B such samples; its
//! interval is between their percentiles. Means have a better one: [`crate::studentised`].
//!
//! A bootstrap knows no tail that the sample does not show: below [`FEWEST`] numbers, or with
//! fewer than ten resamples beyond each end, it is refused.

use crate::interval::Interval;
use crate::random::SplitMix64;

/// The fewest numbers that are resampled.
pub const FEWEST: usize = 8;

/// How to resample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resampling {
    /// B, the number of resamples.
    pub resamples: u32,
    /// Where the random numbers start.
    pub seed: u64,
}

impl Resampling {
    /// For independent numbers.
    #[must_use]
    pub const fn independent(resamples: u32, seed: u64) -> Self {
        Self { resamples, seed }
    }

    /// Whether a two-sided interval of this confidence has at least ten resamples beyond each end.
    #[must_use]
    pub fn resolves(&self, confidence: f64) -> bool {
        confidence > 0.0
            && confidence < 1.0
            && 0.5 * (1.0 - confidence) * f64::from(self.resamples) >= 10.0
    }
}

/// Draws `n` of `n` indices, with replacement.
pub(crate) fn draw(n: usize, random: &mut SplitMix64, indices: &mut Vec<usize>) {
    indices.clear();
    indices.extend((0..n).map(|_| random.below(n)));
}

/// The `share` quantile of ascending numbers, between the neighbours (Hyndman & Fan 1996, type 6,
/// so that the share beyond the extremes is not neglected).
pub(crate) fn quantile(ascending: &[f64], share: f64) -> f64 {
    let at = share * (ascending.len() + 1) as f64 - 1.0;
    let last = ascending.len() - 1;
    if !(at > 0.0) {
        return ascending[0];
    }
    let below = (at as usize).min(last);
    let above = (below + 1).min(last);
    let part = at - below as f64;
    ascending[below] + (ascending[above] - ascending[below]) * part.min(1.0)
}

/// The percentile interval of a statistic of `n` numbers; `None` where the plan cannot resolve the
/// confidence, where there are fewer than [`FEWEST`] numbers, or where a statistic is not finite.
///
/// The statistic is given the indices of the numbers drawn, so that it may be of anything indexed
/// alike: pairs, triples, whole images.
pub fn percentile_bootstrap(
    n: usize,
    plan: &Resampling,
    confidence: f64,
    mut statistic: impl FnMut(&[usize]) -> f64,
) -> Option<Interval> {
    if !plan.resolves(confidence) || n < FEWEST {
        return None;
    }
    let mut random = SplitMix64::new(plan.seed);
    let mut indices = Vec::with_capacity(n);
    let mut values = Vec::with_capacity(plan.resamples as usize);
    for _ in 0..plan.resamples {
        draw(n, &mut random, &mut indices);
        values.push(statistic(&indices));
    }
    if values.iter().any(|v| !v.is_finite()) {
        return None;
    }
    values.sort_by(f64::total_cmp);
    let tail = 0.5 * (1.0 - confidence);
    Some(Interval {
        low: quantile(&values, tail),
        high: quantile(&values, 1.0 - tail),
    })
}
