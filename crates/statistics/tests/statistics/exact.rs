//! The exact accumulators against independent arithmetic, in any order and from many threads.

use etalon_statistics::{AtomicFixed128, Faults, Fixed128, InvalidValue};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(0x00e7_a101),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// The fixed-point integer of `x` by floating-point arithmetic alone: `trunc`, the difference
/// and the product are exact, so only the last step rounds.
fn oracle(x: f64) -> i128 {
    let whole = x.trunc();
    let fraction = (x - whole) * 18_446_744_073_709_551_616.0;
    ((whole as i128) << 64) + fraction.round_ties_even() as i128
}

/// Every `f32` the accumulator accepts, all magnitudes alike.
fn acceptable() -> impl Strategy<Value = f32> {
    any::<u32>()
        .prop_map(f32::from_bits)
        .prop_filter("in range", |x| x.abs() < 2_f32.powi(48))
}

/// A pseudo-random permutation.
fn shuffled<T: Clone>(terms: &[T], seed: u64) -> Vec<T> {
    let mut terms = terms.to_vec();
    let mut state = seed;
    for i in (1..terms.len()).rev() {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        terms.swap(i, (state >> 33) as usize % (i + 1));
    }
    terms
}

fn sum(terms: &[f32]) -> Fixed128 {
    let mut sum = Fixed128::ZERO;
    for &x in terms {
        sum.add(x).expect("terms are in range");
    }
    sum
}

proptest! {
    #![proptest_config(config(4096))]

    #[test]
    fn single_precision_is_rounded_once(bits: u32) {
        let x = f32::from_bits(bits);
        let expected = if x.is_nan() {
            Err(InvalidValue::NotANumber)
        } else if x.is_infinite() {
            Err(InvalidValue::Infinite)
        } else if f64::from(x.abs()) >= 2_f64.powi(48) {
            Err(InvalidValue::OutOfRange)
        } else {
            Ok(oracle(f64::from(x)))
        };
        prop_assert_eq!(Fixed128::from_f32(x).map(Fixed128::to_bits), expected);
    }

    #[test]
    fn double_precision_is_rounded_once(mantissa: u64, exponent in -80..50, negative: bool) {
        let x = (mantissa >> 11) as f64 * 2_f64.powi(exponent - 52);
        let x = if negative { -x } else { x };
        let expected = if x.abs() >= 2_f64.powi(48) {
            Err(InvalidValue::OutOfRange)
        } else {
            Ok(oracle(x))
        };
        prop_assert_eq!(Fixed128::from_f64(x).map(Fixed128::to_bits), expected);
    }

    #[test]
    fn means_are_correctly_rounded(sum in -1_i128 << 100 .. 1 << 100, count in 1_u64..1 << 52) {
        // With q the returned double, |q·count − sum| must not shrink for q's neighbours. In
        // units of 2⁻⁶⁴ a double is m·2^e; compare |m·2^e·count − sum| for e < 0 after scaling.
        let mean = Fixed128::from_bits(sum).mean(count);
        let error = |q: f64| {
            let bits = q.abs().to_bits();
            let mantissa = i128::from((bits & ((1 << 52) - 1)) | (1 << 52));
            let exponent = (bits >> 52) as i32 - 1075 + 64;
            // Scale both sides so that the smaller exponent becomes 0; high words first.
            let product = mantissa * i128::from(count);
            let target = sum.abs();
            if exponent >= 0 {
                // product·2^e against target: both below 2¹²⁷ for these inputs.
                (product << exponent).abs_diff(target)
            } else {
                let shift = -exponent as u32;
                let (whole, part) = if shift < 127 {
                    (product >> shift, product & ((1_i128 << shift) - 1))
                } else {
                    (0, product)
                };
                // The distance in units of 2^−shift, saturated: only its order matters.
                let difference = target - whole;
                difference
                    .checked_mul(1_i128.checked_shl(shift).unwrap_or(i128::MAX))
                    .map_or(u128::MAX, |scaled| scaled.abs_diff(part))
            }
        };
        if sum != 0 {
            let neighbour = |step: i64| f64::from_bits((mean.abs().to_bits() as i64 + step) as u64);
            prop_assert!(error(mean) <= error(neighbour(1)));
            prop_assert!(error(mean) <= error(neighbour(-1)));
            prop_assert_eq!(mean < 0.0, sum < 0);
        }
    }

    #[test]
    fn fixed_means_are_nearest(sum in -1_i128 << 120 .. 1 << 120, count in 1_u64..1 << 40) {
        let mean = Fixed128::from_bits(sum).mean_fixed(count).to_bits();
        let twice = 2 * (sum - mean * i128::from(count)).abs();
        prop_assert!(twice <= i128::from(count));
        prop_assert!(twice < i128::from(count) || mean % 2 == 0);
    }
}

proptest! {
    #![proptest_config(config(256))]

    #[test]
    fn sums_do_not_depend_on_order_or_grouping(
        terms in prop::collection::vec(acceptable(), 0..200),
        seed: u64,
        cut in 0.0..1.0,
    ) {
        let exact: i128 = terms.iter().map(|&x| oracle(f64::from(x))).sum();
        let in_order = sum(&terms);
        prop_assert_eq!(in_order.to_bits(), exact);
        prop_assert_eq!(sum(&shuffled(&terms, seed)), in_order);

        let (left, right) = terms.split_at((cut * terms.len() as f64) as usize);
        let mut merged = sum(right);
        merged.merge(sum(left)).expect("in range");
        prop_assert_eq!(merged, in_order);
    }

    #[test]
    fn atomic_sums_are_the_same(terms in prop::collection::vec(acceptable(), 0..200)) {
        let atomic = AtomicFixed128::new();
        for &x in &terms {
            atomic.add(x).expect("in range");
        }
        prop_assert_eq!(atomic.into_fixed(), sum(&terms));
        // By a single writer as well; refused: a carry that is lost.
        let alone = AtomicFixed128::new();
        for &x in &terms {
            let term = Fixed128::from_f32(x).expect("in range");
            alone.merge_alone(term).expect("in range");
        }
        prop_assert_eq!(alone.into_fixed(), sum(&terms));
    }
}

#[test]
fn what_does_not_fit_is_refused_and_counted() {
    let mut faults = Faults::NONE;
    let mut total = sum(&[1.5, -0.25]);
    for x in [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        2_f32.powi(48),
        -2_f32.powi(48),
        f32::MAX,
    ] {
        assert!(!faults.note(total.add(x)));
    }
    assert!(faults.note(total.add(0.0)));
    assert_eq!(total.to_f64(), 1.25);
    assert_eq!((faults.nan, faults.infinite, faults.overflow), (1, 2, 3));

    // The greatest sum takes nothing more, and is not changed by the attempt.
    let mut full = Fixed128::from_bits(i128::MAX);
    assert_eq!(full.add(2_f32.powi(-64)), Err(InvalidValue::OutOfRange));
    assert_eq!(full, Fixed128::from_bits(i128::MAX));
    let mut empty = Fixed128::from_bits(i128::MIN);
    assert_eq!(empty.add(-1.0), Err(InvalidValue::OutOfRange));
    assert_eq!(empty.to_f64(), -(2_f64.powi(63)));
}

#[test]
fn as_many_terms_as_promised_fit() {
    let greatest = f32::from_bits(2_f32.powi(48).to_bits() - 1);
    let mut total = Fixed128::ZERO;
    for _ in 0..1 << 15 {
        total.add(greatest).expect("2^15 of the greatest terms fit");
    }
    assert_eq!(total.to_f64(), f64::from(greatest) * 32768.0);
}

/// Mutant: an accumulator that loses one carry in a million is caught, since every addition
/// here carries and the sum is compared bit by bit.
#[test]
fn threads_lose_no_carry() {
    const THREADS: u64 = 8;
    const TERMS: u64 = 100_000;
    // Each term's low word is near 2⁶⁴ or its high word negative, so nearly all of them carry.
    let term = |thread: u64, i: u64| {
        let low = u64::MAX - (thread * TERMS + i) * 7919;
        let high = if (thread + i).is_multiple_of(2) {
            3
        } else {
            -4
        };
        Fixed128::from_bits((i128::from(high) << 64) | i128::from(low))
    };
    let atomic = AtomicFixed128::new();
    std::thread::scope(|scope| {
        for thread in 0..THREADS {
            let atomic = &atomic;
            scope.spawn(move || {
                for i in 0..TERMS {
                    atomic.merge(term(thread, i)).expect("in range");
                }
            });
        }
    });
    let exact: i128 = (0..THREADS)
        .flat_map(|thread| (0..TERMS).map(move |i| term(thread, i).to_bits()))
        .sum();
    assert_eq!(atomic.into_fixed().to_bits(), exact);
}

#[test]
fn the_atomic_sum_reports_before_it_could_wrap() {
    let mut sum = AtomicFixed128::from_fixed(Fixed128::from_bits((1 << 126) - 1));
    assert_eq!(sum.add(f32::NAN), Err(InvalidValue::NotANumber));
    assert_eq!(sum.add(f32::INFINITY), Err(InvalidValue::Infinite));
    assert_eq!(sum.load().to_bits(), (1 << 126) - 1);
    assert_eq!(sum.add(2_f32.powi(-64)), Err(InvalidValue::OutOfRange));
    assert_eq!(sum.load().to_bits(), 1 << 126);
    assert_eq!(
        sum.merge(Fixed128::from_bits(i128::MAX)),
        Err(InvalidValue::OutOfRange)
    );
    assert_eq!(sum.take().to_bits(), 1 << 126);
    assert_eq!(sum.into_fixed(), Fixed128::ZERO);
}
