//! Owen-scrambled Sobol' points, four dimensions at a time.
//!
//! With a = a₀ + 2a₁ + 4a₂ + … the (shuffled) index of the sample, the first two Sobol'
//! coordinates are, digit by digit, x = (a₀ a₁ a₂ …)₂ and y = P·a over GF(2), with Pascal's
//! matrix Pᵢⱼ = C(j, i) mod 2 (Sobol' 1967). They are a (0,2)-sequence: of any aligned 2ᵏ
//! successive points, each dyadic rectangle of area 2⁻ᵏ holds exactly one.
//!
//! The next two dimensions are the same pair taken at the index F·a, where F is Pascal's
//! matrix over GF(4) with parameter ω: Fᵢⱼ = C(j, i) ω^(j−i) on base-4 digits (Faure 1982;
//! Niederreiter 1987). Since P = (I ⊗ U)·P₁ with U = (1 1; 0 1), and P_α P_β = P_(α+β), the
//! four generators are, up to a scrambling of digits, P₀, P₁, P_ω, P_(ω+1): a (0,4)-sequence
//! in base 4. So all four are jointly stratified (any 4ᵏ aligned points, every box of volume
//! 4⁻ᵏ with sides that are powers of ¼), *and* each pair is a (0,2)-sequence in base 2,
//! since F is unit upper triangular. (Compare the "SZ sequences" of Ahmed and others, 2024; the
//! tests check both properties on every box.)
//!
//! Further groups of four are the same points in another order with another scrambling (Burley 2020,
//! "Practical Hash-based Owen Scrambling", §3: padding by shuffling). Shuffling the index by a
//! nested uniform scrambling of its digits keeps every aligned block of 2ᵏ samples together,
//! so all of the above holds for every prefix of 2ᵏ samples.

use crate::hash::{derived_key, fold_multiply};
use crate::sampler::{SampleId, Sampler};
use glam::Vec2;
use wide::{f32x8, u32x8};

/// Owen-scrambled Sobol' coordinates.
///
/// A group of four dimensions shares one order of points: draw what belongs together (a
/// pixel's and a lens's coordinates, a light's and a BSDF's) at dimensions 4k to 4k + 3.
#[derive(Clone, Debug)]
pub struct Sobol {
    key: u64,
    reversed_sample: u32,
    dimension: u32,
    pair: u32,
    /// The eight coordinates of two groups, 2·`pair` and the next. All are computed at once, in
    /// the lanes of one vector: eight cost little more than one.
    coordinates: [f32; 8],
}

impl Sobol {
    /// The coordinates of one sample.
    #[inline]
    pub fn start(sample: &SampleId) -> Self {
        let key = sample.pixel_key();
        let reversed_sample = sample.sample.reverse_bits();
        Self {
            key,
            reversed_sample,
            dimension: 0,
            pair: 0,
            coordinates: coordinates(key, reversed_sample, 0),
        }
    }

    /// Makes the groups of `dimension` the current ones.
    #[inline]
    fn enter_groups_of(&mut self, dimension: u32) {
        let pair = dimension / 8;
        if pair != self.pair {
            self.pair = pair;
            self.coordinates = coordinates(self.key, self.reversed_sample, pair);
        }
    }
}

impl Sampler for Sobol {
    #[inline]
    fn next_1d(&mut self) -> f32 {
        let dimension = self.dimension;
        self.dimension += 1;
        self.enter_groups_of(dimension);
        self.coordinates[dimension as usize % 8]
    }

    #[inline]
    fn next_2d(&mut self) -> Vec2 {
        let dimension = self.dimension.next_multiple_of(2);
        self.dimension = dimension + 2;
        self.enter_groups_of(dimension);
        let first = dimension as usize % 8;
        Vec2::new(self.coordinates[first], self.coordinates[(first + 1) % 8])
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

/// Multipliers that derive the keys of the four scramblings of a group from the group's.
const SCRAMBLES: [u64; 4] = [
    0xd6e8_feb8_6659_fd93,
    0xa076_1d64_78bd_642f,
    0xe703_7ed1_a0b4_28db,
    0x8ebc_6af0_9c88_c6e3,
];

/// The eight coordinates of the two groups 2·`pair` and 2·`pair` + 1, four lanes each.
#[inline]
fn coordinates(pixel_key: u64, reversed_sample: u32, pair: u32) -> [f32; 8] {
    let keys = [2 * pair, 2 * pair + 1].map(|group| derived_key(pixel_key, group));
    let [p, q] = keys;
    // The shuffled index, its least significant digit lowest: the first digit of x.
    let shuffled = nested_uniform_scramble(
        u32x8::splat(reversed_sample),
        halves([p, p, p, p, q, q, q, q]),
    );
    let digits = pascal_of_odd_lanes(pascal_gf4_of_upper_lanes(reverse_bits(shuffled)));
    let [a, b, c, d] = SCRAMBLES;
    let scrambles = halves([
        fold_multiply(p, a),
        fold_multiply(p, b),
        fold_multiply(p, c),
        fold_multiply(p, d),
        fold_multiply(q, a),
        fold_multiply(q, b),
        fold_multiply(q, c),
        fold_multiply(q, d),
    ]);
    random_floats(reverse_bits(nested_uniform_scramble(digits, scrambles)))
}

/// The low and the high halves of eight words.
#[inline]
fn halves(words: [u64; 8]) -> [u32x8; 2] {
    let half = |shift: u32| u32x8::new(words.map(|word| (word >> shift) as u32));
    [half(0), half(32)]
}

/// Pascal's matrix over GF(2) applied, in every second lane, to digits stored least significant
/// first: bit i of the result is the parity of the bits j of `a` with C(j, i) odd. By Lucas'
/// theorem the matrix is a product of five sparse ones, one per binary digit of j.
#[inline]
fn pascal_of_odd_lanes(mut a: u32x8) -> u32x8 {
    let odd = |mask: u32| u32x8::new([0, mask, 0, mask, 0, mask, 0, mask]);
    a ^= (a >> 1) & odd(0x5555_5555);
    a ^= (a >> 2) & odd(0x3333_3333);
    a ^= (a >> 4) & odd(0x0f0f_0f0f);
    a ^= (a >> 8) & odd(0x00ff_00ff);
    a ^ ((a >> 16) & odd(u32::MAX))
}

/// Pascal's matrix over GF(4) with parameter ω, applied, in the last two lanes of each four, to
/// the sixteen base-4 digits of `a`. Its sparse factors, one per binary digit 2ˢ of j, carry
/// ω^(2ˢ): ω, ω², ω, ω².
#[inline]
fn pascal_gf4_of_upper_lanes(mut a: u32x8) -> u32x8 {
    let upper = |mask: u32| u32x8::new([0, 0, mask, mask, 0, 0, mask, mask]);
    a ^= times_omega((a >> 2) & upper(0x3333_3333));
    a ^= times_omega_squared((a >> 4) & upper(0x0f0f_0f0f));
    a ^= times_omega((a >> 8) & upper(0x00ff_00ff));
    a ^ times_omega_squared((a >> 16) & upper(u32::MAX))
}

/// Multiplies sixteen elements h·ω + l of GF(4), two bits each, by ω: ω² = ω + 1, so
/// h·ω + l becomes (h + l)·ω + h.
#[inline]
fn times_omega(a: u32x8) -> u32x8 {
    let low = u32x8::splat(0x5555_5555);
    let high: u32x8 = (a >> 1) & low;
    ((a & low) << 1) ^ (high << 1) ^ high
}

/// Multiplies sixteen elements of GF(4) by ω² = ω + 1.
#[inline]
fn times_omega_squared(a: u32x8) -> u32x8 {
    times_omega(a) ^ a
}

/// The bits of each lane in reverse order.
#[inline]
fn reverse_bits(mut a: u32x8) -> u32x8 {
    let swap = |a: u32x8, shift: u32, mask: u32| {
        let mask = u32x8::splat(mask);
        ((a >> shift) & mask) | ((a & mask) << shift)
    };
    a = swap(a, 1, 0x5555_5555);
    a = swap(a, 2, 0x3333_3333);
    a = swap(a, 4, 0x0f0f_0f0f);
    a = swap(a, 8, 0x00ff_00ff);
    (a >> 16) | (a << 16)
}

/// Owen's nested uniform scrambling of the digits of `x`, stored first digit lowest: each
/// digit is flipped or not, at random, depending on all digits before it. Keys come in two
/// halves, lower first.
///
/// Additions, odd multiplications and x ^= x·(even) carry information only upwards, as nesting
/// requires (Laine & Karras 2011; Burley 2020). Published forms multiply by constants, so the first
/// digits depend on few random bits. Here the multipliers are parts of the key, and any two flips of
/// the first six digits are independent as far as a million keys can show. The variance of a
/// scrambled net depends on pairs only.
#[inline]
fn nested_uniform_scramble(mut x: u32x8, [low, high]: [u32x8; 2]) -> u32x8 {
    let one = u32x8::splat(1);
    x += low;
    x ^= x * (high << 1);
    x *= (high >> 15) | one;
    x += high;
    x ^= x * ((low >> 7) << 1);
    x * ((low >> 15) | one)
}

/// [`crate::hash::random_float`] of eight numbers.
#[inline]
fn random_floats(bits: u32x8) -> [f32; 8] {
    const STEP: f32 = 1.0 / (1 << 24) as f32;
    let bits: u32x8 = bits >> 8u32;
    (bits.cast_signed().round_float() * f32x8::splat(STEP)).to_array()
}

#[cfg(test)]
mod tests;
