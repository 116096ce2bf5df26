//! `distribution`: trees against exact radiances, and trees of one branch against `path`.

use crate::agreement::everything;
use crate::exact::Exact;
use crate::measure::{LIMIT, measure};
use crate::world::{Fault, Plane, Stack, ZERO};
use etalon_integrators::distribution::Distribution;
use etalon_integrators::path::Path;
use etalon_integrators::settings::{LightCandidates, PathSettings};

fn settings(max_depth: u32, rr_depth: u32) -> PathSettings {
    PathSettings {
        max_depth,
        rr_depth,
        hide_emitters: false,
    }
}

fn distribution(max_depth: u32, rr_depth: u32, samples: u32, decay: u32) -> Distribution {
    Distribution {
        settings: settings(max_depth, rr_depth),
        samples,
        decay,
    }
}

/// Discrete directions, one for each wavelength, among continuous ones, under a sky.
fn rainbow() -> Stack {
    let planes = vec![
        Plane {
            smooth: 0.5,
            exponent: |nm| 1.0 + (nm - 360.0) * 0.03,
            ..Plane::WHITE
        },
        Plane {
            height: 1.0,
            passing: |nm| if nm < 500.0 { 0.7 } else { 0.4 },
            smooth: 1.0,
            emission: [|nm| 300.0 / nm, ZERO],
            ..Plane::WHITE
        },
    ];
    Stack::new(planes, |_| 1.0, 0.5, false)
}

#[test]
fn with_one_branch_it_is_path_number_for_number() {
    for (name, stack) in [("everything", everything()), ("rainbow", rainbow())] {
        for (max_depth, rr_depth) in [(0, 5), (1, 5), (2, 5), (4, 1), (u32::MAX, 2)] {
            let path = Path {
                skips_null: false,
                settings: settings(max_depth, rr_depth),
                light_candidates: LightCandidates::ONE,
                equiangular: false,
            };
            let tree = distribution(max_depth, rr_depth, 1, 1);
            let [a, b] = [measure(&path, &stack, 500), measure(&tree, &stack, 500)];
            // The same numbers, added in another order.
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-6 * a.abs();
            let same = a.mean.into_iter().zip(b.mean).all(|(a, b)| close(a, b));
            assert!(
                same,
                "{name}, max_depth {max_depth}: {:?} {:?}",
                a.mean, b.mean
            );
        }
    }
}

#[test]
fn any_number_of_branches_is_exact() {
    for (name, stack) in [("everything", everything()), ("rainbow", rainbow())] {
        for (depth, rr_depth, samples, decay) in
            [(2, 9, 3, 1), (3, 9, 2, 1), (5, 2, 2, 1), (12, 3, 6, 2)]
        {
            let exact = Exact {
                stack: &stack,
                max_depth: depth,
                hidden: false,
            };
            let tree = distribution(depth, rr_depth, samples, decay);
            let z = measure(&tree, &stack, 12_000).z(exact.colour());
            assert!(z < LIMIT, "{name}, {depth} {samples} {decay}: z = {z:.2}");
        }
    }
}

#[test]
fn wrong_densities_are_noticed() {
    for fault in [Fault::OtherLanes, Fault::LightChoice, Fault::FreePassage] {
        let stack = everything().with(fault);
        let sound = everything();
        let exact = Exact {
            stack: &sound,
            max_depth: 4,
            hidden: false,
        };
        let tree = distribution(4, 9, 3, 2);
        let z = measure(&tree, &stack, 20_000).z(exact.colour());
        assert!(z > LIMIT, "{fault:?}: z = {z:.2}");
    }
}

/// Between two white planes no path ends. Mutant rejected: a call within a call for every segment, which a stack of
/// two megabytes does not hold.
#[test]
fn a_path_may_be_as_long_as_it_likes() {
    let white = |height| Plane {
        height,
        reflectance: |_| 0.9999,
        ..Plane::WHITE
    };
    let stack = Stack::new(vec![white(0.0), white(1.0)], |_| 1.0, 0.5, false);
    let tree = distribution(100_000, 100_000, 1, 1);
    assert!(measure(&tree, &stack, 2).mean[3] > 0.99);
}
