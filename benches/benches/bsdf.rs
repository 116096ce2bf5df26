//! What every material costs: to be resolved and evaluated, and to be resolved and sampled, in nanoseconds.
//!
//! `cargo bench --bench bsdf`, or `cargo bench --bench bsdf -- sample/hair` for one. The materials are the examples of
//! `docs/plugins.toml`.

use criterion::{Criterion, criterion_group, criterion_main};
use etalon_benches::material::LoneMaterial;
use etalon_math::float;
use etalon_spectrum::Wavelengths;
use etalon_transport::{Bsdf, TransportMode};
use glam::{Vec2, Vec3, Vec4};
use std::fs;
use std::hint::black_box;
use std::path::Path;

/// Directions and numbers that differ from call to call.
fn directions() -> Vec<(Vec3, Vec3, f32, Vec2)> {
    // The golden ratio's and its square's multiples spread evenly.
    let part = |i: usize, step: f32| (i as f32 * step).fract();
    (0..1024)
        .map(|i| {
            let direction = |z: f32, turn: f32| {
                let z = 0.05 + 0.95 * z;
                let (y, x) = float::sin_cos_turns(turn);
                let r = (1.0 - z * z).sqrt();
                Vec3::new(r * x, r * y, z)
            };
            (
                direction(part(i, 0.618_034), part(i, 0.381_966)),
                direction(part(i, 0.754_878), part(i, 0.569_84)),
                part(i, 0.819_172),
                Vec2::new(part(i, 0.671_044), part(i, 0.549_7)),
            )
        })
        .collect()
}

fn materials(criterion: &mut Criterion) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let words = fs::read_to_string(root.join("docs/plugins.toml")).expect("the file is there");
    let words: toml::Table = words.parse().expect("the file is well-formed");
    let wavelengths = Wavelengths {
        lambda: Vec4::new(450.0, 510.0, 570.0, 630.0),
        density: Vec4::ONE,
    };
    let places = directions();
    for plugin in words["plugin"].as_array().expect("a list") {
        if plugin["class"].as_str() != Some("bsdf") || plugin.get("scene").is_some() {
            continue;
        }
        let name = plugin["names"][0].as_str().expect("a name");
        let example = plugin["example"].as_str().expect("an element");
        let material = LoneMaterial::read(example, vec![root.join("scenes")]).expect(name);
        let places: Vec<(Vec3, Vec3, Vec3, f32, Vec2)> = (places.iter())
            .map(|&(wo, wi, u_lobe, u)| {
                (wo, material.to_world(wo), material.to_world(wi), u_lobe, u)
            })
            .collect();
        let mut next = places.iter().cycle();
        criterion.bench_function(&format!("eval/{name}"), |bencher| {
            bencher.iter(|| {
                let &(wo, o, i, ..) = next.next().expect("endless");
                let bsdf = material.at(wo, &wavelengths);
                black_box(bsdf.eval_and_density(o, i, TransportMode::Radiance))
            });
        });
        criterion.bench_function(&format!("sample/{name}"), |bencher| {
            bencher.iter(|| {
                let &(wo, o, _, u_lobe, u) = next.next().expect("endless");
                let bsdf = material.at(wo, &wavelengths);
                black_box(bsdf.sample(o, u_lobe, u, TransportMode::Radiance))
            });
        });
    }
}

fn short() -> Criterion {
    Criterion::default()
        .sample_size(20)
        .warm_up_time(std::time::Duration::from_millis(200))
        .measurement_time(std::time::Duration::from_millis(600))
}

criterion_group! { name = benches; config = short(); targets = materials }
criterion_main!(benches);
