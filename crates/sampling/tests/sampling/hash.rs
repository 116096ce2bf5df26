//! Permutations are permutations, and as random as shuffling asks; floats stay below one.

use crate::evidence::uniform;
use etalon_math::float::ONE_MINUS_EPSILON;
use etalon_sampling::hash::{mix64, permute, random_float};

#[test]
fn floats_cover_the_interval_and_stay_below_one() {
    assert_eq!(random_float(0), 0.0);
    assert_eq!(random_float(u32::MAX), ONE_MINUS_EPSILON);
    assert_eq!(random_float(1 << 31), 0.5);
}

#[test]
fn permutations_are_bijections() {
    for count in (1..70).chain([100, 255, 256, 257, 1000]) {
        for key in 0..20 {
            let mut seen = vec![false; count as usize];
            for i in 0..count {
                let to = permute(i, count, mix64(key)) as usize;
                assert!(!core::mem::replace(&mut seen[to], true), "{count}, {key}");
            }
        }
    }
}

#[test]
fn permutations_take_every_two_places_to_every_two_places() {
    // For each pair of indices, the table of where both go, over keys; χ² over the n(n − 1)
    // outcomes with α = 10⁻⁴ / (pairs). The mutant, a rotation, has n of them.
    for count in [2u32, 3, 4, 5, 8, 9, 16] {
        let n = count as usize;
        let keys = 4000 * n as u64;
        for (i, j) in [(0, 1), (0, count - 1), (count / 2, count - 1)] {
            if i == j {
                continue;
            }
            let p_value = |place: &dyn Fn(u32, u64) -> u32| {
                let mut table = vec![0.0; n * n];
                for key in 0..keys {
                    let key = mix64(key);
                    table[place(i, key) as usize * n + place(j, key) as usize] += 1.0;
                }
                let apart: Vec<f64> = (0..n * n)
                    .filter(|cell| cell / n != cell % n)
                    .map(|cell| table[cell])
                    .collect();
                uniform(&apart)
            };
            let p = p_value(&|index, key| permute(index, count, key));
            assert!(p > 1e-5, "{count}: {i} and {j}, p = {p}");
            if count > 2 {
                let rotation = |index: u32, key: u64| (index + (key >> 40) as u32) % count;
                assert!(p_value(&rotation) < 1e-5);
            }
        }
    }
}
