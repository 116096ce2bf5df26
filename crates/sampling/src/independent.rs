//! Independent uniform numbers: a permuted congruential generator (O'Neill 2014, PCG32),
//! one short stream per sample.
//!
//! The state *and* the stream number of the generator are hashed from the whole address of
//! the sample: generators with neighbouring stream numbers, or neighbouring states, are
//! correlated; hashed ones are not.

use crate::hash::{derived_key, mix64, random_float};
use crate::sampler::{SampleId, Sampler};
use glam::Vec2;
use rand::Rng;
use rand_pcg::Pcg32;

/// Independent uniform coordinates.
#[derive(Clone, Debug)]
pub struct Independent {
    generator: Pcg32,
    dimension: u32,
}

impl Independent {
    /// The coordinates of one sample.
    #[inline]
    pub fn start(sample: &SampleId) -> Self {
        Self::from_key(derived_key(sample.pixel_key(), sample.sample))
    }

    /// A stream of its own for work that belongs to no pixel (photons, Markov chains): one
    /// per `key`. Neighbouring keys give independent streams.
    #[inline]
    pub fn from_key(key: u64) -> Self {
        let state = mix64(key);
        let stream = mix64(state ^ key.rotate_left(32));
        Self {
            generator: Pcg32::new(state, stream),
            dimension: 0,
        }
    }
}

impl Sampler for Independent {
    #[inline]
    fn next_1d(&mut self) -> f32 {
        self.dimension += 1;
        random_float(self.generator.next_u32())
    }

    #[inline]
    fn next_2d(&mut self) -> Vec2 {
        if self.dimension % 2 == 1 {
            self.next_1d();
        }
        let x = self.next_1d();
        let y = self.next_1d();
        Vec2::new(x, y)
    }

    #[inline]
    fn dimension(&self) -> u32 {
        self.dimension
    }

    #[inline]
    fn skip_to(&mut self, dimension: u32) {
        // The generator's period is 2⁶⁴: a step back is 2⁶⁴ − 1 steps ahead, and a jump takes a
        // step per bit of the distance.
        match u64::from(dimension).wrapping_sub(u64::from(self.dimension)) {
            0 => {}
            1 => {
                self.generator.next_u32();
            }
            steps => self.generator.advance(steps),
        }
        self.dimension = dimension;
    }
}
