//! Replicates as blocks of one sequence: each is what an independent replicate is, and together they
//! are one replicate of as many samples.

use etalon_sampling::{ReplicateKind, SampleId, Sampler, SamplerKind};
use glam::Vec2;

const BLOCKS: [u32; 6] = [1, 2, 3, 4, 7, 8];

/// Where sample `sample` of `each` of block `block` of `blocks` is drawn from.
fn address(block: u32, sample: u32, each: u32, blocks: u32) -> SampleId {
    let within = SampleId {
        seed: 9,
        replicate: block,
        pixel: (5, 8),
        sample,
        samples_per_replicate: each,
        blocks: 1,
    };
    ReplicateKind::Blocks.address(within, blocks)
}

/// The pair at `dimension`, and the number after it.
fn numbers(kind: SamplerKind, address: &SampleId, dimension: u32) -> (Vec2, f32) {
    let mut sampler = kind.start(address);
    sampler.skip_to(dimension);
    (sampler.next_2d(), sampler.next_1d())
}

/// Whether points of [0, 1)² fill each cell of a grid once.
fn fill(points: impl Iterator<Item = Vec2>, [columns, rows]: [u32; 2]) -> bool {
    let mut cells = vec![0; (columns * rows) as usize];
    for point in points {
        let cell = (point * Vec2::new(columns as f32, rows as f32)).as_uvec2();
        cells[(cell.y * columns + cell.x) as usize] += 1;
    }
    cells.iter().all(|&n| n == 1)
}

#[test]
fn blocks_of_sobol_are_one_sequence() {
    for (blocks, each) in [(8, 4), (4, 1), (3, 8), (5, 3)] {
        for index in 0..blocks * each {
            let alone = address(0, index, blocks * each, 1);
            let dealt = address(index / each, index % each, each, blocks);
            let [alone, dealt] = [alone, dealt].map(|at| numbers(SamplerKind::Sobol, &at, 8));
            assert_eq!(alone, dealt);
        }
    }
}

#[test]
fn each_block_of_sobol_is_a_net() {
    // Mutant: blocks that begin one sample late.
    let filled = |blocks: u32, late: u32, grid: [u32; 2]| {
        (0..blocks).all(|block| {
            let point = |i| numbers(SamplerKind::Sobol, &address(block, i + late, 16, blocks), 8).0;
            fill((0..16).map(point), grid)
        })
    };
    for grid in [[16, 1], [8, 2], [4, 4], [2, 8], [1, 16]] {
        assert!(BLOCKS.iter().all(|&blocks| filled(blocks, 0, grid)));
    }
    assert!(!filled(8, 1, [4, 4]));
}

#[test]
fn blocks_of_strata_fill_finer_strata_together() {
    for jitter in [true, false] {
        let kind = SamplerKind::Stratified { jitter };
        for (blocks, parts) in
            BLOCKS
                .into_iter()
                .zip([[1, 1], [1, 2], [1, 3], [2, 2], [1, 7], [2, 4]])
        {
            for side in [1, 2, 4] {
                let each = side * side;
                let at = |index: u32| {
                    numbers(kind, &address(index / each, index % each, each, blocks), 6)
                };
                let pairs = |indices: std::ops::Range<u32>| indices.map(move |i| at(i).0);
                let singles =
                    |indices: std::ops::Range<u32>| indices.map(move |i| Vec2::new(at(i).1, 0.0));
                // Each block, then all of them. Mutant: blocks with strata of their own only.
                for block in 0..blocks {
                    let own = block * each..(block + 1) * each;
                    assert!(fill(pairs(own.clone()), [side, side]), "{blocks} {each}");
                    assert!(fill(singles(own), [each, 1]), "{blocks} {each}");
                }
                let all = 0..blocks * each;
                assert!(
                    fill(pairs(all.clone()), parts.map(|n| n * side)),
                    "{blocks} {each}"
                );
                assert!(fill(singles(all), [blocks * each, 1]), "{blocks} {each}");
            }
        }
    }
}

/// A block alone must be a fair sample: every point uniform, whichever block and sample.
#[test]
fn every_sample_of_a_block_is_uniform() {
    for kind in [SamplerKind::Stratified { jitter: true }, SamplerKind::Sobol] {
        for (block, sample) in [(0, 0), (2, 1), (7, 3)] {
            let mut cells = vec![0.0; 64];
            for seed in 0..20_000 {
                let at = SampleId {
                    seed,
                    ..address(block, sample, 4, 8)
                };
                let cell = (numbers(kind, &at, 4).0 * 8.0).as_uvec2();
                cells[(cell.y * 8 + cell.x) as usize] += 1.0;
            }
            // α = 10⁻⁴ for each of 6 tests.
            assert!(
                crate::evidence::uniform(&cells) > 1e-4,
                "{kind:?} {block} {sample}"
            );
        }
    }
}

#[test]
fn more_samples_than_a_sequence_has_begin_another() {
    let last = address(7, (1 << 29) - 1, 1 << 29, 8);
    assert_eq!((last.replicate, last.sample), (0, u32::MAX));
    let next = address(8, 0, 1 << 29, 16);
    assert_eq!((next.replicate, next.sample), (1, 0));
}

#[test]
fn independent_replicates_keep_their_address() {
    let own = address(0, 3, 4, 1);
    assert_eq!(ReplicateKind::Independent.address(own, 8), own);
}

/// Of many pixels, the shares of 95 % intervals that cover the truth, and the mean squared error over the
/// reported one, of an integrand over pairs with R = 8 blocks of 4; `block` chooses the block's address.
fn intervals(
    kind: SamplerKind,
    (integrand, truth): (fn(Vec2) -> f64, f64),
    block: fn(u32) -> u32,
) -> (f64, f64) {
    const PIXELS: u64 = 4000;
    let (mut covered, mut errors, mut reported) = (0.0, 0.0, 0.0);
    for seed in 0..PIXELS {
        let mean = |replicate| {
            let value = |sample| {
                let at = address(block(replicate), sample, 4, 8);
                integrand(numbers(kind, &SampleId { seed, ..at }, 8).0)
            };
            (0..4).map(value).sum::<f64>() / 4.0
        };
        let means: [f64; 8] = std::array::from_fn(|replicate| mean(replicate as u32));
        let summary = etalon_statistics::Summary::of(&means).expect("eight numbers");
        let (off, error) = (summary.mean() - truth, summary.standard_error());
        // Student's t with seven degrees of freedom.
        covered += f64::from(u8::from(off.abs() <= 2.3646 * error));
        errors += off * off;
        reported += error * error;
    }
    (covered / PIXELS as f64, errors / reported)
}

/// The standard error from the spread of blocks is an upper estimate: intervals cover at least at their
/// rate. No theorem: a checkerboard aligned with the net is a known exception.
#[test]
fn the_spread_of_blocks_overstates_the_error() {
    let edge: (fn(Vec2) -> f64, f64) = (|p| f64::from(u8::from(p.x + 0.3 * p.y < 0.6)), 0.45);
    let disc: (fn(Vec2) -> f64, f64) = (
        |p| f64::from(u8::from(p.length_squared() < 0.64)),
        0.16 * std::f64::consts::PI,
    );
    let smooth: (fn(Vec2) -> f64, f64) = (|p| f64::from(p.x * p.y), 0.25);
    for kind in [SamplerKind::Stratified { jitter: true }, SamplerKind::Sobol] {
        for integrand in [edge, disc, smooth] {
            let (covered, ratio) = intervals(kind, integrand, |block| block);
            // 3.3 standard deviations of the share of 4000 at 0.95.
            assert!(
                covered > 0.9386 && ratio < 1.0,
                "{kind:?}: {covered} {ratio}"
            );
            // Mutant: the second half of the blocks repeats the first, so that blocks correlate.
            // (A smooth function is so well integrated that even this does no harm.)
            if integrand.1 != smooth.1 {
                let (covered, _) = intervals(kind, integrand, |block| block % 4);
                assert!(covered < 0.92, "{kind:?}: {covered}");
            }
        }
    }
    // Independent numbers have nothing to gain: the squared error is the reported one.
    let (_, ratio) = intervals(SamplerKind::Independent, edge, |block| block);
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
}
