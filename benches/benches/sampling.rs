//! How long random numbers, warps and table lookups take.

use criterion::{Criterion, criterion_group, criterion_main};
use etalon_math::{Vec2, Vec3};
use etalon_sampling::discrete::{AliasTable, PiecewiseConstant2d};
use etalon_sampling::{SampleId, Sampler, SamplerKind, warps};
use std::hint::black_box;

/// One sample of a path of eight bounces: the start, and 36 pairs of dimensions.
fn path(kind: SamplerKind, sample: u32) -> Vec2 {
    let mut sampler = kind.start(&SampleId {
        seed: 1,
        replicate: 2,
        pixel: (30, 40),
        sample,
        samples_per_replicate: 16,
        blocks: 1,
    });
    (0..36).fold(Vec2::ZERO, |sum, _| sum + sampler.next_2d())
}

fn samplers(criterion: &mut Criterion) {
    for kind in [
        SamplerKind::Independent,
        SamplerKind::Stratified { jitter: true },
        SamplerKind::Sobol,
    ] {
        let mut sample = 0;
        criterion.bench_function(&format!("36 pairs, {kind:?}"), |bench| {
            bench.iter(|| {
                sample = (sample + 1) % 16;
                path(black_box(kind), sample)
            });
        });
    }
}

/// A thousand points of the square.
fn points() -> Vec<Vec2> {
    (0..1000)
        .map(|i| path(SamplerKind::Sobol, i) / 36.0)
        .collect()
}

fn maps(criterion: &mut Criterion) {
    let points = points();
    let mut each = |name: &str, map: &dyn Fn(Vec2) -> Vec3| {
        criterion.bench_function(&format!("1000 × {name}"), |bench| {
            bench.iter(|| points.iter().map(|&u| map(u)).sum::<Vec3>());
        });
    };
    each("concentric disk", &|u| {
        warps::square_to_concentric_disk(u).extend(0.0)
    });
    each("cosine hemisphere", &warps::square_to_cosine_hemisphere);
    each("uniform sphere", &warps::square_to_uniform_sphere);
    let corner = Vec3::new(-0.5, -0.4, 1.0);
    each("spherical triangle, set up and sampled", &|u| {
        let corners = [corner, corner + Vec3::X, corner + Vec3::new(u.x, 1.0, 0.0)];
        warps::SphericalTriangle::new(corners.map(Vec3::as_dvec3))
            .map_or(Vec3::ZERO, |light| light.sample(u))
    });
    each("spherical rectangle, set up and sampled", &|u| {
        let corner = corner + 0.1 * u.extend(0.0);
        warps::SphericalRectangle::new(corner, [Vec3::X, Vec3::Y])
            .map_or(Vec3::ZERO, |light| light.sample(u))
    });
}

fn tables(criterion: &mut Criterion) {
    let points = points();
    let weights: Vec<f64> = (0..1024 * 512).map(|i| f64::from(i % 1000)).collect();
    let alias = AliasTable::new(&weights[..4096]).expect("weights");
    let grid = PiecewiseConstant2d::new(&weights, 1024).expect("weights");
    criterion.bench_function("1000 × alias table of 4096", |bench| {
        bench.iter(|| {
            points
                .iter()
                .map(|&u| alias.sample(u.x).index)
                .sum::<usize>()
        });
    });
    criterion.bench_function("1000 × grid of 1024 × 512", |bench| {
        bench.iter(|| points.iter().map(|&u| grid.sample(u)).sum::<Vec2>());
    });
}

criterion_group!(benches, samplers, maps, tables);
criterion_main!(benches);
