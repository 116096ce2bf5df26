//! The random numbers of resampling: SplitMix64 (Steele, Lea & Flood 2014).
//!
//! s ← s + 0x9e3779b97f4a7c15; the output is Stafford's "Mix13" of s. Same seed, same numbers, on
//! every machine; results of resampling are functions of their arguments.

/// A stream of 64-bit numbers.
#[derive(Clone, Debug)]
pub(crate) struct SplitMix64(u64);

impl SplitMix64 {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    #[inline]
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// An index below `n` > 0, by the upper half of a 128-bit product; its bias is below n · 2⁻⁶⁴.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.next()) * n as u128) >> 64) as usize
    }

    /// Two indices below `n` < 2³², of one number; their bias is below n · 2⁻³².
    #[inline]
    pub(crate) fn two_below(&mut self, n: usize) -> [usize; 2] {
        let both = self.next();
        [both >> 32, both & 0xffff_ffff].map(|half| ((half * n as u64) >> 32) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The reference implementation's first numbers for seed 1234567, as widely published.
    #[test]
    fn the_published_sequence() {
        let mut random = SplitMix64::new(1_234_567);
        for expected in [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
            4_593_380_528_125_082_431,
            16_408_922_859_458_223_821,
        ] {
            assert_eq!(random.next(), expected);
        }
        assert!((0..1000).all(|_| random.below(7) < 7));
        assert!((0..1000).all(|_| random.two_below(7).iter().all(|i| *i < 7)));
    }
}
