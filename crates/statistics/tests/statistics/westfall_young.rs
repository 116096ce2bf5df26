//! The maximum test against enumeration, and its error rate under dependence.

use crate::checks::Random;
use etalon_statistics::sign_flip::{self, Side};
use etalon_statistics::{proportion, westfall_young};

#[track_caller]
fn near(actual: f64, expected: f64) {
    assert!(
        (actual / expected - 1.0).abs() <= 1e-13,
        "{actual:e} {expected:e}"
    );
}

#[test]
fn one_tile_is_the_sign_flip_test() {
    let sample = [-0.3, 0.5, 0.9, 1.4, -0.2, 0.7, 1.1, 0.4];
    let single = westfall_young::test(&sample, 1, 1, 0).expect("finite");
    let plain = sign_flip::test(&sample, Side::Both, 1, 0).expect("finite");
    near(single.overall.p_value, plain.p_value);
    near(single.overall.least, plain.least);
    assert!(single.overall.exact);
    // The same tile twice costs nothing: that is what dependence is worth.
    let twice: Vec<f64> = sample.iter().flat_map(|&x| [x, -2.0 * x]).collect();
    let double = westfall_young::test(&twice, 2, 1, 0).expect("finite");
    assert_eq!(double.adjusted, [plain.p_value; 2]);
}

/// Two tiles, three replicates, by hand. u = |Σx|/√Σx²: tile one (1, 1, 1): sums 3, 1, 1, 1 over √3;
/// tile two (1, −1, 2): the flips (+++), (−++), (+−+), (++−) give 2, 0, 4, −2 over √6. Maxima: 3/√3,
/// 1/√3, 4/√6, 2/√6, in ascending order 0.577, 0.816, 1.633, 1.732; observed 1.732 and 0.816.
#[test]
fn by_hand() {
    let tested = westfall_young::test(&[1.0, 1.0, 1.0, -1.0, 1.0, 2.0], 2, 1, 0).expect("finite");
    near(tested.adjusted[0], 0.25);
    near(tested.adjusted[1], 0.75);
    near(tested.overall.p_value, 0.25);

    let constant = westfall_young::test(&[0.0; 8], 2, 1, 0).expect("finite");
    assert_eq!(constant.overall.p_value, 1.0);
    assert_eq!(westfall_young::test(&[1.0, 2.0, 3.0], 2, 9, 0), None);
    assert_eq!(westfall_young::test(&[1.0, 2.0], 2, 9, 0), None);
    assert_eq!(westfall_young::test(&[1.0, f64::NAN], 1, 9, 0), None);
    assert_eq!(westfall_young::test(&[], 0, 9, 0), None);
}

/// Twenty tiles that share most of their error, with cubed normal (so heavy-tailed) noise; α = 0.05,
/// 1,000 runs of 10 (exact) and 200 of 24 replicates: alarms at α within an exact 99.9 % interval.
/// Mutant: a tenth of the tiles off by two standard deviations (8 / √15), found in nearly all of 50
/// runs.
#[test]
fn dependent_heavy_tails() {
    let mut random = Random(3);
    let mut image = |replicates: usize, shift: f64| -> Vec<f64> {
        let mut differences = Vec::new();
        for _ in 0..replicates {
            let common = random.normal();
            for tile in 0..20 {
                let z = 0.8 * common + 0.6 * random.normal();
                let bias = if tile < 2 { shift } else { 0.0 };
                differences.push(z * z * z * f64::from(1 + tile) + bias * f64::from(1 + tile));
            }
        }
        differences
    };
    let tested = |differences: &[f64]| {
        westfall_young::test(differences, 20, 999, 77)
            .expect("finite")
            .overall
    };
    for (replicates, runs) in [(10, 1000), (24, 200)] {
        let alarms = (0..runs)
            .filter(|_| tested(&image(replicates, 0.0)).p_value <= 0.05)
            .count();
        let share = proportion::interval(alarms as u64, runs, 0.999).expect("trials");
        assert!(share.contains(0.05), "{replicates}: {alarms} of {runs}");
    }
    let found = (0..50)
        .filter(|_| tested(&image(24, 8.0)).p_value <= 0.05)
        .count();
    assert!(found >= 45, "{found}");
}
