//! `path` and `direct` against exact radiances: multiple importance sampling over two lights,
//! surfaces that let light pass, limits on depth, Russian roulette.

use crate::exact::Exact;
use crate::measure::{LIMIT, measure};
use crate::world::{Fault, Plane, Stack, ZERO};
use core::num::NonZeroU32;
use etalon_integrators::direct::Direct;
use etalon_integrators::path::Path;
use etalon_integrators::settings::{LightCandidates, PathSettings};

const N: u32 = 60_000;

/// Filters, reflectors and lights that all disagree about every wavelength.
pub(crate) fn everything() -> Stack {
    let planes = vec![
        Plane {
            exponent: |nm| 1.0 + (nm - 360.0) * 0.05,
            reflectance: |nm| 0.3 + (nm - 360.0) * 1e-3,
            ..Plane::WHITE
        },
        Plane {
            height: 1.0,
            passing: |nm| if nm < 560.0 { 0.8 } else { 0.3 },
            reflectance: |_| 0.5,
            exponent: |nm| (900.0 - nm) * 0.02,
            ..Plane::WHITE
        },
        Plane {
            height: 2.0,
            passing: |nm| 0.2 + (nm - 360.0) * 1.5e-3,
            emission: [|nm| nm / 500.0, |_| 0.3],
            ..Plane::WHITE
        },
        Plane {
            height: 3.0,
            emission: [|_| 2.0, ZERO],
            ..Plane::BLACK
        },
    ];
    // The camera is below the first filter and looks down.
    Stack::new(planes, ZERO, 0.5, false)
}

/// Mirrors whose direction turns with wavelength, below a filter and a uniform sky.
pub(crate) fn rainbow() -> Stack {
    let planes = vec![
        Plane {
            smooth: 0.6,
            exponent: |nm| 1.0 + (nm - 360.0) * 0.03,
            ..Plane::WHITE
        },
        Plane {
            height: 1.0,
            passing: |nm| if nm < 500.0 { 0.7 } else { 0.4 },
            smooth: 0.3,
            reflectance: |_| 0.9,
            ..Plane::WHITE
        },
    ];
    Stack::new(planes, |_| 1.0, 0.5, false)
}

fn path(max_depth: u32, rr_depth: u32) -> Path {
    Path {
        settings: PathSettings {
            max_depth,
            rr_depth,
            hide_emitters: false,
        },
        ..Path::default()
    }
}

fn exact(stack: &Stack, max_depth: u32) -> [f64; 3] {
    Exact {
        stack,
        max_depth,
        hidden: false,
    }
    .colour()
}

const NO_ROULETTE: u32 = u32::MAX;

#[test]
fn path_is_exact_for_every_limit_on_depth() {
    for (name, stack) in [("everything", everything()), ("rainbow", rainbow())] {
        for depth in [0, 1, 2, 3, 4, 5, 7, 80] {
            let z = measure(&path(depth, NO_ROULETTE), &stack, N).z(exact(&stack, depth));
            assert!(z < LIMIT, "{name}, max_depth {depth}: z = {z:.2}");
        }
    }
}

#[test]
fn roulette_changes_no_expectation() {
    for (name, stack) in [("everything", everything()), ("rainbow", rainbow())] {
        for (max_depth, rr_depth) in [(80, 1), (80, 2), (4, 1), (3, 2)] {
            let found = measure(&path(max_depth, rr_depth), &stack, N);
            let z = found.z(exact(&stack, max_depth));
            assert!(z < LIMIT, "{name}, {max_depth}, rr {rr_depth}: z = {z:.2}");
        }
    }
}

#[test]
fn direct_is_a_path_of_two_segments() {
    for (name, stack) in [("everything", everything()), ("rainbow", rainbow())] {
        let expected = exact(&stack, 2);
        for (emitter_samples, bsdf_samples) in [(1, 1), (3, 1), (1, 4), (2, 3), (0, 2)] {
            let direct = Direct {
                max_depth: u32::MAX,
                emitter_samples,
                bsdf_samples,
                hide_emitters: false,
                light_candidates: LightCandidates::default(),
            };
            let z = measure(&direct, &stack, N / 3).z(expected);
            assert!(
                z < LIMIT,
                "{name}, {emitter_samples} + {bsdf_samples}: z = {z:.2}"
            );
        }
    }
    // Light sampling alone finds everything that no discrete direction leads to.
    let direct = Direct {
        max_depth: u32::MAX,
        emitter_samples: 2,
        bsdf_samples: 0,
        hide_emitters: false,
        light_candidates: LightCandidates::default(),
    };
    let mut stack = everything();
    stack.planes.retain(|p| p.height != 1.0);
    let z = measure(&direct, &stack, N).z(exact(&stack, 2));
    assert!(z < LIMIT, "light samples only: z = {z:.2}");
}

/// One shadow ray for several light samples, whatever lies in the way. Rejects samples that count against scattering
/// as often as they are drawn on one side only, and a choice that forgets its probability.
#[test]
fn competing_light_samples_change_no_mean() {
    for (name, stack) in [("everything", everything()), ("rainbow", rainbow())] {
        for count in [1, 2, 5] {
            let light_candidates = LightCandidates(NonZeroU32::new(count));
            let path = Path {
                light_candidates,
                ..path(7, NO_ROULETTE)
            };
            let z = measure(&path, &stack, N).z(exact(&stack, 7));
            assert!(z < LIMIT, "path, {name}, {count} candidates: z = {z:.2}");
            for (emitter_samples, bsdf_samples) in [(1, 1), (2, 3)] {
                let direct = Direct {
                    max_depth: u32::MAX,
                    emitter_samples,
                    light_candidates,
                    bsdf_samples,
                    hide_emitters: false,
                };
                let z = measure(&direct, &stack, N / 3).z(exact(&stack, 2));
                assert!(z < LIMIT, "direct, {name}, {count} candidates: z = {z:.2}");
            }
        }
    }
}

#[test]
fn wrong_densities_are_noticed() {
    let cases = [
        (everything as fn() -> Stack, Fault::OtherLanes),
        (everything, Fault::FreePassage),
        (everything, Fault::LightChoice),
        (rainbow, Fault::AtomForAll),
        (rainbow, Fault::FreePassage),
    ];
    for (stack, fault) in cases {
        let stack = stack().with(fault);
        let z = measure(&path(7, NO_ROULETTE), &stack, N).z(exact(&stack, 7));
        assert!(z > LIMIT, "{fault:?} unnoticed: z = {z:.2}");
    }
    let direct = Direct {
        max_depth: u32::MAX,
        emitter_samples: 1,
        bsdf_samples: 2,
        hide_emitters: false,
        light_candidates: LightCandidates::default(),
    };
    let stack = everything().with(Fault::LightChoice);
    let stack = Stack {
        planes: stack
            .planes
            .iter()
            .filter(|p| p.height != 1.0)
            .copied()
            .collect(),
        ..stack
    };
    let z = measure(&direct, &stack, N).z(exact(&stack, 2));
    assert!(z > LIMIT, "direct did not notice: z = {z:.2}");
}
