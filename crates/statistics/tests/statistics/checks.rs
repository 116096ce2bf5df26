//! What several tests share: random numbers of a fixed sequence, and comparison with known values.

#![allow(dead_code)] // Every test takes what it needs.

use etalon_statistics::normal;

/// Fails unless `actual` is `expected` to within the relative error `relative`.
#[track_caller]
pub(crate) fn near(actual: f64, expected: f64, relative: f64) {
    assert!(
        (actual / expected - 1.0).abs() <= relative,
        "{actual:e} is not {expected:e}"
    );
}

/// Numbers of a fixed sequence (SplitMix64).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// Uniform, strictly between 0 and 1.
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((z ^ (z >> 31)) >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    /// Standard normal.
    pub(crate) fn normal(&mut self) -> f64 {
        normal::upper_quantile(self.uniform())
    }

    /// Exponential with mean 1.
    pub(crate) fn exponential(&mut self) -> f64 {
        -libm::log(self.uniform())
    }
}
