//! Lane i of a vector has the scalar's bits, for every operation and function.

use etalon_math::lane::agreement::{AWKWARD_NUMBERS, assert_agreement};
use etalon_math::lane::*;
use proptest::prelude::*;

/// A kernel from named inputs to a list of results.
macro_rules! kernel {
    ($name:ident: [$($input:ident),*] => [$($result:expr),* $(,)?]) => {
        struct $name;
        impl Kernel<{ [$(stringify!($input)),*].len() }, { [$(stringify!($result)),*].len() }> for $name {
            #[inline(always)]
            fn evaluate<F: Lane>(
                &self,
                [$($input),*]: [F; [$(stringify!($input)),*].len()],
            ) -> [F; [$(stringify!($result)),*].len()] {
                [$($result),*]
            }
        }
    };
}

/// One where the mask says yes.
fn flag<F: Lane>(mask: F::Mask) -> F {
    mask.select(F::ONE, F::ZERO)
}

/// The lower 16 bits as a number: comparable even where the bits encode NaN.
fn low<F: Lane>(int: F::Int) -> F {
    F::from_int(int & 0xffff)
}

/// The upper 16 bits as a number.
fn high<F: Lane>(int: F::Int) -> F {
    F::from_int(int >> 16)
}

kernel!(Arithmetic: [a, b, c] => [
    a + b, a - b, a * b, a / b, -a, a + 0.3, a - 0.3, a * 0.3, a / 0.3,
    a.mul_add(b, c), (-a).mul_add(b, c), a.mul_add(b, -c),
    a.sqrt(), a.safe_sqrt(), a.abs(), a.copysign(b), a.floor(), a.round_ties_even(),
    a.min(b), a.max(b), a.clamp(-0.5, 0.75), a.polynomial([0.1, -0.7, 3.0]),
    F::splat(0.7), F::from_fn(|_| 0.3), F::gather(&[1.5, 2.5, 3.5], a.to_bits() & 1),
]);
kernel!(Comparison: [a, b, c] => [
    flag(a.eq(b)), flag(a.lt(b)), flag(a.le(b)), flag(a.gt(b)), flag(a.ge(b)),
    flag(a.lt(b) & b.lt(c)), flag(a.lt(b) | b.lt(c)), flag(a.lt(b) ^ b.lt(c)), flag(!a.lt(b)),
    a.lt(b).select(b, c), branch!(a.lt(b), b, c), a.lt(b).select((b, a), (c, b)).1,
    a.lt(b).select([b, a], [c, b])[1], F::from_bits(a.lt(b).select(b.to_bits(), c.to_bits())),
    flag(F::Mask::splat(true)), flag(F::Mask::from_fn(|i| i > 64)),
]);
kernel!(Integers: [a, b] => [
    low(a.to_bits()), high(a.to_bits()), F::from_bits(a.to_bits()),
    low(a.to_int()), high(a.to_int()), F::from_int(a.to_bits()),
    low(a.to_bits().wrapping_add(b.to_bits())), high(a.to_bits().wrapping_add(b.to_bits())),
    low(a.to_bits().wrapping_sub(b.to_bits())), high(a.to_bits().wrapping_sub(b.to_bits())),
    low(a.to_bits().wrapping_mul(b.to_bits())), high(a.to_bits().wrapping_mul(b.to_bits())),
    low(a.to_bits() & b.to_bits()), high(a.to_bits() | b.to_bits()),
    low(a.to_bits() ^ b.to_bits()), high(!a.to_bits()),
    low(a.to_bits() & 0x5555), low(a.to_bits() | 0x5555), high(a.to_bits() ^ 0x0555_5555),
    high(a.to_bits() << 3), low(a.to_bits() >> 5), low(a.to_bits().shift_right_signed(20)),
    flag(a.to_bits().eq(b.to_bits())), flag(a.to_bits().lt(b.to_bits())),
    low(F::Int::splat(7)), low(F::Int::from_fn(|_| 9)),
]);
kernel!(Functions: [a, b] => [
    exp(a), ln(a), erf(a), pow(a, b), pow(a.abs(), b), atan(a), atan2(a, b), asin(a), acos(a),
    sin_cos(a).0, sin_cos(a).1, sin_cos_turns(a).0, sin_cos_turns(a).1,
]);

fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        any::<u32>().prop_map(f32::from_bits),
        proptest::sample::select(&AWKWARD_NUMBERS[..]),
        -2.0f32..2.0,
        -200.0f32..200.0,
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::with_cases(4000) })]
    #[test]
    fn every_width_gives_the_same_bits(
        a in proptest::collection::vec(number(), 19),
        b in proptest::collection::vec(number(), 19),
        c in proptest::collection::vec(number(), 19),
    ) {
        let [a, b, c] = [&a, &b, &c].map(Vec::as_slice);
        assert_agreement(&Arithmetic, [a, b, c]);
        assert_agreement(&Comparison, [a, b, c]);
        assert_agreement(&Integers, [a, b]);
        assert_agreement(&Functions, [a, b]);
    }
}

#[test]
fn all_pairs_of_awkward_numbers_agree() {
    let mut pairs = [vec![], vec![], vec![]];
    for a in AWKWARD_NUMBERS {
        for b in AWKWARD_NUMBERS {
            for (list, value) in pairs.iter_mut().zip([a, b, a]) {
                list.push(value);
            }
        }
    }
    let [a, b, c] = pairs.each_ref().map(Vec::as_slice);
    assert_agreement(&Arithmetic, [a, b, c]);
    assert_agreement(&Comparison, [a, b, c]);
    assert_agreement(&Integers, [a, b]);
    assert_agreement(&Functions, [a, b]);
}

/// What has one result for all lanes, and what moves between lanes and memory.
fn lanes_and_memory<F: Lane>() {
    let numbers: Vec<f32> = (0..F::WIDTH + 1).map(|i| i as f32 - 3.0).collect();
    let loaded = F::load(&numbers[1..]);
    let mut stored = vec![9.0; F::WIDTH + 1];
    loaded.store(&mut stored);
    assert_eq!(stored[..F::WIDTH], numbers[1..]);
    assert_eq!(stored[F::WIDTH], 9.0);

    let items = F::array(|i| numbers[i + 1]);
    assert_eq!(items.as_ref(), &numbers[1..]);

    let reversed = F::Int::from_fn(|i| (F::WIDTH - i) as u32);
    let gathered = F::gather(&numbers, reversed);
    let mut indices = vec![0; F::WIDTH];
    reversed.store(&mut indices);
    for i in 0..F::WIDTH {
        assert_eq!(loaded.lane(i), numbers[i + 1]);
        assert_eq!(gathered.lane(i), numbers[F::WIDTH - i]);
        assert_eq!(indices[i], reversed.lane(i));
        assert_eq!(F::Int::load(&indices).lane(i), reversed.lane(i));
        let only = F::Mask::from_fn(|j| j == i);
        assert_eq!(only.bits(), 1 << i);
        assert!(only.lane(i) && only.any());
        assert_eq!(only.all(), F::WIDTH == 1);
        assert_eq!((!only).any(), F::WIDTH > 1);
    }
    let (none, all) = (F::Mask::splat(false), F::Mask::splat(true));
    assert!(!none.any() && !none.all() && all.any() && all.all());
    assert_eq!([none.bits(), all.bits()], [0, u32::MAX >> (32 - F::WIDTH)]);
}

#[test]
fn lanes_are_in_the_order_of_memory() {
    lanes_and_memory::<f32>();
    lanes_and_memory::<F32x8>();
    lanes_and_memory::<F32x16>();
}
