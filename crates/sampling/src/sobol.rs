//! Owen-scrambled Sobol' points, four dimensions at a time.
//!
//! With a = a₀ + 2a₁ + 4a₂ + … the (shuffled) index of the sample, the first two Sobol'
//! coordinates are, digit by digit, x = (a₀ a₁ a₂ …)₂ and y = P·a over GF(2), with Pascal's
//! matrix Pᵢⱼ = C(j, i) mod 2 (Sobol' 1967). They are a (0,2)-sequence: of any aligned 2ᵏ
//! successive points, each dyadic rectangle of area 2⁻ᵏ, of whatever shape, holds exactly one.
//!
//! The next two dimensions are the same pair taken at the index F·a, where F is Pascal's
//! matrix over GF(4) with parameter ω: Fᵢⱼ = C(j, i) ω^(j−i) on base-4 digits (Faure 1982;
//! Niederreiter 1987). Since P = (I ⊗ U)·P₁ with U = (1 1; 0 1), and P_α P_β = P_(α+β), the
//! four generators are, up to a scrambling of digits, P₀, P₁, P_ω, P_(ω+1): a (0,4)-sequence
//! in base 4. So all four are jointly stratified (any 4ᵏ aligned points, every box of volume
//! 4⁻ᵏ with sides that are powers of ¼), *and* each pair is a (0,2)-sequence in base 2,
//! since F is unit upper triangular (the idea of Ahmed, Skopenkov, Hadwiger & Wonka 2024,
//! "SZ Sequences").
//!
//! Further groups of four are the same points in another order, scrambled anew (Burley 2020,
//! "Practical Hash-based Owen Scrambling", §3: padding by shuffling). Shuffling the index by a
//! nested uniform scrambling of its digits keeps every aligned block of 2ᵏ samples together,
//! so all of the above holds for every prefix of 2ᵏ samples.

use crate::hash::{derived_key, fold_multiply, random_float};
use crate::sampler::{PixelSample, Sampler};
use glam::Vec2;

/// Owen-scrambled Sobol' coordinates.
///
/// A group of four dimensions shares one order of points: draw what belongs together (a
/// pixel's and a lens's coordinates, a light's and a BSDF's) at dimensions 4k to 4k + 3.
#[derive(Clone, Debug)]
pub struct Sobol {
    key: u64,
    reversed_sample: u32,
    dimension: u32,
    group: Group,
}

/// What the four dimensions of one group share.
#[derive(Clone, Copy, Debug)]
struct Group {
    number: u32,
    /// The shuffled index, least significant digit first (at the top).
    index: u32,
    key: u64,
}

impl Sobol {
    /// The coordinates of one sample.
    #[inline]
    pub fn start(sample: &PixelSample) -> Self {
        let key = sample.pixel_key();
        let reversed_sample = sample.sample.reverse_bits();
        Self {
            key,
            reversed_sample,
            dimension: 0,
            group: Group::new(key, reversed_sample, 0),
        }
    }

    #[inline]
    fn group(&mut self, dimension: u32) -> Group {
        let number = dimension / 4;
        if number != self.group.number {
            self.group = Group::new(self.key, self.reversed_sample, number);
        }
        self.group
    }
}

impl Group {
    #[inline]
    fn new(pixel_key: u64, reversed_sample: u32, number: u32) -> Self {
        let key = derived_key(pixel_key, number);
        Self {
            number,
            index: nested_uniform_scramble(reversed_sample, key).reverse_bits(),
            key,
        }
    }

    /// Index of the point of the pair `half` (0 or 1): digits of its first coordinate.
    #[inline]
    fn half(&self, half: u32) -> u32 {
        if half == 0 {
            self.index
        } else {
            pascal_gf4(self.index)
        }
    }

    /// The coordinate whose digits are `digits`, scrambled as dimension `place` of the group.
    #[inline]
    fn scramble(&self, digits: u32, place: u32) -> u32 {
        nested_uniform_scramble(
            digits,
            fold_multiply(self.key, SCRAMBLES[place as usize % 4]),
        )
    }
}

/// Odd constants with as many ones as zeros, one for the scrambling of each dimension of a group.
const SCRAMBLES: [u64; 4] = [
    0xd6e8_feb8_6659_fd93,
    0xa076_1d64_78bd_642f,
    0xe703_7ed1_a0b4_28db,
    0x8ebc_6af0_9c88_c6e3,
];

impl Sampler for Sobol {
    #[inline]
    fn next_1d(&mut self) -> f32 {
        let dimension = self.dimension;
        self.dimension += 1;
        let group = self.group(dimension);
        let first = group.half(dimension / 2 % 2);
        let digits = if dimension.is_multiple_of(2) {
            first
        } else {
            pascal(first)
        };
        random_float(group.scramble(digits, dimension).reverse_bits())
    }

    #[inline]
    fn next_2d(&mut self) -> Vec2 {
        let dimension = self.dimension.next_multiple_of(2);
        self.dimension = dimension + 2;
        let group = self.group(dimension);
        let first = group.half(dimension / 2 % 2);
        let x = group.scramble(first, dimension);
        let y = group.scramble(pascal(first), dimension + 1);
        // One reversal of 64 bits is cheaper than two of 32; it exchanges the halves.
        let both = (u64::from(y) << 32 | u64::from(x)).reverse_bits();
        Vec2::new(random_float((both >> 32) as u32), random_float(both as u32))
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

/// Pascal's matrix over GF(2) applied to digits stored least significant first: bit i of the
/// result is the parity of the bits j of `a` with C(j, i) odd. By Lucas' theorem the matrix is
/// a product of five sparse ones, one per binary digit of j.
#[inline]
fn pascal(mut a: u32) -> u32 {
    a ^= (a >> 1) & 0x5555_5555;
    a ^= (a >> 2) & 0x3333_3333;
    a ^= (a >> 4) & 0x0f0f_0f0f;
    a ^= (a >> 8) & 0x00ff_00ff;
    a ^ (a >> 16)
}

/// Pascal's matrix over GF(4) with parameter ω, applied to the sixteen base-4 digits of `a`.
/// Its sparse factors, one per binary digit 2ˢ of j, carry ω^(2ˢ): ω, ω², ω, ω².
#[inline]
fn pascal_gf4(mut a: u32) -> u32 {
    a ^= times_omega((a >> 2) & 0x3333_3333);
    a ^= times_omega_squared((a >> 4) & 0x0f0f_0f0f);
    a ^= times_omega((a >> 8) & 0x00ff_00ff);
    a ^ times_omega_squared(a >> 16)
}

/// Multiplies sixteen elements h·ω + l of GF(4), two bits each, by ω: ω² = ω + 1, so
/// h·ω + l becomes (h + l)·ω + h.
#[inline]
fn times_omega(a: u32) -> u32 {
    let high = (a >> 1) & 0x5555_5555;
    ((a & 0x5555_5555) << 1) ^ (high << 1) ^ high
}

/// Multiplies sixteen elements of GF(4) by ω² = ω + 1.
#[inline]
fn times_omega_squared(a: u32) -> u32 {
    times_omega(a) ^ a
}

/// Owen's nested uniform scrambling of the digits of `x`, stored first digit lowest: each
/// digit is flipped or not, at random, depending on all digits before it.
///
/// Additions, odd multiplications and x ^= x·(even) carry information only upwards, which is
/// all that nesting asks (Laine & Karras 2011; Burley 2020). Published forms multiply by
/// constants, which leaves the first digits few random bits to depend on; here the multipliers
/// are parts of the key, and any two flips of the first six digits are independent to within
/// what a million keys can tell. Pairs are what the variance of a scrambled net depends on.
#[inline]
fn nested_uniform_scramble(mut x: u32, key: u64) -> u32 {
    let (low, high) = (key as u32, (key >> 32) as u32);
    x = x.wrapping_add(low);
    x ^= x.wrapping_mul(high << 1);
    x = x.wrapping_mul((high >> 15) | 1);
    x = x.wrapping_add(high);
    x ^= x.wrapping_mul((low >> 7) << 1);
    x.wrapping_mul((low >> 15) | 1)
}

#[cfg(test)]
mod tests;
