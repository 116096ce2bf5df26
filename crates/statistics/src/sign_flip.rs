//! The sign-flip test: is a mean zero, without a normal approximation?
//!
//! If x₁ … xₙ are independent and each is distributed symmetrically about zero (as differences
//! of two exchangeable replicates are), all 2ⁿ choices of signs are equally probable, and the
//! p-value is the share of them whose sum is at least as great as the observed one (Fisher 1935,
//! section 21). Up to [`EXACT`] numbers all are counted; beyond, random ones
//! ([`crate::resampling_test`]).
//!
//! Turned round, the test gives an interval for the point of symmetry μ. Flipping a subset of the
//! xᵢ − μ changes their sum to one at least as great exactly where the subset's mean is at most μ;
//! so the k-th smallest and the k-th greatest of the 2ⁿ − 1 subset means enclose μ with probability
//! 1 − 2k/2ⁿ (Hartigan's 1969 typical values). Of B random subsets, non-empty, the ends are those
//! with k = ⌊(B + 1) · half the error level⌋.

use crate::interval::Interval;
use crate::random::SplitMix64;
use crate::resampling_test::ResamplingTest;

/// The most numbers whose signs are enumerated: 2²⁰ sums.
pub const EXACT: usize = 20;

/// Sums closer than this, relative to Σ|x|, count as equal: more than rounding errors add up to.
const TIE: f64 = 1e-9;

/// Which deviations speak against the hypothesis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// A mean that is too great.
    Greater,
    /// A mean that is too small.
    Less,
    /// Either.
    Both,
}

/// Tests whether the numbers are symmetric about zero, with `resamples` random choices of signs
/// from `seed` where there are more than [`EXACT`] of them; `None` of an empty sample, of
/// non-finite numbers or of no resamples.
#[must_use]
pub fn sign_flip_test(
    sample: &[f64],
    side: Side,
    resamples: u32,
    seed: u64,
) -> Option<ResamplingTest> {
    let total: f64 = sample.iter().map(|x| x.abs()).sum();
    if sample.is_empty() || !total.is_finite() || resamples == 0 {
        return None;
    }
    let measure = |sum: f64| match side {
        Side::Greater => sum,
        Side::Less => -sum,
        Side::Both => sum.abs(),
    };
    let limit = measure(sample.iter().sum()) - TIE * total;
    let extreme = |sum: f64| measure(sum) >= limit;
    // Both sides have a mirror image each.
    let images = if side == Side::Both { 2 } else { 1 };
    if sample.len() <= EXACT {
        let count = enumerate(sample, extreme);
        let choices = 1 << sample.len();
        return Some(ResamplingTest::exact(count.into(), choices, images));
    }
    let mut random = SplitMix64::new(seed);
    let count = (0..resamples)
        .filter(|_| extreme(flipped(sample, &mut random)))
        .count();
    Some(ResamplingTest::drawn(count as u64, resamples.into()))
}

/// The interval that encloses the point about which the numbers are symmetric, with probability
/// `confidence` at least; `None` as for [`sign_flip_test`], or where that confidence cannot be reached.
#[must_use]
pub fn interval(sample: &[f64], confidence: f64, resamples: u32, seed: u64) -> Option<Interval> {
    let finite = sample.iter().all(|x| x.is_finite());
    if sample.is_empty() || !finite || resamples == 0 || !(confidence > 0.0 && confidence < 1.0) {
        return None;
    }
    let exact = sample.len() <= EXACT;
    let possible = if exact {
        (1_u64 << sample.len()) as f64
    } else {
        f64::from(resamples) + 1.0
    };
    // A little above, so that a level of 2/2ⁿ is not lost to rounding.
    let rank = (0.5 * (1.0 - confidence) * possible * (1.0 + 1e-12)) as usize;
    if rank == 0 {
        return None;
    }
    let mut means: Vec<f64> = if exact {
        subset_means(sample)
    } else {
        let mut random = SplitMix64::new(seed);
        (0..resamples)
            .map(|_| random_subset_mean(sample, &mut random))
            .collect()
    };
    means.sort_by(f64::total_cmp);
    Some(Interval {
        low: means[rank - 1],
        high: means[means.len() - rank],
    })
}

/// The means of all non-empty subsets. The sums double with each number: those without it, and with.
fn subset_means(sample: &[f64]) -> Vec<f64> {
    let mut sums = Vec::with_capacity(1 << sample.len());
    sums.push((0.0, 0_u32));
    for x in sample {
        for index in 0..sums.len() {
            let (sum, count) = sums[index];
            sums.push((sum + x, count + 1));
        }
    }
    sums[1..]
        .iter()
        .map(|&(sum, count)| sum / f64::from(count))
        .collect()
}

/// The mean of a random subset; an empty one is drawn again.
fn random_subset_mean(sample: &[f64], random: &mut SplitMix64) -> f64 {
    loop {
        let (mut sum, mut count) = (0.0, 0_u32);
        for chunk in sample.chunks(64) {
            let mut members = random.next();
            for x in chunk {
                if members & 1 == 1 {
                    sum += x;
                    count += 1;
                }
                members >>= 1;
            }
        }
        if count > 0 {
            return sum / f64::from(count);
        }
    }
}

/// Number of extreme choices among all choices of signs. Successive choices of a Gray code differ in
/// one sign; the sum is recomputed every 1,024 to keep its rounding error far below a tie.
fn enumerate(sample: &[f64], extreme: impl Fn(f64) -> bool) -> u32 {
    let mut count = 0;
    let mut sum = 0.0;
    for index in 0..1_u32 << sample.len() {
        let gray = index ^ (index >> 1);
        let signed = |i: usize| {
            if gray >> i & 1 == 1 {
                -sample[i]
            } else {
                sample[i]
            }
        };
        if index % 1024 == 0 {
            sum = (0..sample.len()).map(signed).sum();
        } else {
            sum += 2.0 * signed(index.trailing_zeros() as usize);
        }
        count += u32::from(extreme(sum));
    }
    count
}

/// The sum with random signs.
fn flipped(sample: &[f64], random: &mut SplitMix64) -> f64 {
    let mut sum = 0.0;
    for chunk in sample.chunks(64) {
        let mut signs = random.next();
        for x in chunk {
            sum += if signs & 1 == 1 { -x } else { *x };
            signs >>= 1;
        }
    }
    sum
}
