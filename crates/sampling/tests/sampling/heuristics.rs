//! Weights of all techniques and lanes at one path sum to one.

use etalon_sampling::mis;
use glam::Vec4;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

fn densities() -> impl Strategy<Value = Vec4> {
    prop::array::uniform4(prop_oneof![Just(0.0f32), 1e-6f32..1e6]).prop_map(Vec4::from_array)
}

proptest! {
    #![proptest_config(Config {
        cases: 500,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..Config::default()
    })]

    #[test]
    fn weights_sum_to_one(a in densities(), b in densities()) {
        prop_assume!(a.element_sum() + b.element_sum() > 0.0);
        for heuristic in [mis::balance, mis::power] {
            // Technique t, chooser k: weight = p(t, k) · factor; Σ over t and k.
            let sum = a.element_sum() * heuristic(a, b) + b.element_sum() * heuristic(b, a);
            prop_assert!((sum - 1.0).abs() < 1e-5, "{sum}");
        }
        let (p, q) = (a.x, b.x);
        prop_assume!(p + q > 0.0);
        for weight in [mis::balance_weight, mis::power_weight] {
            prop_assert!((weight(p, q) + weight(q, p) - 1.0).abs() < 1e-6);
        }
    }
}

#[test]
fn extremes_neither_overflow_nor_divide_by_zero() {
    let (huge, none) = (Vec4::splat(1e30), Vec4::ZERO);
    assert!((mis::power(huge, huge) * 8e30 - 1.0).abs() < 1e-6);
    assert_eq!(mis::power(none, huge), 0.0);
    assert_eq!(mis::balance(none, none), 0.0);
    assert_eq!(mis::balance(Vec4::splat(f32::INFINITY), none), 0.0);
    assert_eq!(mis::power_weight(1e-30, 1e30), 0.0);
    assert_eq!(mis::balance_weight(0.0, 0.0), 0.0);
}
