//! Mixing functions: from structured integers (seeds, pixels, dimensions) to random-looking
//! bits, and from those to floats and permutations.
//!
//! None of this is cryptography. The requirement, which is tested, is that neighbouring arguments
//! give results without any correlation visible in an image.

/// 2⁶⁴ divided by the golden ratio, made odd: successive multiples are spread evenly.
pub const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Mixes 64 bits so that every input bit flips every output bit with probability ½ (a
/// bijection; the finaliser of SplitMix64 with the multipliers that David Stafford found,
/// his variant 13).
#[inline]
pub const fn mix64(mut x: u64) -> u64 {
    x ^= x >> 30;
    x = x.wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x ^= x >> 27;
    x = x.wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// The key of replicate `replicate` of the image with seed `seed`. The seed is mixed first,
/// so that neighbouring seeds and neighbouring replicates have nothing in common.
#[inline]
pub const fn stream_key(seed: u64, replicate: u32) -> u64 {
    mix64(mix64(seed.wrapping_add(GOLDEN)).wrapping_add(replicate as u64))
}

/// The `index`-th independent key derived from `key`.
#[inline]
pub const fn derived_key(key: u64, index: u32) -> u64 {
    mix64(key.wrapping_add(GOLDEN.wrapping_mul(index as u64 + 1)))
}

/// Both halves of the 128-bit product of two words, folded into one: the cheapest way to take
/// several keys from one already mixed (one multiplication each, by different constants).
#[inline]
pub const fn fold_multiply(a: u64, b: u64) -> u64 {
    let product = a as u128 * b as u128;
    product as u64 ^ (product >> 64) as u64
}

/// The upper 24 of 32 random bits as a float in [0, 1): a multiple of 2⁻²⁴, so at most
/// 1 − 2⁻²⁴, and every value equally likely.
#[inline]
pub fn random_float(bits: u32) -> f32 {
    const STEP: f32 = 1.0 / (1 << 24) as f32;
    (bits >> 8) as f32 * STEP
}

/// Where `index` goes in the random permutation of 0..`count` that `key` selects.
///
/// A bijection of the next power of two, walked until it lands inside (Kensler 2013,
/// "Correlated Multi-Jittered Sampling", §3): fewer than two steps are needed on average. The
/// bijection is ours: six rounds, each adding and multiplying by other bits of the key; where any
/// two indices go is then equally likely to within a percent. Of up to four things, where rounds
/// converge slowest, the permutation is drawn by exchanging, and exact. Requires `index < count`.
#[inline]
pub fn permute(index: u32, count: u32, key: u64) -> u32 {
    debug_assert!(index < count);
    if count <= 4 {
        return permute_few(index, count, key);
    }
    let width = u32::BITS - (count - 1).leading_zeros();
    let mask = u32::MAX >> (u32::BITS - width);
    let shift = width.div_ceil(2);
    let mut x = index;
    loop {
        let mut key = key;
        for _ in 0..6 {
            x = x.wrapping_add(key as u32);
            x = x.wrapping_mul((key >> 32) as u32 | 1) & mask;
            x ^= x >> shift;
            key = key.rotate_left(23);
        }
        if x < count {
            return x;
        }
    }
}

/// [`permute`] for a count of at most four: from the last place down, each is exchanged with
/// one at or before it (Fisher & Yates), followed for `index` alone.
#[inline]
fn permute_few(index: u32, count: u32, key: u64) -> u32 {
    let mut at = index;
    for place in (1..count).rev() {
        let bits = key >> (16 * (place - 1)) & 0xffff;
        let partner = ((bits * u64::from(place + 1)) >> 16) as u32;
        if at == place {
            at = partner;
        } else if at == partner {
            at = place;
        }
    }
    at
}
