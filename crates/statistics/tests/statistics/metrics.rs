//! Image metrics against sums by hand.

use etalon_statistics::metrics::{mse, rel_mse, smape};
use etalon_statistics::{Picture, PictureError};
use proptest::prelude::*;

#[track_caller]
fn near(actual: f64, expected: f64) {
    assert!((actual / expected - 1.0).abs() <= 1e-14, "{actual:e}");
}

/// Two pixels; differences 1, 0, ½ and 0, −1, 2, all exact in binary.
const TEST: [f32; 6] = [2.0, 0.5, 1.0, 0.0, 3.0, 4.0];
const REFERENCE: [f32; 6] = [1.0, 0.5, 0.5, 0.0, 4.0, 2.0];

#[test]
fn by_hand() {
    let test = Picture::new(&TEST, 2, 1).expect("well-formed");
    let reference = Picture::new(&REFERENCE, 2, 1).expect("well-formed");
    near(
        mse(&test, &reference).expect("same size"),
        (1.0 + 0.25 + 1.0 + 4.0) / 6.0,
    );
    // ε = ¼: 1/1.25, 0.25/0.5; 1/16.25, 4/4.25.
    let (first, second) = (0.8 + 0.5, 1.0 / 16.25 + 4.0 / 4.25);
    near(
        rel_mse(&test, &reference, 0.25).expect("same size"),
        (first + second) / 6.0,
    );
    near(
        smape(&test, &reference, 1.0).expect("same size"),
        (1.0 / 4.0 + 0.5 / 2.5 + 1.0 / 8.0 + 2.0 / 7.0) / 6.0,
    );
}

#[test]
fn refusals() {
    let test = Picture::new(&TEST, 2, 1).expect("well-formed");
    let other = Picture::new(&REFERENCE, 1, 2).expect("well-formed");
    assert_eq!(
        mse(&test, &other),
        Err(PictureError::DifferentSizes {
            test: (2, 1),
            reference: (1, 2)
        })
    );
    assert!(rel_mse(&test, &test, 0.0).is_err());
    assert!(smape(&test, &test, f64::NAN).is_err());
    assert!(matches!(
        Picture::new(&TEST, 2, 2),
        Err(PictureError::BadShape { .. })
    ));
    assert!(Picture::new(&[], 0, 0).is_err());
    assert!(Picture::new(&TEST, usize::MAX, 2).is_err());
    let mut broken = TEST;
    broken[4] = f32::NAN;
    assert_eq!(
        Picture::new(&broken, 2, 1),
        Err(PictureError::NotFinite {
            x: 1,
            y: 0,
            channel: 1
        })
    );
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 64,
        rng_seed: proptest::test_runner::RngSeed::Fixed(3),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Zero for equal images; symmetric where the definition is.
    #[test]
    fn properties(values in prop::collection::vec((-10.0..10.0_f32, -10.0..10.0_f32), 30)) {
        let (a, b): (Vec<f32>, Vec<f32>) = values.into_iter().unzip();
        let a = Picture::new(&a, 5, 2).expect("well-formed");
        let b = Picture::new(&b, 5, 2).expect("well-formed");
        prop_assert_eq!(mse(&a, &a), Ok(0.0));
        prop_assert_eq!(mse(&a, &b), mse(&b, &a));
        prop_assert_eq!(smape(&a, &b, 0.01), smape(&b, &a, 0.01));
        prop_assert!(smape(&a, &b, 0.01).expect("same size") <= 1.0);
    }
}
