//! The permutation test of two samples: do they have the same mean, without a normal
//! approximation?
//!
//! If both come from one distribution, every division of their union into two hands is equally
//! probable. The statistic is |Welch's t|; studentised, the test also keeps its level in large
//! samples where only the means are equal (Janssen 1997; Chung & Romano 2013). Up to [`EXACT`]
//! divisions all are counted; beyond, random ones ([`crate::resampling_test`]).

use crate::estimate::Estimate;
use crate::random::SplitMix64;
use crate::resampling_test::ResamplingTest;
use crate::summary::Summary;

/// The most divisions that are enumerated.
pub const EXACT: u64 = 200_000;

/// Statistics closer than this, relatively, count as equal.
const TIE: f64 = 1e-9;

/// Tests whether two samples come from one distribution, by the distance of their means, with
/// `resamples` random divisions from `seed` where there are more than [`EXACT`]; `None` unless
/// both have at least two numbers, all finite, and there are resamples.
#[must_use]
pub fn test(a: &[f64], b: &[f64], resamples: u32, seed: u64) -> Option<ResamplingTest> {
    if a.len() < 2 || b.len() < 2 || resamples == 0 {
        return None;
    }
    let observed = statistic(a, b)?;
    let limit = observed * (1.0 - TIE);
    let mut united: Vec<f64> = a.iter().chain(b).copied().collect();
    if let Some(divisions) = choose(united.len() as u64, a.len() as u64) {
        let mut hands = (Vec::with_capacity(a.len()), Vec::with_capacity(b.len()));
        let count = divide(&united, a.len(), &mut hands, &|first, second| {
            statistic(first, second).is_some_and(|t| t >= limit)
        });
        let images = if a.len() == b.len() { 2 } else { 1 };
        return Some(ResamplingTest::exact(count, divisions, images));
    }
    let mut random = SplitMix64::new(seed);
    let mut count = 0;
    for _ in 0..resamples {
        for i in 0..a.len() {
            let other = i + random.below(united.len() - i);
            united.swap(i, other);
        }
        let (first, second) = united.split_at(a.len());
        count += u64::from(statistic(first, second).is_some_and(|t| t >= limit));
    }
    Some(ResamplingTest::drawn(count, resamples.into()))
}

/// |t|: zero where the means are equal, infinite where they differ without any variance.
fn statistic(a: &[f64], b: &[f64]) -> Option<f64> {
    let difference = Estimate::welch(&Summary::of(a)?, &Summary::of(b)?);
    Some(if difference.value() == 0.0 {
        0.0
    } else {
        (difference.value() / difference.standard_error()).abs()
    })
}

/// The number of ways to choose `k` of `n`, if at most [`EXACT`].
fn choose(n: u64, k: u64) -> Option<u64> {
    let mut ways = 1_u64;
    for i in 0..k.min(n - k) {
        ways = ways * (n - i) / (i + 1);
        if ways > EXACT {
            return None;
        }
    }
    Some(ways)
}

/// Counts the divisions of `rest` into a first hand of `wanted` more and a second hand that are
/// `extreme`.
fn divide(
    rest: &[f64],
    wanted: usize,
    hands: &mut (Vec<f64>, Vec<f64>),
    extreme: &impl Fn(&[f64], &[f64]) -> bool,
) -> u64 {
    let Some((&x, others)) = rest.split_first() else {
        return u64::from(extreme(&hands.0, &hands.1));
    };
    let mut count = 0;
    if wanted > 0 {
        hands.0.push(x);
        count += divide(others, wanted - 1, hands, extreme);
        hands.0.pop();
    }
    if others.len() >= wanted {
        hands.1.push(x);
        count += divide(others, wanted, hands, extreme);
        hands.1.pop();
    }
    count
}
