//! Two stratified numbers for every sample of a pixel, independent of the sampler.
//!
//! They are the first two Sobol' coordinates, a (0,2)-sequence in base 2, scrambled as in [`crate::sobol`]: of any
//! aligned 2ᵏ successive samples each dyadic rectangle of area 2⁻ᵏ holds exactly one.

use crate::hash::{derived_key, fold_multiply, random_float};
use crate::sampler::SampleId;
use glam::Vec2;

/// Key that differs from those of all samplers.
const STREAM: u32 = 0x9d2c_5681;

/// The numbers of a sample, each in [0, 1).
#[inline]
pub fn stratified_pair(sample: &SampleId) -> Vec2 {
    let key = derived_key(sample.pixel_key(), STREAM);
    // The shuffled index, its first digit lowest.
    let shuffled = nested_uniform_scramble(sample.sample.reverse_bits(), key);
    let digits = shuffled.reverse_bits();
    let coordinate = |digits: u32, scramble: u64| {
        let scrambled = nested_uniform_scramble(digits, fold_multiply(key, scramble));
        random_float(scrambled.reverse_bits())
    };
    Vec2::new(
        coordinate(digits, 0xd6e8_feb8_6659_fd93),
        coordinate(pascal(digits), 0xa076_1d64_78bd_642f),
    )
}

/// Pascal's matrix over GF(2), applied to digits stored least significant first.
#[inline]
fn pascal(mut a: u32) -> u32 {
    a ^= (a >> 1) & 0x5555_5555;
    a ^= (a >> 2) & 0x3333_3333;
    a ^= (a >> 4) & 0x0f0f_0f0f;
    a ^= (a >> 8) & 0x00ff_00ff;
    a ^ (a >> 16)
}

/// As that of [`crate::sobol`], for one number.
#[inline]
fn nested_uniform_scramble(mut x: u32, key: u64) -> u32 {
    let (low, high) = (key as u32, (key >> 32) as u32);
    x = x.wrapping_add(low);
    x ^= x.wrapping_mul(high << 1);
    x = x.wrapping_mul((high >> 15) | 1).wrapping_add(high);
    x ^= x.wrapping_mul((low >> 7) << 1);
    x.wrapping_mul((low >> 15) | 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mutants: no Pascal matrix, a key that depends on the sample.
    #[test]
    fn every_dyadic_rectangle_holds_one() {
        for pixel in 0..8 {
            for block in [0u32, 3] {
                let points: Vec<Vec2> = (block * 64..(block + 1) * 64)
                    .map(|sample| {
                        stratified_pair(&SampleId {
                            seed: 1,
                            replicate: 0,
                            pixel: (pixel, 7),
                            sample,
                            samples_per_replicate: 256,
                            blocks: 1,
                        })
                    })
                    .collect();
                for columns in (0..=6).map(|k| 1u32 << k) {
                    let cells = Vec2::new(columns as f32, (64 / columns) as f32);
                    let mut found: Vec<u32> = points
                        .iter()
                        .map(|p| (*p * cells).as_uvec2())
                        .map(|cell| cell.y * columns + cell.x)
                        .collect();
                    found.sort_unstable();
                    assert_eq!(found, (0..64).collect::<Vec<_>>(), "{columns}");
                }
            }
        }
    }
}
