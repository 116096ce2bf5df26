//! The sign-flip test: is a mean zero, without a normal approximation?
//!
//! If x₁ … xₙ are independent and each is distributed symmetrically about zero (as differences
//! of two exchangeable replicates are), all 2ⁿ choices of signs are equally probable, and the
//! p-value is the share of them whose sum is at least as great as the observed one (Fisher 1935,
//! section 21). Up to [`EXACT`] numbers all are counted; beyond, B random ones, with p = (1 + those
//! at least as great) / (1 + B), which is valid for every B (Phipson & Smyth 2010). No level below
//! [`SignFlip::least`] can be reached: a claim that needs one stays undecided.

use crate::random::SplitMix64;

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

/// The outcome of a test by resampling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignFlip {
    /// The probability of an outcome at least as extreme, under the hypothesis.
    pub p_value: f64,
    /// The smallest p-value the test could have given.
    pub least: f64,
    /// Whether all possibilities were counted.
    pub exact: bool,
}

/// Tests whether the numbers are symmetric about zero, with `resamples` random choices of signs
/// from `seed` where there are more than [`EXACT`] of them; `None` of an empty sample, of
/// non-finite numbers or of no resamples.
#[must_use]
pub fn test(sample: &[f64], side: Side, resamples: u32, seed: u64) -> Option<SignFlip> {
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
    let mirrored = if side == Side::Both { 2.0 } else { 1.0 };
    if sample.len() <= EXACT {
        let choices = 1_u32 << sample.len();
        let count = enumerate(sample, extreme);
        return Some(SignFlip {
            p_value: f64::from(count) / f64::from(choices),
            least: mirrored / f64::from(choices),
            exact: true,
        });
    }
    let mut random = SplitMix64::new(seed);
    let count = (0..resamples)
        .filter(|_| extreme(flipped(sample, &mut random)))
        .count();
    let possible = f64::from(resamples) + 1.0;
    Some(SignFlip {
        p_value: (count as f64 + 1.0) / possible,
        least: 1.0 / possible,
        exact: false,
    })
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
