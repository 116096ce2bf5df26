//! Metropolis integrators in the glowing sphere.

use crate::world::{Fault, Sphere};
use crate::{Meter, series, settings, white};
use etalon_integrators::metropolis::ChainSettings;
use etalon_integrators::mmlt::{Multiplexed, Techniques};
use etalon_integrators::pssmlt::{CameraPaths, PrimarySpace};
use etalon_sampling::{Independent, SampleId, Sampler};
use etalon_transport::{Integrator, Pass, PixelSample};
use glam::UVec2;

const REFLECTANCE: f32 = 0.6;
const REPLICATES: u32 = 150;
const SAMPLES: u32 = 1000;

/// z of the mean of replicates against `expected` (in units of a white spectrum's green).
fn z_score<I: Integrator>(integrator: &I, world: &Sphere, expected: f64) -> f64 {
    let (mut sum, mut squares) = (0.0, 0.0);
    let mut before = None;
    for replicate in 0..REPLICATES {
        let pass = Pass {
            seed: 5,
            replicate,
            number: 0,
            count: 1,
            samples: SAMPLES,
            replicates: REPLICATES,
            image_samples: REPLICATES * SAMPLES,
            origin: UVec2::ZERO,
            size: UVec2::ONE,
            margin: 0,
        };
        let state = integrator.prepare(world, &(), &pass, before.take());
        let mut meter = Meter::default();
        for sample in 0..SAMPLES {
            let mut sampler = Independent::start(&SampleId {
                seed: 5,
                replicate,
                pixel: (0, 0),
                sample,
                samples_per_replicate: SAMPLES,
                blocks: 1,
            });
            let site = PixelSample {
                pixel: UVec2::ZERO,
                raster: sampler.next_2d(),
                margin: 0.0,
                pixels: 1,
                spacing: 1.0,
                sample,
            };
            integrator.sample(world, &state, &site, &mut sampler, &mut meter);
        }
        before = Some(state);
        let mean = meter.value / f64::from(SAMPLES);
        sum += mean;
        squares += mean * mean;
    }
    let n = f64::from(REPLICATES);
    let mean = sum / n;
    let variance = (squares / n - mean * mean) / (n - 1.0);
    (mean - expected * white()) / variance.sqrt()
}

/// Four chains a replicate.
fn chains(separate_direct: bool) -> ChainSettings {
    ChainSettings {
        length: 250,
        seeds: Some(300),
        separate_direct,
        ..ChainSettings::default()
    }
}

fn multiplexed(max_depth: u32, separate_direct: bool) -> Multiplexed {
    Multiplexed {
        settings: settings(max_depth),
        chains: chains(separate_direct),
        paths: Techniques,
    }
}

fn primary(max_depth: u32, separate_direct: bool) -> PrimarySpace {
    PrimarySpace {
        settings: settings(max_depth),
        chains: chains(separate_direct),
        paths: CameraPaths,
    }
}

/// Eight comparisons at a family-wise α of 10⁻³ (Student's t with 149 degrees of freedom).
const LIMIT: f64 = 3.93;

#[test]
fn chains_agree_with_the_geometric_series() {
    let world = Sphere::new(REFLECTANCE, Fault::None);
    let exact = |segments| series(f64::from(REFLECTANCE), segments);
    for separate in [true, false] {
        for (what, z) in [
            (
                "mmlt, 1 segment",
                z_score(&multiplexed(1, separate), &world, exact(1)),
            ),
            (
                "mmlt, 3 segments",
                z_score(&multiplexed(3, separate), &world, exact(3)),
            ),
            (
                "mmlt, 6 segments",
                z_score(&multiplexed(6, separate), &world, exact(6)),
            ),
            (
                "pssmlt, unlimited",
                z_score(&primary(u32::MAX, separate), &world, 2.5),
            ),
        ] {
            assert!(z.abs() < LIMIT, "{what}, {separate}: z = {z:.2}");
        }
    }
}

#[test]
fn faults_are_noticed_by_chains() {
    for fault in [Fault::Emission, Fault::ScatteringDensity, Fault::Importance] {
        let world = Sphere::new(REFLECTANCE, fault);
        let exact = series(f64::from(REFLECTANCE), 4);
        let z = z_score(&multiplexed(4, false), &world, exact);
        assert!(
            z.abs() > LIMIT,
            "fault {} in mmlt: z = {z:.2}",
            fault as u32
        );
        if fault != Fault::Importance {
            let z = z_score(&primary(4, false), &world, exact);
            assert!(
                z.abs() > LIMIT,
                "fault {} in pssmlt: z = {z:.2}",
                fault as u32
            );
        }
    }
}
