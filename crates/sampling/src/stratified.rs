//! Stratified coordinates: a jittered grid, shuffled independently in every dimension.
//!
//! Mitsuba's `stratified`: of n = r² samples of a pixel, each lies in its own cell of an
//! r × r grid in every pair of dimensions, and in its own n-th part of [0, 1) in every single
//! one; which cell is a random permutation by dimension. Without jitter it is the centre of
//! the cell. Another n works too: then a pair uses the cells of ⌊√n⌋² or more (the smallest grid
//! that holds n), some of which stay empty, at random.

use crate::hash::{ONE_MINUS, derived_key, mix64, permute, random_float};
use crate::sampler::{PixelSample, Sampler};
use glam::Vec2;

/// Stratified coordinates.
#[derive(Clone, Debug)]
pub struct Stratified {
    key: u64,
    sample: u32,
    count: u32,
    side: u32,
    jitter: bool,
    dimension: u32,
}

impl Stratified {
    /// The jittered coordinates of one sample.
    #[inline]
    pub fn start(sample: &PixelSample) -> Self {
        Self::with_jitter(sample, true)
    }

    /// The coordinates of one sample, at a random place in each stratum (`jitter`) or at its
    /// centre.
    #[inline]
    pub fn with_jitter(sample: &PixelSample, jitter: bool) -> Self {
        let count = sample.samples_per_replicate.max(1);
        Self {
            // Samples past the count begin a new set of strata.
            key: derived_key(sample.pixel_key(), sample.sample / count),
            sample: sample.sample % count,
            count,
            side: ceil_sqrt(count),
            jitter,
            dimension: 0,
        }
    }

    /// Two random numbers in [0, 1) within a stratum, or its centre.
    #[inline]
    fn offset(&self, key: u64) -> Vec2 {
        if self.jitter {
            let bits = mix64(key ^ u64::from(self.sample) << 32);
            Vec2::new(random_float(bits as u32), random_float((bits >> 32) as u32))
        } else {
            Vec2::splat(0.5)
        }
    }
}

/// The smallest r with r² ≥ n.
pub(crate) fn ceil_sqrt(n: u32) -> u32 {
    let root = n.isqrt();
    if root * root == n { root } else { root + 1 }
}

impl Sampler for Stratified {
    #[inline]
    fn next_1d(&mut self) -> f32 {
        let key = derived_key(self.key, self.dimension);
        self.dimension += 1;
        let stratum = permute(self.sample, self.count, key);
        ((stratum as f32 + self.offset(key).x) / self.count as f32).min(ONE_MINUS)
    }

    #[inline]
    fn next_2d(&mut self) -> Vec2 {
        self.dimension = self.dimension.next_multiple_of(2);
        let key = derived_key(self.key, self.dimension);
        self.dimension += 2;
        let cell = permute(self.sample, self.side * self.side, key);
        let corner = Vec2::new((cell % self.side) as f32, (cell / self.side) as f32);
        ((corner + self.offset(key)) / self.side as f32).min(Vec2::splat(ONE_MINUS))
    }

    #[inline]
    fn dimension(&self) -> u32 {
        self.dimension
    }

    #[inline]
    fn skip_to(&mut self, dimension: u32) {
        self.dimension = dimension;
    }
}
