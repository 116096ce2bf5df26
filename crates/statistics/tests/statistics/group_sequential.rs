//! Group-sequential boundaries against published tables and 22-digit quadrature, and against their
//! error rates.

// Reference values keep the digits they were computed to.
#![allow(clippy::excessive_precision)]

use crate::checks::{Random, near};
use etalon_statistics::boundaries::{Boundaries, LookError, stopping};
use etalon_statistics::{Estimate, Spending, Summary, normal, power, proportion, student_t};
use proptest::prelude::*;

/// The constant C with which |Zₖ| > C · shape(k/K) has probability α over K equal looks.
fn constant(looks: usize, alpha: f64, shape: fn(f64) -> f64) -> f64 {
    let information: Vec<f64> = (1..=looks).map(|k| k as f64 / looks as f64).collect();
    let (mut low, mut high) = (1.0, 5.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        let critical: Vec<f64> = information.iter().map(|&t| middle * shape(t)).collect();
        let total: f64 = stopping(&information, &critical, 0.0)
            .expect("increasing")
            .iter()
            .sum();
        if total > alpha {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Jennison & Turnbull (2000), tables 2.1 (Pocock) and 2.3 (O'Brien & Fleming), three decimals.
#[test]
fn published_constants() {
    for (looks, alpha, pocock, obrien_fleming) in [
        (1, 0.05, 1.960, 1.960),
        (2, 0.05, 2.178, 1.977),
        (3, 0.05, 2.289, 2.004),
        (4, 0.05, 2.361, 2.024),
        (5, 0.05, 2.413, 2.040),
        (10, 0.05, 2.555, 2.087),
        (2, 0.01, 2.772, 2.580),
        (3, 0.01, 2.873, 2.595),
        (4, 0.01, 2.939, 2.609),
        (5, 0.01, 2.986, 2.621),
    ] {
        let flat = constant(looks, alpha, |_| 1.0);
        let falling = constant(looks, alpha, |t| 1.0 / t.sqrt());
        assert!((flat - pocock).abs() <= 5.1e-4, "{looks} {flat}");
        assert!(
            (falling - obrien_fleming).abs() <= 5.1e-4,
            "{looks} {falling}"
        );
    }
}

fn criticals(alpha: f64, spending: Spending, looks: &[f64]) -> Vec<f64> {
    let mut boundaries = Boundaries::new(alpha, spending).expect("a level");
    looks
        .iter()
        .map(|&t| boundaries.look(t).expect("increasing").critical)
        .collect()
}

/// Five equal looks at two-sided 5 %: the values of Reboussin, DeMets, Kim & Lan (2000) are 4.8769,
/// 3.3569, 2.6803, 2.2898, 2.0310 and 2.4380, 2.4268, 2.4101, 2.3966, 2.3859, good to one or two of
/// their last digits; 15 digits from mpmath (the same recursion on other nodes, at 18 digits).
#[test]
fn spending_boundaries() {
    let five = [0.2, 0.4, 0.6, 0.8, 1.0];
    for (spending, published, computed) in [
        (
            Spending::OBrienFleming,
            [4.8769, 3.3569, 2.6803, 2.2898, 2.0310],
            [
                4.876_884_948_790_77,
                3.357_011_921_574_64,
                2.680_280_064_544_99,
                2.289_816_767_711_95,
                2.031_032_043_310_06,
            ],
        ),
        (
            Spending::Pocock,
            [2.4380, 2.4268, 2.4101, 2.3966, 2.3859],
            [
                2.437_976_688_050_01,
                2.426_813_858_150_11,
                2.410_193_840_271_32,
                2.396_645_400_648_73,
                2.385_984_571_622_55,
            ],
        ),
    ] {
        let actual = criticals(0.05, spending, &five);
        for ((actual, published), computed) in actual.iter().zip(published).zip(computed) {
            near(*actual, computed, 1e-11);
            assert!((actual - published).abs() <= 2e-4, "{actual} {published}");
        }
    }
    let (two, three) = ([0.5, 1.0], [0.25, 0.5, 1.0]);
    for (spending, alpha, looks, expected) in [
        (
            Spending::OBrienFleming,
            0.05,
            &two[..],
            &[2.962_588_042_727_566_8, 1.968_595_640_593_655_9][..],
        ),
        (
            Spending::Pocock,
            0.05,
            &two,
            &[2.156_999_218_344_682_1, 2.200_976_955_211_466_6],
        ),
        (
            Spending::OBrienFleming,
            1e-5,
            &three,
            &[
                9.054_228_275_819_897_6,
                6.349_793_812_951_959_5,
                4.417_175_284_410_115,
            ],
        ),
        (
            Spending::Pocock,
            1e-5,
            &three,
            &[
                4.634_747_156_309_307_3,
                4.687_326_949_829_568_9,
                4.613_493_799_360_589_8,
            ],
        ),
    ] {
        for (actual, expected) in criticals(alpha, spending, looks).iter().zip(expected) {
            near(*actual, *expected, 1e-10);
        }
    }
}

#[test]
fn looks_far_apart_or_close() {
    // A single look is the fixed test.
    near(
        criticals(0.05, Spending::OBrienFleming, &[1.0])[0],
        1.959_963_984_540_054_2,
        1e-12,
    );
    // Looks at nearly the same information: what was not stopped before hardly stops now, and the
    // spent level stays what it is.
    let looks: Vec<f64> = (0..6).map(|i| 0.5 + 0.002 * f64::from(i)).collect();
    let critical = criticals(0.05, Spending::Power(1.0), &looks);
    let total: f64 = stopping(&looks, &critical, 0.0)
        .expect("increasing")
        .iter()
        .sum();
    near(total, 0.05 * 0.51, 1e-9);
    assert!(Spending::Power(0.0).spent(0.05, 0.5) >= 0.0);
    assert!(!Spending::Power(0.0).is_valid());
    assert!(Boundaries::new(0.05, Spending::Power(f64::NAN)).is_none());
    assert!(Boundaries::new(0.0, Spending::Pocock).is_none());
    assert_eq!(stopping(&[0.5, 0.5], &[2.0, 2.0], 0.0), None);
    assert_eq!(stopping(&[0.5], &[2.0, 2.0], 0.0), None);
    assert_eq!(stopping(&[0.5], &[f64::NAN], 0.0), None);
    assert_eq!(stopping(&[], &[], 0.0), None);
}

#[test]
fn looks_without_new_information_are_refused() {
    let mut boundaries = Boundaries::new(0.01, Spending::OBrienFleming).expect("a level");
    let first = boundaries.look(0.25).expect("the first look");
    for information in [0.25, 0.1, 1.5, f64::NAN] {
        assert!(matches!(
            boundaries.look(information),
            Err(LookError::BadInformation { previous: 0.25, .. })
        ));
    }
    assert_eq!(boundaries.looks(), [first]);
    assert_eq!(boundaries.look(1.0).expect("the last look").spent, 0.01);
}

/// Under a drift the first look is a plain normal test, and the total power exceeds that of the
/// last look alone. Jennison & Turnbull (2000), table 2.7: O'Brien & Fleming's test with K = 5,
/// α = 0.05 and power 0.9 needs 1.026 times the fixed sample size.
#[test]
fn power_under_drift() {
    let look = stopping(&[0.7], &[2.5], 3.0).expect("increasing")[0];
    let mean = 3.0 * 0.7_f64.sqrt();
    near(look, normal::sf(2.5 - mean) + normal::sf(2.5 + mean), 1e-12);

    let information: Vec<f64> = (1..=5).map(|k| f64::from(k) / 5.0).collect();
    let c = constant(5, 0.05, |t| 1.0 / t.sqrt());
    let critical: Vec<f64> = information.iter().map(|t| c / t.sqrt()).collect();
    let fixed = power::detectable(f64::INFINITY, 0.05, 0.9);
    let total: f64 = stopping(&information, &critical, fixed * 1.026_f64.sqrt())
        .expect("increasing")
        .iter()
        .sum();
    assert!((total - 0.9).abs() < 3e-4, "{total}");
}

/// Claims of a zero bias with four looks at 8 … 32 replicates, at α = 0.05: the share of 20,000
/// runs in which *any* look's interval misses the truth. Four million runs elsewhere gave 0.0512
/// for O'Brien & Fleming's and 0.0523 for Pocock's. Mutant:
/// a fixed test at each look, which reuses α, alarms in 13 %.
#[test]
fn alpha_is_not_exceeded() {
    const RUNS: u64 = 20_000;
    let sizes = [8_usize, 16, 24, 32];
    let information = sizes.map(|n| n as f64 / 32.0);
    let nominal = |spending| -> Vec<f64> {
        let mut boundaries = Boundaries::new(0.05, spending).expect("valid");
        let look = |t: &f64| boundaries.look(*t).expect("a look").nominal;
        information.iter().map(look).collect()
    };
    let plans = [
        nominal(Spending::OBrienFleming),
        nominal(Spending::Pocock),
        vec![0.05; 4],
    ];
    let limits: Vec<Vec<f64>> = plans
        .iter()
        .map(|levels| {
            levels
                .iter()
                .zip(sizes)
                .map(|(&level, n)| student_t::upper_quantile(0.5 * level, n as f64 - 1.0))
                .collect()
        })
        .collect();
    let mut random = Random(11);
    let mut alarms = [0_u64; 3];
    for _ in 0..RUNS {
        let sample: Vec<f64> = (0..32).map(|_| random.normal()).collect();
        let t = sizes.map(|n| {
            let estimate = Estimate::mean(&Summary::of(&sample[..n]).expect("finite"));
            (estimate.value() / estimate.standard_error()).abs()
        });
        for (alarm, limit) in alarms.iter_mut().zip(&limits) {
            *alarm += u64::from(t.iter().zip(limit).any(|(t, limit)| t > limit));
        }
    }
    let share = |plan: usize| proportion::interval(alarms[plan], RUNS, 0.999).expect("trials");
    assert!(share(0).contains(0.0512), "{alarms:?}");
    assert!(share(1).contains(0.0523), "{alarms:?}");
    assert!(share(2).low > 0.1, "{alarms:?}");
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 24,
        rng_seed: proptest::test_runner::RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Whatever the looks, exactly α(t) is spent by each, and no more than α by the last.
    #[test]
    fn exactly_alpha_is_spent(
        steps in prop::collection::vec(0.05..1.0_f64, 1..6),
        alpha in 1e-7..0.2_f64,
        kind in 0..3_u8,
    ) {
        let total: f64 = steps.iter().sum();
        let mut looks: Vec<f64> = steps
            .iter()
            .scan(0.0, |sum, step| {
                *sum += step;
                Some(*sum / total)
            })
            .collect();
        *looks.last_mut().expect("at least one") = 1.0;
        let spending = match kind {
            0 => Spending::OBrienFleming,
            1 => Spending::Pocock,
            _ => Spending::Power(2.0),
        };
        let critical = criticals(alpha, spending, &looks);
        let stopped = stopping(&looks, &critical, 0.0).expect("increasing");
        let mut sum = 0.0;
        for (probability, &t) in stopped.iter().zip(&looks) {
            sum += probability;
            prop_assert!((sum / spending.spent(alpha, t) - 1.0).abs() < 1e-7);
        }
        prop_assert!((sum / alpha - 1.0).abs() < 1e-9);
    }
}
