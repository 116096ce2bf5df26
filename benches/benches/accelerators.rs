//! Every accelerator, and Embree if it is found, on every scene: `cargo bench --bench accelerators -- sphere/wide`.
//!
//! A benchmark is named scene/accelerator/kind of ray, or scene/accelerator/build; its time is that of 4096 rays, or of
//! a build. The table and the page of all of them are made by `cargo xtask accelerators`.

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use etalon_benches::contender::Contender;
use etalon_benches::embree::{Device, Prepared};
use etalon_benches::rays::{Kind, rays_of_every_kind};
use etalon_benches::scenes::Scene;
use etalon_geometry::AcceleratorKind;
use etalon_transport::Ray;
use std::hint::black_box;
use std::path::Path;
use std::time::Duration;

/// Rays that are timed at once: as many as half a millisecond takes.
const RAYS: usize = 4096;

fn trace(
    criterion: &mut Criterion,
    name: &str,
    contender: &impl Contender,
    rays: &[Vec<Ray>; Kind::ALL.len()],
) {
    for (kind, rays) in Kind::ALL.into_iter().zip(rays) {
        // From the middle of the picture, where there is something.
        let from = (rays.len() / 2).min(rays.len().saturating_sub(RAYS));
        let rays = &rays[from..rays.len().min(from + RAYS)];
        let mut group = criterion.benchmark_group(name);
        group.throughput(Throughput::Elements(rays.len() as u64));
        group.bench_function(kind.name(), |bencher| {
            bencher.iter(|| {
                for ray in rays {
                    match kind {
                        Kind::Shadow => black_box(f32::from(contender.occluded(black_box(ray)))),
                        _ => black_box(contender.nearest(black_box(ray))),
                    };
                }
            });
        });
        group.finish();
    }
}

fn accelerators(criterion: &mut Criterion) {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let embree = Device::find(&workspace, rayon::current_num_threads());
    for name in Scene::NAMES {
        let scene = Scene::named(name).expect("one of them");
        let rays = rays_of_every_kind(&scene, &scene.build(AcceleratorKind::Wide));
        // Of a million primitives, the linear scan would take days.
        let scanned = scene.placed_primitives() <= 100_000;
        let kinds = AcceleratorKind::ALL.into_iter();
        for kind in kinds.filter(|kind| scanned || *kind != AcceleratorKind::Linear) {
            let full = format!("{name}/{}", kind.name());
            trace(criterion, &full, &scene.build(kind), &rays);
            criterion.bench_function(&format!("{full}/build"), |bencher| {
                let build = |shapes: etalon_geometry::GeometryBuilder| shapes.build_with(kind);
                bencher.iter_batched(|| scene.shapes(), build, BatchSize::PerIteration);
            });
        }
        if let Ok(device) = &embree {
            let full = format!("{name}/embree");
            let built = Prepared::new(device, &scene).build();
            trace(criterion, &full, &built, &rays);
            criterion.bench_function(&format!("{full}/build"), |bencher| {
                let prepare = || Prepared::new(device, &scene);
                bencher.iter_batched(prepare, Prepared::build, BatchSize::PerIteration);
            });
        }
    }
}

fn config() -> Criterion {
    Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_secs(1))
}

criterion_group! { name = benches; config = config(); targets = accelerators }
criterion_main!(benches);
