//! Many dependent means at once, without a normal approximation: replicate sign flips with the
//! maximum statistic.
//!
//! Replicate i gives a vector of differences, one per tile. Under the hypothesis that tile j's
//! differences are symmetric about zero (two exchangeable estimators), flipping the sign of *whole
//! replicates* leaves the distribution of all such tiles together unchanged, however they depend
//! on each other. With |t| of tile j a growing function of
//!
//! uⱼ = |Σᵢ xᵢⱼ| / √(Σᵢ xᵢⱼ²),
//!
//! the adjusted p-value of tile j is the share of flips whose greatest u, over all tiles, is at
//! least the observed uⱼ (Westfall & Young 1993, single-step maxT): the probability of any false
//! rejection is α exactly, and dependence makes the test sharper rather than more cautious, as
//! Holm's procedure is. All 2^R flips up to [`EXACT`] replicates; beyond, random ones
//! ([`crate::resampling_test`]).

use crate::random::SplitMix64;
use crate::resampling_test::ResamplingTest;

/// The most replicates whose signs are enumerated: 2¹² flips (an overall sign changes nothing, so
/// half of them are computed).
pub const EXACT: usize = 12;

/// Statistics closer than this, relatively, count as equal.
const TIE: f64 = 1e-9;

/// What became of the tiles.
#[derive(Clone, Debug, PartialEq)]
pub struct MaximumTest {
    /// The p-value of the hypothesis that no tile differs, the smallest p-value the test could have
    /// given, and whether all flips were counted.
    pub overall: ResamplingTest,
    /// Each tile's adjusted p-value.
    pub adjusted: Vec<f64>,
}

/// Tests whether any of `tiles` means is not zero, from replicates of `tiles` differences each, one
/// replicate after the other; with `resamples` random flips from `seed` where there are more than
/// [`EXACT`] replicates. `None` of fewer than two whole replicates, no tiles, non-finite numbers or
/// no resamples.
#[must_use]
pub fn test(differences: &[f64], tiles: usize, resamples: u32, seed: u64) -> Option<MaximumTest> {
    if tiles == 0
        || !differences.len().is_multiple_of(tiles)
        || differences.len() < 2 * tiles
        || differences.iter().any(|x| !x.is_finite())
        || resamples == 0
    {
        return None;
    }
    let replicates = differences.len() / tiles;
    let scaled = normalised(differences, tiles);
    let mut sums = vec![0.0; tiles];
    let mut greatest = |signs: &mut dyn FnMut() -> bool| -> f64 {
        sums.fill(0.0);
        for replicate in scaled.chunks_exact(tiles) {
            let sign = if signs() { -1.0 } else { 1.0 };
            for (sum, x) in sums.iter_mut().zip(replicate) {
                *sum += sign * x;
            }
        }
        sums.iter().fold(0.0, |most, sum| sum.abs().max(most))
    };
    let exact = replicates <= EXACT;
    let mut maxima: Vec<f64> = if exact {
        (0..1_u32 << (replicates - 1))
            .map(|mut flips| {
                // The first replicate keeps its sign.
                flips <<= 1;
                greatest(&mut || {
                    let sign = flips & 1 == 1;
                    flips >>= 1;
                    sign
                })
            })
            .collect()
    } else {
        let mut random = SplitMix64::new(seed);
        (0..resamples)
            .map(|_| greatest(&mut || random.next() >> 63 == 1))
            .collect()
    };
    maxima.sort_by(f64::total_cmp);
    let tested = |u: f64| {
        let below = maxima.partition_point(|&most| most < u * (1.0 - TIE));
        let (count, all) = ((maxima.len() - below) as u64, maxima.len() as u64);
        if exact {
            ResamplingTest::exact(count, all, 1)
        } else {
            ResamplingTest::drawn(count, all)
        }
    };
    let observed: Vec<f64> = (0..tiles)
        .map(|tile| {
            let sum: f64 = scaled.iter().skip(tile).step_by(tiles).sum();
            sum.abs()
        })
        .collect();
    Some(MaximumTest {
        overall: tested(observed.iter().copied().fold(0.0, f64::max)),
        adjusted: observed.iter().map(|&u| tested(u).p_value).collect(),
    })
}

/// The differences over the root of their tile's sum of squares; zeros where all are zero.
fn normalised(differences: &[f64], tiles: usize) -> Vec<f64> {
    let mut scale = vec![0.0_f64; tiles];
    for replicate in differences.chunks_exact(tiles) {
        for (scale, x) in scale.iter_mut().zip(replicate) {
            *scale = scale.max(x.abs());
        }
    }
    let mut squares = vec![0.0; tiles];
    for replicate in differences.chunks_exact(tiles) {
        for ((square, scale), x) in squares.iter_mut().zip(&scale).zip(replicate) {
            if *scale > 0.0 {
                *square += (x / scale) * (x / scale);
            }
        }
    }
    let mut scaled = Vec::with_capacity(differences.len());
    for replicate in differences.chunks_exact(tiles) {
        for ((square, scale), x) in squares.iter().zip(&scale).zip(replicate) {
            scaled.push(if *scale > 0.0 {
                x / scale / square.sqrt()
            } else {
                0.0
            });
        }
    }
    scaled
}
