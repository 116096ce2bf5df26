//! That the matrices are what they claim and the scrambling is as random as it must be.

use super::*;
use crate::hash::{GOLDEN, mix64};
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// The scrambling of one number.
fn scrambled(x: u32, key: u64) -> u32 {
    nested_uniform_scramble(u32x8::splat(x), halves([key; 8])).to_array()[0]
}

/// The flips of the first six digits, after each of their 63 prefixes, under one key.
fn flips(scramble: impl Fn(u32) -> u32) -> [bool; 63] {
    core::array::from_fn(|node| {
        let level = (node + 1).ilog2();
        let prefix = (node + 1) as u32 - (1 << level);
        (scramble(prefix) ^ prefix) >> level & 1 == 1
    })
}

/// The largest |z| of "the two flips agree half of the time" over all pairs of flips, and
/// of "the flip happens half of the time" over all flips, among 2¹⁶ keys.
fn worst_pair(scramble: impl Fn(u32, u64) -> u32) -> f64 {
    const KEYS: usize = 1 << 16;
    let mut columns = vec![[0u64; KEYS / 64]; 64];
    for i in 0..KEYS {
        let key = mix64(GOLDEN.wrapping_mul(i as u64 + 1));
        for (column, flip) in columns.iter_mut().zip(flips(|x| scramble(x, key))) {
            column[i / 64] |= u64::from(flip) << (i % 64);
        }
    }
    // The last column, all zero, turns a pair into a single flip.
    let mut worst = 0.0f64;
    for a in 0..63 {
        for b in a + 1..64 {
            let differ: u32 = (0..KEYS / 64)
                .map(|i| (columns[a][i] ^ columns[b][i]).count_ones())
                .sum();
            let z = (f64::from(differ) - KEYS as f64 / 2.0) / (KEYS as f64 / 4.0).sqrt();
            worst = worst.max(z.abs());
        }
    }
    worst
}

/// A single odd multiplication after an addition: nested, but with few random bits.
fn weak(x: u32, key: u64) -> u32 {
    x.wrapping_add(key as u32)
        .wrapping_mul((key >> 32) as u32 | 1)
}

#[test]
fn any_two_flips_of_a_scrambling_are_independent() {
    // 2016 pairs and single flips, each a normal z: P(any |z| > 5.5) < 2016 · 3.8e-8,
    // so α = 8e-5. Mutant: addition alone.
    let worst = worst_pair(scrambled);
    assert!(worst < 5.5, "{worst}");
    assert!(worst_pair(|x, key| x.wrapping_add(key as u32)) > 5.5);
}

#[test]
fn the_first_seven_flips_are_jointly_uniform() {
    // χ² over the 2⁷ outcomes of the flips of the first three digits, α = 10⁻⁴; both for the
    // first three digits of a coordinate and for the last three of an index, of which all
    // before are the same. Mutants: a single multiplication, and constant multipliers.
    const KEYS: u64 = 1 << 16;
    let p_value = |scramble: &dyn Fn(u32, u64) -> u32, shift: u32| {
        let mut counts = [0u32; 128];
        for i in 0..KEYS {
            let key = mix64(GOLDEN.wrapping_mul(i + 1));
            let flips = flips(|x| scramble(x << shift, key) >> shift);
            let outcome = (0..7).fold(0, |sum, j| sum << 1 | usize::from(flips[j]));
            counts[outcome] += 1;
        }
        let expected = KEYS as f64 / 128.0;
        let statistic = counts
            .iter()
            .map(|&n| (f64::from(n) - expected).powi(2) / expected)
            .sum();
        ChiSquared::new(127.0).expect("positive").sf(statistic)
    };
    assert!(p_value(&scrambled, 0) > 1e-4);
    assert!(p_value(&scrambled, 26) > 1e-4);
    assert!(p_value(&weak, 0) < 1e-4);
    let constant = |x: u32, key: u64| {
        let x = weak(x, key);
        x ^ x.wrapping_mul(0x0552_6c56)
    };
    assert!(p_value(&constant, 0) < 1e-4);
}

#[test]
fn scrambling_is_nested() {
    // Changing digit j leaves all digits before j alone.
    for i in 0..1000u64 {
        let key = mix64(i);
        let x = mix64(!i) as u32;
        for j in 0..32 {
            let change = scrambled(x, key) ^ scrambled(x ^ (1 << j), key);
            assert_eq!(change.trailing_zeros(), j);
        }
    }
}

#[test]
fn fast_matrices_are_their_definitions() {
    // C(j, i) is odd exactly if i's bits are among j's (Lucas).
    for i in 0..2000u64 {
        let a = mix64(i) as u32;
        let mut expected = 0u32;
        for row in 0..32u32 {
            let parity = (0..32u32)
                .filter(|&j| row & !j == 0 && a >> j & 1 == 1)
                .count();
            expected |= (parity as u32 & 1) << row;
        }
        assert_eq!(
            pascal_of_odd_lanes(u32x8::splat(a)).to_array(),
            [a, expected, a, expected, a, expected, a, expected]
        );
    }
}

#[test]
fn the_matrix_over_gf4_is_its_definition() {
    let times = |x: u32, y: u32| -> u32 {
        // Polynomials modulo ω² + ω + 1.
        let product = ((x & 1) * y) ^ ((x >> 1) * (y << 1));
        if product & 4 == 0 {
            product
        } else {
            product ^ 7
        }
    };
    for i in 0..500u64 {
        let a = mix64(i) as u32;
        let mut expected = 0u32;
        for row in 0..16u32 {
            let mut sum = 0;
            for j in (row..16).filter(|j| row & !j == 0) {
                let power = [1, 2, 3][((j - row) % 3) as usize];
                sum ^= times(power, a >> (2 * j) & 3);
            }
            expected |= sum << (2 * row);
        }
        assert_eq!(
            pascal_gf4_of_upper_lanes(u32x8::splat(a)).to_array(),
            [a, a, expected, expected, a, a, expected, expected]
        );
    }
}

#[test]
fn lanes_do_not_mix() {
    for i in 0..1000u64 {
        let keys: [u64; 8] = core::array::from_fn(|lane| mix64(8 * i + lane as u64));
        let digits: [u32; 8] = keys.map(|key| mix64(!key) as u32);
        let lanes = nested_uniform_scramble(digits.into(), halves(keys));
        let single: [u32; 8] = core::array::from_fn(|lane| scrambled(digits[lane], keys[lane]));
        assert_eq!(lanes.to_array(), single);
        let reversed = reverse_bits(digits.into());
        assert_eq!(reversed.to_array(), digits.map(u32::reverse_bits));
        let floats = digits.map(crate::hash::random_float);
        assert_eq!(random_floats(digits.into()), floats);
    }
}
