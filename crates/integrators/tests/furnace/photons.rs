//! The estimators that merge with photons, in the glowing sphere.
//!
//! There the irradiance is the same everywhere, and the part of a unit sphere within a chord d of a
//! point has the area π d² exactly: kernels are normalised as on a plane, at any radius. What
//! remains of bias is that a photon's direction makes another angle with the normal where it is
//! looked up: the radiance gathered is lower by less than r²/8, here 3·10⁻⁴ of it.

use crate::series;
use crate::world::{Fault, Sphere};
use crate::{Meter, settings, white};
use etalon_integrators::photonmap::{Estimate, PhotonMapper};
use etalon_integrators::photons::radius::Radius;
use etalon_integrators::sppm::Progressive;
use etalon_integrators::vcm::ConnectionMerging;
use etalon_sampling::{Independent, SampleId, Sampler};
use etalon_transport::{Integrator, Pass, PixelSample, Preparation};
use glam::UVec2;

const PHOTONS: u32 = 1024;
const RADIUS: f32 = 0.05;
/// Independent sets of photons, and camera samples for each.
const PASSES: u32 = 96;
const SAMPLES: u32 = 128;

/// The pass of a replicate that has but one.
fn pass(replicate: u32) -> Pass {
    Pass {
        seed: 11,
        replicate,
        number: 0,
        count: 1,
        samples: SAMPLES,
        replicates: 1,
        image_samples: PASSES * SAMPLES,
        origin: UVec2::ZERO,
        size: UVec2::ONE,
        margin: 0,
    }
}

/// Draws one sample of a replicate.
fn sample_once<I: Integrator>(
    integrator: &I,
    world: &Sphere,
    state: &I::State,
    (replicate, sample): (u32, u32),
    meter: &mut Meter,
) {
    let mut sampler = Independent::start(&SampleId {
        seed: 11,
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
    integrator.sample(world, state, &site, &mut sampler, meter);
}

/// z of the mean green value against `expected` (in units of a white spectrum's), from the means
/// of independent passes.
fn z_score<I: Integrator>(integrator: &I, world: &Sphere, expected: f64) -> f64 {
    let (mut sum, mut squares) = (0.0, 0.0);
    for replicate in 0..PASSES {
        let state = integrator.prepare(world, &(), &pass(replicate), None);
        let mut meter = Meter::default();
        for sample in 0..SAMPLES {
            sample_once(integrator, world, &state, (replicate, sample), &mut meter);
        }
        let mean = meter.value / f64::from(SAMPLES);
        sum += mean;
        squares += mean * mean;
    }
    let n = f64::from(PASSES);
    let mean = sum / n;
    let variance = (squares / n - mean * mean) / (n - 1.0);
    (mean - expected * white()) / variance.sqrt()
}

fn progressive(max_depth: u32) -> Progressive {
    Progressive {
        settings: settings(max_depth),
        radius: Radius {
            first: Some(RADIUS),
            ..Radius::default()
        },
        photons: Some(PHOTONS),
        ..Progressive::default()
    }
}

fn mapper(final_gather: bool, cone: Option<f32>, nearest: usize) -> PhotonMapper {
    let estimate = Estimate {
        radius: (nearest == 0).then_some(RADIUS),
        nearest,
    };
    PhotonMapper {
        settings: settings(4),
        photons: PHOTONS,
        final_gather,
        global: estimate,
        caustic: estimate,
        cone,
        ..PhotonMapper::default()
    }
}

fn merging(max_depth: u32) -> ConnectionMerging {
    ConnectionMerging {
        settings: settings(max_depth),
        radius: Radius {
            first: Some(RADIUS),
            ..Radius::default()
        },
        photons: Some(PHOTONS),
        ..ConnectionMerging::default()
    }
}

/// `vcm` that merges only, and so takes more photons to see as much.
fn merging_alone(max_depth: u32) -> ConnectionMerging {
    ConnectionMerging {
        photons: Some(4 * PHOTONS),
        connections: false,
        ..merging(max_depth)
    }
}

/// Ten comparisons at a family-wise α of 10⁻³: two-sided quantile of 10⁻³/10 of Student's t with 95
/// degrees of freedom ≈ 4.06.
const LIMIT: f64 = 4.06;

#[test]
fn merging_agrees_with_the_geometric_series() {
    let world = Sphere::new(0.6, Fault::None);
    let limited = series(0.6, 4);
    for (what, z) in [
        (
            "sppm, 2 segments",
            z_score(&progressive(2), &world, series(0.6, 2)),
        ),
        (
            "sppm, 4 segments",
            z_score(&progressive(4), &world, limited),
        ),
        (
            "sppm, unlimited",
            z_score(&progressive(u32::MAX), &world, 2.5),
        ),
        (
            "sppm, photons alone",
            z_score(
                &Progressive {
                    sample_lights: false,
                    ..progressive(3)
                },
                &world,
                series(0.6, 3),
            ),
        ),
        (
            "photonmap, box",
            z_score(&mapper(false, None, 0), &world, limited),
        ),
        (
            "photonmap, cone",
            z_score(&mapper(false, Some(1.2), 0), &world, limited),
        ),
        (
            "photonmap, gather",
            z_score(&mapper(true, Some(1.0), 0), &world, limited),
        ),
        (
            "vcm, 3 segments",
            z_score(&merging(3), &world, series(0.6, 3)),
        ),
        ("vcm, unlimited", z_score(&merging(u32::MAX), &world, 2.5)),
        (
            "vcm, merging alone",
            z_score(&merging_alone(4), &world, limited),
        ),
    ] {
        assert!(z.abs() < LIMIT, "{what}: z = {z:.2}");
    }
}

#[test]
fn faults_are_noticed() {
    // Mutants: light 2 % too strong; scattering whose density lacks the cosine that its value has.
    for fault in [Fault::Emission, Fault::ScatteringDensity] {
        let world = Sphere::new(0.6, fault);
        let number = fault as u32;
        for (what, z) in [
            ("sppm", z_score(&progressive(4), &world, series(0.6, 4))),
            (
                "photonmap",
                z_score(&mapper(true, None, 0), &world, series(0.6, 4)),
            ),
            ("vcm", z_score(&merging(4), &world, series(0.6, 4))),
            (
                "vcm, merging alone",
                z_score(&merging_alone(4), &world, series(0.6, 4)),
            ),
        ] {
            assert!(
                z.abs() > LIMIT,
                "{what}: fault {number} unnoticed: z = {z:.2}"
            );
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    /// What a sample finds after a preparation in a pool of `threads`.
    fn value<I: Integrator>(integrator: &I, threads: usize) -> u64 {
        let world = Sphere::new(0.6, Fault::None);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().expect("a pool");
        let pass = pass(3);
        let state = pool.install(|| integrator.prepare(&world, &(), &pass, None));
        let mut meter = Meter::default();
        for sample in 0..SAMPLES {
            sample_once(integrator, &world, &state, (3, sample), &mut meter);
        }
        meter.value.to_bits()
    }
    fn check<I: Integrator>(integrator: &I) {
        let values = [1, 2, 16].map(|threads| value(integrator, threads));
        assert!(values[0] == values[1] && values[1] == values[2]);
    }
    // Enough photons for several threads to trace them and to build the tree.
    let photons = 1 << 13;
    check(&Progressive {
        photons: Some(photons),
        ..progressive(4)
    });
    check(&PhotonMapper {
        photons,
        ..mapper(true, None, 20)
    });
    check(&ConnectionMerging {
        photons: Some(photons),
        ..merging(4)
    });
}

/// Two pixels are half of the sphere here. Without a given radius a look-up is held to some tens of
/// photons, so that four times as many photons make the radius half as large, and a remark says so.
#[test]
fn a_default_radius_is_held_where_photons_are_dense() {
    let world = Sphere::new(0.6, Fault::None);
    let remarks = |photons: u32, radius: Option<f32>| {
        let sets = 1;
        let global = Estimate { radius, nearest: 0 };
        let mapper = PhotonMapper {
            photons,
            sets,
            global,
            ..mapper(false, None, 0)
        };
        let state = mapper.prepare(&world, &(), &pass(0), None);
        state.remarks()
    };
    let held = |photons: u32| -> f32 {
        let remarks = remarks(photons, None);
        let [remark] = &remarks[..] else {
            panic!("one map is held: {remarks:?}");
        };
        let metres = remark
            .split_once(" is ")
            .and_then(|(_, rest)| rest.split_once(" m "));
        metres.expect("a radius").0.parse().expect("a number")
    };
    let (few, many) = (held(1 << 12), held(1 << 14));
    assert!((few / many - 2.0).abs() < 0.2, "{few} {many}");
    // π r² of the sphere's 4π have 32 of the photons, each of which comes by two to four times.
    let found = |radius: f32, photons: f32| radius * radius / 4.0 * photons;
    assert!((4.0..32.0).contains(&found(many, 16384.0)), "{many}");
    assert_eq!(remarks(1 << 14, Some(0.3)), Vec::<String>::new());
    assert_eq!(remarks(4, None), Vec::<String>::new());
}
