//! Bootstrap intervals, of anything that can be computed from a sample, dependent or not.
//!
//! Numbers are drawn anew from the sample, with replacement, in blocks of ℓ successive ones (the
//! last followed by the first: Politis & Romano's (1992) circular blocks), and the statistic is
//! computed of each of B such samples. ℓ = 1 is Efron's (1979) bootstrap of independent numbers;
//! for a dependent series [`block_length`] is a rule. The interval of a statistic is BCa (Efron 1987):
//! percentiles at Φ(z₀ + (z₀ + z)/(1 − a(z₀ + z))), z₀ from the share of statistics below the observed
//! one and a from the jackknife over blocks. Means have a better one: [`crate::studentised`].
//!
//! A bootstrap knows no tail that the sample does not show: below [`FEWEST_BLOCKS`] blocks, or with
//! fewer than ten resamples beyond each end, it is refused.

use crate::interval::Interval;
use crate::normal;
use crate::random::SplitMix64;

/// The fewest blocks that are resampled.
pub const FEWEST_BLOCKS: usize = 8;

/// How to resample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resampling {
    /// B, the number of resamples.
    pub resamples: u32,
    /// ℓ, the length of a block; 1 for independent numbers.
    pub block: usize,
    /// Where the random numbers start.
    pub seed: u64,
}

impl Resampling {
    /// For independent numbers.
    #[must_use]
    pub fn independent(resamples: u32, seed: u64) -> Self {
        Self {
            resamples,
            block: 1,
            seed,
        }
    }

    /// Whether a two-sided interval of this confidence has at least ten resamples beyond each end.
    #[must_use]
    pub fn resolves(&self, confidence: f64) -> bool {
        confidence > 0.0
            && confidence < 1.0
            && 0.5 * (1.0 - confidence) * f64::from(self.resamples) >= 10.0
    }
}

/// The length of blocks for a series of `n` dependent numbers: ⌈n^{1/3}⌉, the order that is best
/// for a variance (Hall, Horowitz & Jing 1995).
#[must_use]
pub fn block_length(n: usize) -> usize {
    (1..=n).find(|l| l * l * l >= n).unwrap_or(1)
}

/// The statistic of each of B resampled index sets, in the order drawn; `None` without numbers or
/// resamples, or for a block that is not in 1..=`n`.
///
/// The statistic is given the indices of the numbers drawn, so that it may be of anything indexed
/// alike: pairs, triples, whole images.
pub fn resampled(
    n: usize,
    plan: &Resampling,
    mut statistic: impl FnMut(&[usize]) -> f64,
) -> Option<Vec<f64>> {
    if n == 0 || plan.resamples == 0 || !(1..=n).contains(&plan.block) {
        return None;
    }
    let mut random = SplitMix64::new(plan.seed);
    let mut indices = Vec::with_capacity(n + plan.block);
    Some(
        (0..plan.resamples)
            .map(|_| {
                draw(n, plan.block, &mut random, &mut indices);
                statistic(&indices)
            })
            .collect(),
    )
}

/// Draws `n` indices in blocks.
pub(crate) fn draw(n: usize, block: usize, random: &mut SplitMix64, indices: &mut Vec<usize>) {
    indices.clear();
    while indices.len() < n {
        let start = random.below(n);
        indices.extend((start..start + block).map(|i| i % n));
    }
    indices.truncate(n);
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

/// The BCa interval of a statistic of `n` numbers; `None` where the plan cannot resolve the
/// confidence, where there are fewer than [`FEWEST_BLOCKS`] blocks, where a statistic is not
/// finite, or where the acceleration is too great for the correction.
pub fn bca(
    n: usize,
    plan: &Resampling,
    confidence: f64,
    mut statistic: impl FnMut(&[usize]) -> f64,
) -> Option<Interval> {
    if !plan.resolves(confidence) || n / plan.block.max(1) < FEWEST_BLOCKS {
        return None;
    }
    let all: Vec<usize> = (0..n).collect();
    let observed = statistic(&all);
    let jackknife: Vec<f64> = (0..n / plan.block)
        .map(|left_out| {
            let (start, end) = (left_out * plan.block, (left_out + 1) * plan.block);
            let rest: Vec<usize> = (0..start).chain(end..n).collect();
            statistic(&rest)
        })
        .collect();
    let mut values = resampled(n, plan, statistic)?;
    let finite = |values: &[f64]| values.iter().all(|v| v.is_finite());
    if !observed.is_finite() || !finite(&values) || !finite(&jackknife) {
        return None;
    }
    values.sort_by(f64::total_cmp);
    // Ties count half, for statistics of few values.
    let below = values.partition_point(|&v| v < observed);
    let up_to = values.partition_point(|&v| v <= observed);
    let share = 0.5 * (below + up_to) as f64 / values.len() as f64;
    let middle = jackknife.iter().sum::<f64>() / jackknife.len() as f64;
    let moment = |power: i32| -> f64 {
        let powers = jackknife
            .iter()
            .map(|v| (0..power).fold(1.0, |product, _| product * (middle - v)));
        powers.sum()
    };
    let spread = moment(2);
    if spread == 0.0 || below == values.len() || up_to == 0 {
        // A statistic that does not vary is known; one outside its own resamples is not.
        let constant = values[0] == values[values.len() - 1] && values[0] == observed;
        return constant.then_some(Interval {
            low: observed,
            high: observed,
        });
    }
    let acceleration = moment(3) / (6.0 * spread * spread.sqrt());
    let bias = -normal::upper_quantile(share);
    let end = |tail: f64| {
        let z = bias - normal::upper_quantile(tail);
        let stretch = 1.0 - acceleration * z;
        (stretch > 0.0).then(|| quantile(&values, normal::sf(-(bias + z / stretch))))
    };
    let tail = 0.5 * (1.0 - confidence);
    Some(Interval {
        low: end(tail)?,
        high: end(1.0 - tail)?,
    })
}

/// The percentile interval of a statistic of `n` numbers, without any correction; `None` as for
/// [`bca`].
pub fn percentile(
    n: usize,
    plan: &Resampling,
    confidence: f64,
    statistic: impl FnMut(&[usize]) -> f64,
) -> Option<Interval> {
    if !plan.resolves(confidence) || n / plan.block.max(1) < FEWEST_BLOCKS {
        return None;
    }
    let mut values = resampled(n, plan, statistic)?;
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
