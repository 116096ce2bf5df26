//! Ratios of two uncertain positive numbers, such as two estimators' costs or errors, by bootstrap
//! percentiles (percentiles of a ratio and of its logarithm are the same).
//!
//! **Unstable denominators.** A variance or an error estimated from a heavy-tailed sample may be far
//! too small, and a ratio to it far too great. The denominator counts as unstable if
//!
//! 1. leaving out one replicate changes it by more than half, or
//! 2. its own bootstrap interval reaches zero or spans more than a factor of four.
//!
//! Then only a lower bound is given: the lower end of the numerator over the upper end of the
//! denominator, each at half of 1 − confidence (Bonferroni).

use crate::bootstrap::{FEWEST, Resampling, draw, quantile};
use crate::interval::Interval;
use crate::random::SplitMix64;

/// The greatest change of a stable denominator when one replicate is left out.
pub const GREATEST_CHANGE: f64 = 0.5;

/// The greatest span of a stable denominator's interval, upper over lower end.
pub const GREATEST_SPAN: f64 = 4.0;

/// What is known of a ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// It lies between.
    Between(Interval),
    /// It is at least this; the denominator is unstable, so nothing is said above.
    AtLeast(f64),
}

/// A ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratio {
    /// The ratio of the samples' statistics.
    pub value: f64,
    /// What is known of the true one.
    pub known: Known,
}

/// The ratio of a statistic of `a` to that of `b`, two independent samples of independent
/// replicates; `None` where either has fewer than eight, the statistics are not positive and
/// finite, or the plan cannot resolve the confidence.
pub fn of<T: Copy>(
    a: &[T],
    b: &[T],
    plan: &Resampling,
    confidence: f64,
    statistic: impl Fn(&[T]) -> f64,
) -> Option<Ratio> {
    let few = a.len().min(b.len()) < FEWEST;
    // Half of the tail for each end of the bound.
    if few || !plan.resolves(1.0 - 0.5 * (1.0 - confidence)) {
        return None;
    }
    let (numerator, denominator) = (statistic(a), statistic(b));
    let value = numerator / denominator;
    if !(numerator > 0.0 && denominator > 0.0 && value > 0.0 && value.is_finite()) {
        return None;
    }
    let (mut up, mut down) = (Vec::new(), Vec::new());
    let mut random = SplitMix64::new(plan.seed);
    let (mut indices, mut drawn) = (Vec::new(), Vec::new());
    for _ in 0..plan.resamples {
        for (sample, values) in [(a, &mut up), (b, &mut down)] {
            draw(sample.len(), &mut random, &mut indices);
            drawn.clear();
            drawn.extend(indices.iter().map(|&i| sample[i]));
            values.push(statistic(&drawn));
        }
    }
    let fragile = depends_on_one(b, denominator, &statistic);
    known(up, down, confidence, fragile).map(|known| Ratio { value, known })
}

/// What resampled numerators and denominators, drawn together, say of their ratio; `None` where
/// one is negative or not a number.
fn known(mut up: Vec<f64>, mut down: Vec<f64>, confidence: f64, fragile: bool) -> Option<Known> {
    if up.iter().chain(&down).any(|v| !(*v >= 0.0)) {
        return None;
    }
    // 0/0 says nothing; it is put above, where it can only widen.
    let mut ratios: Vec<f64> = up
        .iter()
        .zip(&down)
        .map(|(a, b)| if *b == 0.0 { f64::INFINITY } else { a / b })
        .collect();
    for values in [&mut up, &mut down, &mut ratios] {
        values.sort_by(f64::total_cmp);
    }
    let tail = 0.5 * (1.0 - confidence);
    let (least, most) = (quantile(&down, tail), quantile(&down, 1.0 - tail));
    Some(
        if fragile || !(least > 0.0) || most > GREATEST_SPAN * least {
            Known::AtLeast(quantile(&up, tail) / most)
        } else {
            Known::Between(Interval {
                low: quantile(&ratios, tail),
                high: quantile(&ratios, 1.0 - tail),
            })
        },
    )
}

/// Whether leaving out one of the sample changes the statistic too much.
fn depends_on_one<T: Copy>(sample: &[T], whole: f64, statistic: impl Fn(&[T]) -> f64) -> bool {
    (0..sample.len()).any(|left_out| {
        let mut rest = sample.to_vec();
        rest.swap_remove(left_out);
        let change = (statistic(&rest) - whole).abs();
        !(change <= GREATEST_CHANGE * whole)
    })
}
