//! Exact moments: known values, merging, and a variance without cancellation.

use etalon_statistics::{Fixed128, InvalidValue, Moments, Summary, U256};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn moments(sample: &[f64]) -> Moments {
    let mut moments = Moments::ZERO;
    for &x in sample {
        moments.push_f64(x).expect("in range");
    }
    moments
}

#[test]
fn a_small_sample_by_hand() {
    let of = moments(&[2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]);
    assert_eq!(of.count(), 8);
    assert_eq!(of.mean(), 5.0);
    assert_eq!(of.variance(), Some(32.0 / 7.0));
    assert_eq!(of.standard_error(), Some((4.0_f64 / 7.0).sqrt()));
    assert_eq!(of.summary(), Summary::new(8, 5.0, 32.0 / 7.0));
}

#[test]
fn too_few_replicates_have_no_variance() {
    assert!(Moments::ZERO.mean().is_nan());
    assert_eq!(Moments::ZERO.variance(), None);
    let one = moments(&[3.0]);
    assert_eq!(
        (one.mean(), one.variance(), one.summary()),
        (3.0, None, None)
    );
}

/// Σx² − (Σx)²/n in double precision gives 0, or worse a negative number, here.
#[test]
fn a_great_mean_does_not_drown_the_variance() {
    let sample = [1e14, 1e14 + 1.0, 1e14 + 2.0];
    assert_eq!(moments(&sample).variance(), Some(1.0));
    let dark = [1e-8, 1e-8 + 2_f64.powi(-60), 1e-8 + 2_f64.powi(-59)];
    assert_eq!(moments(&dark).variance(), Some(2_f64.powi(-120)));
}

#[test]
fn what_does_not_fit_changes_nothing() {
    let mut of = moments(&[1.0, 2.0]);
    let before = of;
    assert_eq!(of.push_f64(f64::NAN), Err(InvalidValue::NotANumber));
    assert_eq!(of.push_f64(1e15), Err(InvalidValue::OutOfRange));
    assert_eq!(
        of.push(Fixed128::from_bits(i128::MIN)),
        Err(InvalidValue::OutOfRange)
    );
    assert_eq!(of, before);
}

#[test]
fn parts_that_cannot_be_are_refused() {
    let of = moments(&[1.0, 2.0, 4.0]);
    assert_eq!(
        Moments::from_parts(of.count(), of.sum(), of.squares()),
        Some(of)
    );
    assert_eq!(Moments::from_parts(3, of.sum(), U256::ZERO), None);
    assert_eq!(Moments::from_parts(0, of.sum(), of.squares()), None);
}

#[test]
fn wide_products_and_quotients() {
    // (2¹²⁸−1)² = 2²⁵⁶ − 2¹²⁹ + 1.
    assert_eq!(
        U256::from_product(u128::MAX, u128::MAX).to_words(),
        (u128::MAX - 1, 1)
    );
    assert_eq!(U256::from_words(u128::MAX, 0).checked_mul(2), None);
    assert_eq!(
        U256::from_words(u128::MAX, 1).checked_add(U256::from_words(0, u128::MAX)),
        None
    );
    assert_eq!(
        U256::from_words(0, 5).checked_sub(U256::from_words(0, 6)),
        None
    );
    assert_eq!(U256::from_words(1, 0).to_f64(), 2_f64.powi(128));
    // Half way between two doubles goes to the even one; anything beyond goes up.
    let half = 1_u128 << (127 - 53);
    assert_eq!(
        U256::from_words((1 << 127) | half, 0).to_f64(),
        2_f64.powi(255)
    );
    assert_eq!(
        U256::from_words((1 << 127) | half, 1).to_f64(),
        2_f64.powi(255) * (1.0 + f64::EPSILON)
    );
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 256,
        rng_seed: RngSeed::Fixed(0x00e7_a102),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn merging_is_exact(
        sample in prop::collection::vec(-1e6_f64..1e6, 2..60),
        cut in 0.0..1.0,
    ) {
        let whole = moments(&sample);
        let (left, right) = sample.split_at((cut * sample.len() as f64) as usize);
        let mut merged = moments(right);
        merged.merge(&moments(left)).expect("in range");
        prop_assert_eq!(merged, whole);

        // Two passes in double precision are good to some 1e-15 · n here.
        let summary = Summary::of(&sample).expect("at least two");
        let exact = whole.summary().expect("at least two");
        prop_assert!((summary.mean() - exact.mean()).abs() <= 1e-13 * 1e6);
        prop_assert!((summary.variance() / exact.variance() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn division_undoes_multiplication(a: u128, b in 1_u128..=1 << 64, rest: u64) {
        let rest = u128::from(rest) % b;
        let dividend = U256::from_product(a, b)
            .checked_add(U256::from_words(0, rest))
            .expect("a·b + rest < 2^193");
        prop_assert_eq!(dividend.divided_by(b), (U256::from_words(0, a), rest));
    }
}
