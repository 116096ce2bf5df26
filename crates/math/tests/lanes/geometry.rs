//! Vectors, spectra and frames in lanes have the bits of `glam`'s and of [`etalon_math::Frame`].

use etalon_math::lane::{F32x8, F32x16, Lane, LaneFrame, Mask, Select, Spectral, Vector};
use etalon_math::offset::offset_origins;
use etalon_math::{Frame, FromAffine, Transform, offset_origin};
use glam::{DAffine3, DMat3, Vec3, Vec4};
use proptest::prelude::*;

fn number() -> impl Strategy<Value = f32> {
    prop_oneof![-2.0_f32..2.0, -1e-6_f32..1e-6, -1e6_f32..1e6, Just(0.0)]
}

fn vectors() -> impl Strategy<Value = Vec<Vec3>> {
    proptest::collection::vec((number(), number(), number()).prop_map(Vec3::from), 32)
}

fn spectra() -> impl Strategy<Value = Vec<Vec4>> {
    let spectrum = (number(), number(), number(), number()).prop_map(Vec4::from);
    proptest::collection::vec(spectrum, 32)
}

/// Lane i of what is computed together is what is computed from lane i.
fn vectors_agree<F: Lane>(v: &[Vec3], s: &[Vec4]) {
    let [a, b] = [0, F::WIDTH].map(|from| F::Vector::of_lanes(|i| v[from + i]));
    let [p, q] = [0, F::WIDTH].map(|from| F::Spectrum::of_lanes(|i| s[from + i]));
    let frames: Vec<_> = (v.iter())
        .map(|v| Frame::from_normal(v.normalize_or(Vec3::Z)))
        .collect();
    let frame = LaneFrame::<F>::of_lanes(|i| &frames[i]);
    let pairs = F::Spectrum::pairs([p, q]);
    let both = F::Vector::pairs_of_lanes(|i| [v[i], v[F::WIDTH + i]]);
    let map = Transform::from_affine(&DAffine3::from_mat3(DMat3::from_cols_array(&[
        0.3, 0.5, -1.0, 2.0, 0.1, 0.7, -0.2, 0.9, 1.3,
    ])));
    let mapped = map.vectors::<F>(a);
    let moved = offset_origins::<F>(a, b.magnitudes(), frame.n, b);
    for i in 0..F::WIDTH {
        let (x, y) = (v[i], v[F::WIDTH + i]);
        let vector = |lanes: F::Vector, alone: Vec3| {
            let bits = |v: Vec3| v.to_array().map(f32::to_bits);
            let lane = lanes.at_lane(i);
            assert!(
                bits(lane) == bits(alone) || lane.is_nan() && alone.is_nan(),
                "{lane} {alone}"
            );
        };
        let value = |lanes: F, alone: f32| {
            let lane = lanes.lane(i);
            assert!(
                lane.to_bits() == alone.to_bits() || lane.is_nan() && alone.is_nan(),
                "{lane} {alone}"
            );
        };
        vector(a + b, x + y);
        vector(a - b, x - y);
        vector(both[0], x);
        vector(both[1], y);
        vector(mapped, map.vector(x));
        vector(-a, -x);
        vector(a * b.z(), x * y.z);
        vector(a.over(b.norm()), x / y.length());
        vector(a.normalized(), x * (1.0 / x.length()));
        vector(a.magnitudes(), x.abs());
        value(a.dot_product(b), x.dot(y));
        value(a.norm(), x.length());
        assert_eq!(a.is_zero().lane(i), x == Vec3::ZERO);
        vector(
            F::Vector::choose(a.z().lt(b.z()), a, b),
            if x.z < y.z { x } else { y },
        );
        vector(a.z().lt(b.z()).select(a, b), if x.z < y.z { x } else { y });
        let alone = Frame::from_normal(x.normalize_or(Vec3::Z));
        vector(frame.to_local(b), alone.to_local(y));
        vector(frame.to_world(b), alone.to_world(y));
        vector(moved, offset_origin(x, y.abs(), alone.n, y));

        let (x, y) = (s[i], s[F::WIDTH + i]);
        let spectrum = |lanes: F::Spectrum, alone: Vec4| {
            let same = lanes
                .at_lane(i)
                .to_array()
                .into_iter()
                .zip(alone.to_array());
            for (a, b) in same {
                assert!(
                    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan(),
                    "{a} {b}"
                );
            }
        };
        assert_eq!(pairs(i), [x, y]);
        spectrum(
            p.where_negative(q, p),
            Vec4::select(x.cmplt(Vec4::ZERO), y, x),
        );
        spectrum(p + q, x + y);
        spectrum(p - q, x - y);
        spectrum(p * q, x * y);
        spectrum(p / q, x / y);
        spectrum(p * q.hero(), x * y.x);
        spectrum(p / q.hero(), x / y.x);
        spectrum(p + q.hero(), x + y.x);
        spectrum(p - q.hero(), x - y.x);
        spectrum(p.magnitudes(), x.abs());
        spectrum(p.square_roots(), x.sqrt());
        let each = |f: fn(f32) -> f32| Vec4::from_array(x.to_array().map(f));
        spectrum(
            p.at_least(F::splat(0.1)),
            each(|x| if x < 0.1 { 0.1 } else { x }),
        );
        spectrum(
            p.below(F::splat(0.1)),
            each(|x| if x < 0.1 { x } else { 0.1 }),
        );
        assert_eq!(p.is_uniform().lane(i), x == Vec4::splat(x.x));
        let uniform = F::Spectrum::uniform(p.hero()).is_uniform().lane(i);
        assert_eq!(uniform, !x.x.is_nan());
        let less = p.hero().lt(q.hero());
        spectrum(less.select(p, q), if x.x < y.x { x } else { y });
        value(p.sum(), x.element_sum());
        value(p.greatest() + 0.0, x.max_element() + 0.0);
        assert_eq!(p.is_zero().lane(i), x == Vec4::ZERO);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::with_cases(256) })]
    #[test]
    fn lanes_are_what_glam_computes(v in vectors(), s in spectra()) {
        vectors_agree::<f32>(&v, &s);
        vectors_agree::<F32x8>(&v, &s);
        vectors_agree::<F32x16>(&v, &s);
    }
}

/// Numbers that tell lane and column.
#[test]
fn rows_become_columns_and_rows_again() {
    fn check<F: Lane>() {
        let row = |i: usize| core::array::from_fn(|k| (10 * i + k) as f32);
        let columns = F::columns(row);
        for (k, column) in columns.iter().enumerate() {
            for i in 0..F::WIDTH {
                assert_eq!(column.lane(i), (10 * i + k) as f32);
            }
        }
        for (i, numbers) in F::rows(columns).as_ref().iter().enumerate() {
            assert_eq!(*numbers, row(i));
        }
    }
    check::<f32>();
    check::<F32x8>();
    check::<F32x16>();
}
