//! `naive` against exact radiances: all ways to draw directions, discrete lobes and passing light
//! among them, and a density for every lane.

use crate::agreement::{everything, rainbow};
use crate::exact::Exact;
use crate::measure::{LIMIT, measure};
use crate::world::{Fault, Stack};
use etalon_integrators::naive::{Directions, Naive};
use etalon_integrators::path::Path;
use etalon_integrators::settings::PathSettings;

const N: u32 = 60_000;

const ALL: [Directions; 3] = [Directions::Bsdf, Directions::Cosine, Directions::Uniform];

fn settings(max_depth: u32, rr_depth: u32, hide_emitters: bool) -> PathSettings {
    PathSettings {
        max_depth,
        rr_depth,
        hide_emitters,
    }
}

fn naive(settings: PathSettings, directions: Directions) -> Naive {
    Naive {
        settings,
        directions,
    }
}

fn exact(stack: &Stack, max_depth: u32, hidden: bool) -> [f64; 3] {
    Exact {
        stack,
        max_depth,
        hidden,
    }
    .colour()
}

/// 36 comparisons of the file's family. Directions are drawn from a hemisphere where `one_sided`
/// says that this suffices, else from the sphere.
#[test]
fn naive_is_exact_for_every_limit_on_depth() {
    for (name, mut stack) in [("everything", everything()), ("rainbow", rainbow())] {
        for one_sided in [true, false] {
            stack.one_sided = one_sided;
            for directions in ALL {
                for (depth, rr) in [(2, u32::MAX), (4, u32::MAX), (40, 3)] {
                    let estimator = naive(settings(depth, rr, false), directions);
                    let z = measure(&estimator, &stack, N).z(exact(&stack, depth, false));
                    assert!(
                        z < LIMIT,
                        "{name}, {directions:?}, {one_sided}, {depth}: z = {z:.2}"
                    );
                }
            }
        }
    }
}

/// Colour exactly, alpha as `path` has it, which the two find by different random numbers: within
/// five standard errors of a proportion, each.
#[test]
fn hidden_lights_and_alpha_are_those_of_path() {
    for (stack, max_depth) in [(everything(), 2), (everything(), 5), (rainbow(), 4)] {
        for hide in [true, false] {
            let limits = settings(max_depth, u32::MAX, hide);
            let path = measure(
                &Path {
                    settings: limits,
                    ..Path::default()
                },
                &stack,
                N,
            );
            for directions in ALL {
                let found = measure(&naive(limits, directions), &stack, N);
                let z = found.z(exact(&stack, max_depth, hide));
                assert!(z < LIMIT, "{directions:?}, {max_depth}, {hide}: z = {z:.2}");
                let bound = 5.0 * (2.0 * 0.25 / f64::from(N)).sqrt();
                let off = (found.mean[3] - path.mean[3]).abs();
                assert!(off < bound, "{directions:?}, {max_depth}, {hide}: {off}");
            }
        }
    }
}

/// An atom that claims to be every lane's is wrong however continuous directions are drawn; a wrong
/// density of these matters only to those who use it.
#[test]
fn wrong_densities_are_noticed() {
    let limits = settings(5, u32::MAX, false);
    for directions in ALL {
        let stack = rainbow().with(Fault::AtomForAll);
        let z = measure(&naive(limits, directions), &stack, N).z(exact(&stack, 5, false));
        assert!(z > LIMIT, "{directions:?}: atom unnoticed: z = {z:.2}");
    }
    let stack = everything().with(Fault::OtherLanes);
    let z = |directions| measure(&naive(limits, directions), &stack, N).z(exact(&stack, 5, false));
    assert!(z(Directions::Bsdf) > LIMIT);
    assert!(z(Directions::Uniform) < LIMIT);
}
