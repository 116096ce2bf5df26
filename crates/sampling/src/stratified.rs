//! Stratified coordinates: a jittered grid, shuffled independently in every dimension.
//!
//! Mitsuba's `stratified`: of n = r² samples of a pixel, each lies in its own cell of an
//! r × r grid in every pair of dimensions, and in its own n-th part of [0, 1) in every single
//! one; which cell is a random permutation by dimension. Without jitter it is the centre of
//! the cell. Another n works too: then a pair uses the cells of ⌊√n⌋² or more (the smallest grid
//! that holds n), some of which stay empty, at random.
//!
//! Where replicates are blocks of one sequence, each block is such a set of n samples. Each stratum is
//! divided into R parts, one for every block, so that together they are n·R samples, each in its own part.

use crate::hash::{derived_key, mix64, permute, random_float};
use crate::sampler::{SampleId, Sampler};
use etalon_math::float::ONE_MINUS_EPSILON;
use glam::Vec2;

/// Stratified coordinates.
#[derive(Clone, Debug)]
pub struct Stratified {
    key: u64,
    /// Among those of all blocks.
    sample: u64,
    /// The sample within its block, and the samples of a block.
    place: u32,
    count: u32,
    side: u32,
    /// Index of the block, and number of blocks.
    block: u32,
    blocks: u32,
    jitter: bool,
    dimension: u32,
}

impl Stratified {
    /// The jittered coordinates of one sample.
    #[inline]
    pub fn start(sample: &SampleId) -> Self {
        Self::with_jitter(sample, true)
    }

    /// The coordinates of one sample, at a random place in each stratum (`jitter`) or at its
    /// centre.
    #[inline]
    pub fn with_jitter(sample: &SampleId, jitter: bool) -> Self {
        let count = sample.samples_per_replicate.max(1);
        let blocks = sample.blocks.max(1);
        let all = u64::from(count) * u64::from(blocks);
        let [index, each] = [sample.sample, count].map(u64::from);
        let within = index % all;
        Self {
            // Samples past the count begin a new set of strata.
            key: derived_key(sample.pixel_key(), (index / all) as u32),
            sample: within,
            place: (within % each) as u32,
            count,
            side: ceil_sqrt(count),
            block: (within / each) as u32,
            blocks,
            jitter,
            dimension: 0,
        }
    }

    /// Two random numbers in [0, 1) within a stratum, or its centre.
    #[inline]
    fn offset(&self, key: u64) -> Vec2 {
        if self.jitter {
            let bits = mix64(key ^ self.sample << 32);
            Vec2::new(random_float(bits as u32), random_float((bits >> 32) as u32))
        } else {
            Vec2::splat(0.5)
        }
    }

    /// The key for shuffling the strata of this block.
    #[inline]
    fn shuffle(&self, key: u64) -> u64 {
        match self.block {
            0 => key,
            block => derived_key(key, block),
        }
    }

    /// The part of a stratum that this block takes.
    #[inline]
    fn part(&self, stratum: u32, key: u64) -> u32 {
        match self.blocks {
            1 => 0,
            blocks => permute(self.block, blocks, derived_key(!key, stratum)),
        }
    }
}

/// The columns of the most nearly square grid of exactly `parts` cells: at most as many as rows.
#[inline]
fn columns(parts: u32) -> u32 {
    let divides = |columns: &u32| parts.is_multiple_of(*columns);
    (1..=parts.isqrt()).rev().find(divides).unwrap_or(1)
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
        let stratum = permute(self.place, self.count, self.shuffle(key));
        let part = self.part(stratum, key) as f32;
        let within = (part + self.offset(key).x) / self.blocks as f32;
        ((stratum as f32 + within) / self.count as f32).min(ONE_MINUS_EPSILON)
    }

    #[inline]
    fn next_2d(&mut self) -> Vec2 {
        self.dimension = self.dimension.next_multiple_of(2);
        let key = derived_key(self.key, self.dimension);
        self.dimension += 2;
        let cell = permute(self.place, self.side * self.side, self.shuffle(key));
        let corner = Vec2::new((cell % self.side) as f32, (cell / self.side) as f32);
        let part = self.part(cell, key);
        let columns = columns(self.blocks);
        let grid = Vec2::new(columns as f32, (self.blocks / columns) as f32);
        let part = Vec2::new((part % columns) as f32, (part / columns) as f32);
        let within = (part + self.offset(key)) / grid;
        ((corner + within) / self.side as f32).min(Vec2::splat(ONE_MINUS_EPSILON))
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
