//! What every sampler promises: a pure function of its address, uniform, and independent across
//! pixels, samples, replicates, seeds and dimensions.

use crate::evidence::{chi_square, uniform};
use etalon_sampling::{AnySampler, SampleId, Sampler, SamplerKind};
use glam::Vec2;

const KINDS: [SamplerKind; 4] = [
    SamplerKind::Independent,
    SamplerKind::Stratified { jitter: true },
    SamplerKind::Stratified { jitter: false },
    SamplerKind::Sobol,
];

const RANDOM_KINDS: [SamplerKind; 3] = [KINDS[0], KINDS[1], KINDS[3]];

fn address(i: u32) -> SampleId {
    SampleId {
        seed: 3,
        replicate: 1,
        pixel: (i % 100, i / 100),
        sample: i % 16,
        samples_per_replicate: 16,
        blocks: 1,
    }
}

#[test]
fn the_same_address_gives_the_same_numbers_whatever_is_skipped() {
    for kind in KINDS {
        for i in 0..50 {
            let mut all = kind.start(&address(i));
            let numbers: Vec<f32> = (0..40).map(|_| all.next_1d()).collect();
            assert_eq!(all.dimension(), 40);
            let mut jumping = kind.start(&address(i));
            // Ahead, back, and to where it is.
            for dimension in [31u32, 3, 3, 0, 39, 16] {
                jumping.skip_to(dimension);
                assert_eq!(jumping.dimension(), dimension);
                assert_eq!(jumping.next_1d(), numbers[dimension as usize], "{kind:?}");
            }
        }
    }
}

#[test]
fn pairs_begin_at_even_dimensions() {
    for kind in KINDS {
        let start = || kind.start(&address(7));
        let (mut plain, mut odd) = (start(), start());
        plain.skip_to(2);
        let pair = plain.next_2d();
        odd.next_2d();
        assert_eq!(odd.next_2d(), pair);
        let mut odd = start();
        odd.next_1d();
        assert_eq!(odd.next_2d(), pair, "{kind:?}");
        assert_eq!(odd.dimension(), 4);
    }
}

#[test]
fn values_are_stable() {
    // Pinned: images are promised to keep their bits, and these are what they are made of.
    let first = |kind: SamplerKind| -> [f32; 5] {
        let mut sampler = kind.start(&SampleId {
            seed: 42,
            replicate: 2,
            pixel: (17, 99),
            sample: 5,
            samples_per_replicate: 16,
            blocks: 1,
        });
        let single = sampler.next_1d();
        let pair = sampler.next_2d();
        sampler.skip_to(20);
        let far = sampler.next_2d();
        [single, pair.x, pair.y, far.x, far.y]
    };
    let values = KINDS.map(|kind| first(kind).map(|x| (x * (1u32 << 24) as f32) as u32));
    assert_eq!(
        values,
        [
            [8_429_094, 4_747_603, 581_781, 9_161_248, 2_358_036],
            [3_275_302, 15_563_076, 11_836_498, 10_450_116, 13_060_253],
            [3_670_016, 14_680_064, 10_485_760, 10_485_760, 14_680_064],
            [15_540_636, 10_215_132, 16_199_569, 483_668, 2_262_435],
        ]
    );
}

#[test]
fn counts_are_rounded_up_to_what_can_be_stratified() {
    let stratified = SamplerKind::Stratified { jitter: true };
    for (samples, square, power) in [
        (0, 1, 1),
        (1, 1, 1),
        (2, 4, 2),
        (3, 4, 4),
        (5, 9, 8),
        (16, 16, 16),
        (17, 25, 32),
        (1000, 1024, 1024),
    ] {
        assert_eq!(SamplerKind::Independent.round_up(samples), samples.max(1));
        assert_eq!(stratified.round_up(samples), square);
        assert_eq!(SamplerKind::Sobol.round_up(samples), power);
    }
    assert_eq!(stratified.round_up(u32::MAX), 65535 * 65535);
    assert_eq!(SamplerKind::Sobol.round_up(u32::MAX), 1 << 31);
}

#[test]
fn numbers_are_uniform_in_one_and_two_dimensions() {
    // One sample each of 60,000 pixels, α = 10⁻⁴ for each of 3 × 5 × 2 tests.
    for kind in RANDOM_KINDS {
        for dimension in [0, 2, 6, 7, 100] {
            let mut singles = vec![0.0; 64];
            let mut pairs = vec![0.0; 256];
            for i in 0..60_000 {
                let mut sampler = kind.start(&address(i));
                sampler.skip_to(dimension);
                let x = sampler.next_1d();
                assert!((0.0..1.0).contains(&x));
                singles[(x * 64.0) as usize] += 1.0;
                sampler.skip_to(dimension);
                let p = sampler.next_2d();
                assert!((0.0..1.0).contains(&p.x) && (0.0..1.0).contains(&p.y));
                pairs[(p.y * 16.0) as usize * 16 + (p.x * 16.0) as usize] += 1.0;
            }
            assert!(uniform(&singles) > 1e-4, "{kind:?} {dimension}");
            assert!(uniform(&pairs) > 1e-4, "{kind:?} {dimension}");
            // Mutant: 5 % more in the lower half.
            let skewed: Vec<f64> = (0..64)
                .map(|i| 60_000.0 / 64.0 * if i < 32 { 1.05 } else { 0.95 })
                .collect();
            assert!(chi_square(&singles, &skewed) < 1e-4);
        }
    }
}

#[test]
fn stratified_samples_fill_every_stratum_once() {
    for jitter in [true, false] {
        let kind = SamplerKind::Stratified { jitter };
        for count in [1u32, 4, 9, 25, 64] {
            let side = count.isqrt();
            for set in 0..2 {
                let mut cells = vec![0; count as usize];
                let mut strata = vec![0; count as usize];
                for i in 0..count {
                    let mut sampler = kind.start(&SampleId {
                        seed: 1,
                        replicate: 0,
                        pixel: (3, 4),
                        sample: set * count + i,
                        samples_per_replicate: count,
                        blocks: 1,
                    });
                    let p = sampler.next_2d() * side as f32;
                    cells[p.y as usize * side as usize + p.x as usize] += 1;
                    let x = sampler.next_1d() * count as f32;
                    strata[x as usize] += 1;
                    if !jitter {
                        assert!((p.fract() - 0.5).abs().max_element() < 1e-4);
                        assert!((x.fract() - 0.5).abs() < 1e-4);
                    }
                }
                assert!(cells.iter().chain(&strata).all(|&n| n == 1), "{count}");
            }
        }
    }
}

/// The coefficient of correlation of pairs of numbers, times √n: a standard normal z if they
/// are independent.
fn correlation(pairs: impl Iterator<Item = (f32, f32)>) -> f64 {
    let (mut n, mut sum) = (0.0f64, 0.0);
    for (a, b) in pairs {
        n += 1.0;
        sum += (f64::from(a) - 0.5) * (f64::from(b) - 0.5) * 12.0;
    }
    sum / n.sqrt()
}

fn at(kind: SamplerKind, address: SampleId, dimension: u32) -> f32 {
    let mut sampler = kind.start(&address);
    sampler.skip_to(dimension);
    sampler.next_1d()
}

type Change = (&'static str, fn(SampleId) -> SampleId);

#[test]
fn neighbouring_addresses_are_uncorrelated() {
    // 3 kinds × 3 dimensions × 7 changes, |z| > 5 each with probability 6·10⁻⁷: α = 4·10⁻⁵.
    let changes: [Change; 7] = [
        ("pixel to the right", |mut a| {
            a.pixel.0 += 1;
            a
        }),
        ("pixel below", |mut a| {
            a.pixel.1 += 1;
            a
        }),
        ("transposed pixel", |mut a| {
            a.pixel = (a.pixel.1 + 1000, a.pixel.0);
            a
        }),
        ("next replicate", |mut a| {
            a.replicate += 1;
            a
        }),
        ("next seed", |mut a| {
            a.seed += 1;
            a
        }),
        ("next seed, replicate before", |mut a| {
            a.seed += 1;
            a.replicate -= 1;
            a
        }),
        ("next set of strata", |mut a| {
            a.replicate += 256;
            a
        }),
    ];
    for kind in RANDOM_KINDS {
        for dimension in [0, 1, 10] {
            for (name, change) in changes {
                let z = correlation((0..40_000).map(|i| {
                    let a = address(i);
                    (at(kind, a, dimension), at(kind, change(a), dimension))
                }));
                assert!(z.abs() < 5.0, "{kind:?}, {name}: z = {z}");
            }
        }
    }
    // Mutant: a quarter of one pixel's number is its neighbour's.
    let z = correlation((0..40_000).map(|i| {
        let kind = SamplerKind::Independent;
        let (a, b) = (at(kind, address(i), 0), at(kind, address(i + 1), 0));
        (a, 0.25 * a + 0.75 * b)
    }));
    assert!(z > 5.0);
}

#[test]
fn dimensions_of_one_sample_are_uncorrelated() {
    // 3 kinds × 66 pairs of dimensions: α = 2 · 10⁻⁴ · 0.6.
    for kind in RANDOM_KINDS {
        let points: Vec<[f32; 12]> = (0..30_000)
            .map(|i| {
                let mut sampler = kind.start(&address(i));
                core::array::from_fn(|_| sampler.next_1d())
            })
            .collect();
        for a in 0..12 {
            for b in 0..a {
                let z = correlation(points.iter().map(|p| (p[a], p[b])));
                assert!(z.abs() < 5.0, "{kind:?}: dimensions {a} and {b}, z = {z}");
            }
        }
    }
}

#[test]
fn different_groups_of_a_stratified_sample_are_shuffled_independently() {
    // The stratum (of 16) in dimension 0 against that in dimensions 4, 8, 12, over many
    // pixels, for one sample index: a 16 × 16 table, α = 10⁻⁴ each.
    for kind in [SamplerKind::Stratified { jitter: true }, SamplerKind::Sobol] {
        for dimension in [4, 8, 12] {
            let mut table = vec![0.0; 256];
            for i in 0..40_000 {
                let mut address = address(i * 16);
                address.pixel = (i % 200, i / 200);
                let (a, b) = (at(kind, address, 0), at(kind, address, dimension));
                table[(a * 16.0) as usize * 16 + (b * 16.0) as usize] += 1.0;
            }
            assert!(uniform(&table) > 1e-4, "{kind:?} {dimension}");
        }
    }
}

#[test]
fn independent_numbers_do_not_repeat_across_pixels() {
    // 24-bit pairs: 20,000 of 2⁴⁸ repeat with probability 7·10⁻⁷.
    let mut seen: Vec<[u32; 2]> = (0..20_000)
        .map(|i| {
            let pair: Vec2 = AnySampler::next_2d(&mut SamplerKind::Independent.start(&address(i)));
            pair.to_array().map(f32::to_bits)
        })
        .collect();
    seen.sort_unstable();
    assert!(seen.windows(2).all(|two| two[0] != two[1]));
}
