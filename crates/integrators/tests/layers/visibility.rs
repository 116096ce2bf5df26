//! Hidden lights, and how much of a pixel is covered.

use crate::exact::Exact;
use crate::measure::{LIMIT, measure};
use crate::world::{Plane, Stack, ZERO};
use etalon_integrators::direct::Direct;
use etalon_integrators::path::Path;
use etalon_integrators::ptracer::ParticleTracer;
use etalon_integrators::settings::{LightCandidates, PathSettings};

const N: u32 = 40_000;

fn path(max_depth: u32) -> Path {
    Path {
        settings: PathSettings {
            max_depth,
            rr_depth: 5,
            hide_emitters: true,
        },
        ..Path::default()
    }
}

/// A veil below a lamp below a veil below the sky, over a floor.
fn veils() -> Stack {
    let veil = |height| Plane {
        height,
        passing: |_| 0.5,
        ..Plane::WHITE
    };
    let lamp = Plane {
        height: 2.0,
        emission: [|_| 3.0, |_| 1.0],
        passing: |_| 0.2,
        ..Plane::WHITE
    };
    let planes = vec![Plane::WHITE, veil(1.0), lamp, veil(3.0)];
    Stack::new(planes, |_| 0.7, 0.5, true)
}

#[test]
fn hidden_lights_are_seen_by_everything_but_the_camera() {
    for (height, up) in [
        (0.5, true),
        (1.5, true),
        (2.5, false),
        (3.5, false),
        (2.5, true),
    ] {
        for max_depth in [1, 2, 3, 80] {
            let mut stack = veils();
            (stack.camera.height, stack.camera.up) = (height, up);
            let exact = |hidden| {
                Exact {
                    stack: &stack,
                    max_depth,
                    hidden,
                }
                .colour()
            };
            let found = measure(&path(max_depth), &stack, N);
            let z = found.z(exact(true));
            assert!(z < LIMIT, "from {height}, depth {max_depth}: z = {z:.2}");
            // Showing them instead would be noticed wherever it matters.
            let shown = exact(false);
            if (exact(true)[1] - shown[1]).abs() > 0.2 * shown[1] {
                let z = found.z(shown);
                assert!(z > LIMIT, "from {height}, depth {max_depth}: z = {z:.2}");
            }
        }
    }
}

/// Two veils before nothing: a path is stopped unless it passes both.
#[test]
fn alpha_is_what_does_not_go_straight_through() {
    let veil = |height| Plane {
        height,
        passing: |_| 0.5,
        ..Plane::BLACK
    };
    let alpha = |sky, hide_emitters| {
        let stack = Stack::new(vec![veil(1.0), veil(2.0)], sky, 0.0, true);
        let settings = PathSettings {
            hide_emitters,
            ..PathSettings::default()
        };
        measure(
            &Path {
                settings,
                ..Path::default()
            },
            &stack,
            N,
        )
        .mean[3]
    };
    // Standard deviation √(0.75 · 0.25 / N); α = 10⁻⁶ two-sided.
    let tolerance = 4.9 * (0.1875 / f64::from(N)).sqrt();
    assert!((alpha(ZERO, false) - 0.75).abs() < tolerance);
    // However long paths may be, as long as they reach the second veil.
    for (max_depth, expected) in [(0, 0.0), (1, 0.5), (2, 0.75), (3, 0.75)] {
        let stack = Stack::new(vec![veil(1.0), veil(2.0)], ZERO, 0.0, true);
        let found = measure(&path(max_depth), &stack, N).mean[3];
        assert!((found - expected).abs() < tolerance, "{max_depth}: {found}");
    }
    assert!((alpha(|_| 1.0, true) - 0.75).abs() < tolerance);
    assert_eq!(alpha(|_| 1.0, false), 1.0);

    let direct = Direct {
        max_depth: u32::MAX,
        emitter_samples: 1,
        bsdf_samples: 1,
        hide_emitters: false,
        light_candidates: LightCandidates::default(),
    };
    let seen = Stack::new(vec![veil(1.0)], |_| 1.0, 0.0, true);
    assert_eq!(measure(&direct, &seen, 100).mean[3], 1.0);
    let missed = Stack::new(vec![veil(1.0)], |_| 1.0, 0.0, false);
    assert_eq!(measure(&direct, &missed, 100).mean[3], 0.0);
}

/// No particle leaves the lights of this world, so that light tracing shows what it sees itself.
#[test]
fn light_tracing_sees_lights_through_veils() {
    for hide_emitters in [false, true] {
        for max_depth in [0, 1, 2, 3, 4, 9] {
            let mut stack = veils();
            stack.planes.iter_mut().for_each(|p| p.reflectance = ZERO);
            let exact = Exact {
                stack: &stack,
                max_depth,
                hidden: hide_emitters,
            };
            let settings = PathSettings {
                max_depth,
                hide_emitters,
                ..PathSettings::default()
            };
            let found = measure(&ParticleTracer { settings }, &stack, N);
            let z = found.z(exact.colour());
            assert!(
                z < LIMIT,
                "hidden {hide_emitters}, depth {max_depth}: z = {z:.2}"
            );
            let passed = [1.0, 0.5, 0.1, 0.05]
                .into_iter()
                .chain(std::iter::repeat(0.05));
            let through = passed.take(max_depth as usize + 1).last().unwrap_or(1.0);
            let sky = max_depth >= 4 && !hide_emitters;
            let alpha = if sky { 1.0 } else { 1.0 - through };
            assert!((found.mean[3] - alpha).abs() < 1e-6, "{}", found.mean[3]);
        }
    }
}
