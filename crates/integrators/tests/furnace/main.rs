//! A glowing sphere seen from its centre: the estimators against a geometric series.
//!
//! Inside a closed diffuse sphere of reflectance ρ that emits radiance 1 everywhere, the radiance
//! along any ray is Σᵢ ρⁱ, i = 0 … n − 1 segments (the series 1/(1 − ρ) when unlimited). The
//! world below has no scene, no materials and no shapes: what is tested is the estimator.

mod chains;
mod chance;
mod photons;
mod pinhole;
mod techniques;
mod world;

use etalon_integrators::bdpt::Bidirectional;
use etalon_integrators::direct::Direct;
use etalon_integrators::path::Path;
use etalon_integrators::ptracer::ParticleTracer;
use etalon_integrators::settings::{LightCandidates, PathSettings};
use etalon_sampling::{Independent, SampleId, Sampler};
use etalon_spectrum::sensor;
use etalon_transport::*;
use glam::{UVec2, Vec2, Vec4};
use world::{Fault, Sphere};

/// Sums what an estimator says of the one pixel [0, 1)².
#[derive(Default)]
struct Meter {
    value: f64,
}

impl Sink for Meter {
    fn radiance(&mut self, rgb: [f32; 3], _: f32) {
        self.value += f64::from(rgb[1]);
    }
    fn splat(&mut self, _: Vec2, rgb: [f32; 3]) {
        self.value += f64::from(rgb[1]);
    }
    fn channel(&mut self, _: usize, _: f32) {}
}

/// Green of the constant spectrum 1: the response is linear between whole nanometres, so that
/// the trapezoid rule is exact.
fn white() -> f64 {
    let green = |nm: i32| f64::from(sensor::response(Vec4::splat(nm as f32))[1].x);
    (360..830).map(|nm| 0.5 * (green(nm) + green(nm + 1))).sum()
}

/// z of the mean green value of `n` samples against `expected` (in units of a white spectrum's).
fn z_score<I: Integrator<State = ()>>(
    integrator: &I,
    world: &Sphere,
    expected: f64,
    n: u32,
) -> f64 {
    let (mut sum, mut squares) = (0.0, 0.0);
    for sample in 0..n {
        let mut sampler = Independent::start(&SampleId {
            seed: 7,
            replicate: 0,
            pixel: (0, 0),
            sample,
            samples_per_replicate: n,
            blocks: 1,
        });
        let site = PixelSample {
            pixel: UVec2::ZERO,
            raster: sampler.next_2d(),
            margin: 0.0,
            pixels: 1,
            spacing: 1.0,
            sample: 0,
        };
        let mut meter = Meter::default();
        integrator.sample(world, &(), &site, &mut sampler, &mut meter);
        sum += meter.value;
        squares += meter.value * meter.value;
    }
    let n = f64::from(n);
    let mean = sum / n;
    let variance = (squares / n - mean * mean) / n;
    (mean - expected * white()) / variance.sqrt()
}

fn settings(max_depth: u32) -> PathSettings {
    PathSettings {
        max_depth,
        ..PathSettings::default()
    }
}

/// Nine comparisons at a family-wise α of 10⁻³ (two-sided normal quantile of 10⁻³/9 ≈ 3.86).
const LIMIT: f64 = 3.86;
const N: u32 = 150_000;

fn series(reflectance: f64, segments: i32) -> f64 {
    (0..segments).map(|i| reflectance.powi(i)).sum()
}

#[test]
fn estimators_agree_with_the_geometric_series() {
    let world = Sphere::new(0.6, Fault::None);
    let limited = |n| settings(n);
    let path = |n| Path {
        settings: limited(n),
        ..Path::default()
    };
    let light = |n| ParticleTracer {
        settings: limited(n),
    };
    let both = |n| Bidirectional {
        settings: limited(n),
        only: None,
    };
    let direct = Direct {
        max_depth: u32::MAX,
        emitter_samples: 2,
        bsdf_samples: 1,
        hide_emitters: false,
        light_candidates: LightCandidates::default(),
    };
    for (what, z) in [
        (
            "path, 1 segment",
            z_score(&path(1), &world, series(0.6, 1), N),
        ),
        (
            "path, 3 segments",
            z_score(&path(3), &world, series(0.6, 3), N),
        ),
        ("path, unlimited", z_score(&path(u32::MAX), &world, 2.5, N)),
        ("direct", z_score(&direct, &world, series(0.6, 2), N)),
        (
            "ptracer, 3 segments",
            z_score(&light(3), &world, series(0.6, 3), N),
        ),
        (
            "ptracer, unlimited",
            z_score(&light(u32::MAX), &world, 2.5, N),
        ),
        (
            "bdpt, 2 segments",
            z_score(&both(2), &world, series(0.6, 2), N),
        ),
        (
            "bdpt, 4 segments",
            z_score(&both(4), &world, series(0.6, 4), N),
        ),
        ("bdpt, unlimited", z_score(&both(u32::MAX), &world, 2.5, N)),
    ] {
        assert!(z.abs() < LIMIT, "{what}: z = {z:.2}");
    }
}

#[test]
fn faults_are_noticed() {
    let path = Path {
        settings: settings(3),
        ..Path::default()
    };
    let light = ParticleTracer {
        settings: settings(3),
    };
    let both = Bidirectional {
        settings: settings(3),
        only: None,
    };
    for fault in [Fault::ScatteringDensity, Fault::Emission, Fault::Importance] {
        let world = Sphere::new(0.6, fault);
        let z = z_score(&both, &world, series(0.6, 3), N);
        let number = fault as u32;
        assert!(z.abs() > LIMIT, "fault {number} unnoticed: z = {z:.2}");
    }
    for fault in [
        Fault::LightDensity,
        Fault::ScatteringDensity,
        Fault::Emission,
    ] {
        let world = Sphere::new(0.6, fault);
        let z = z_score(&path, &world, series(0.6, 3), N);
        assert!(
            z.abs() > LIMIT,
            "fault {} unnoticed: z = {z:.2}",
            fault as u32
        );
    }
    let world = Sphere::new(0.6, Fault::Importance);
    let z = z_score(&light, &world, series(0.6, 3), N);
    assert!(
        z.abs() > LIMIT,
        "importance without cosine unnoticed: z = {z:.2}"
    );
}
