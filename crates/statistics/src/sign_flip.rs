//! The sign-flip test: is a mean zero, without a normal approximation?
//!
//! If x₁ … xₙ are independent and each is distributed symmetrically about zero (as differences
//! of two exchangeable replicates are), all 2ⁿ choices of signs are equally probable, and the
//! p-value is the share of them whose sum is at least as great as the observed one (Fisher 1935,
//! section 21). Up to [`EXACT`] numbers all are counted; beyond, random ones
//! ([`crate::resampling_test`]).

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
pub fn test(sample: &[f64], side: Side, resamples: u32, seed: u64) -> Option<ResamplingTest> {
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

/// How many of all choices of signs are extreme. Successive choices of a Gray code differ in one
/// sign; the sum is started anew every 1,024 to keep its rounding error far below a tie.
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
