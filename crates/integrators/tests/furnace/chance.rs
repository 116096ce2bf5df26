//! Estimators that leave something to chance: lights that are run into, an aperture that is hit.

use crate::world::{Fault, Sphere};
use crate::{LIMIT, N, series, settings, z_score};
use etalon_integrators::forward::Forward;
use etalon_integrators::naive::{Directions, Naive};

const ALL: [Directions; 3] = [Directions::Bsdf, Directions::Cosine, Directions::Uniform];

fn naive(max_depth: u32, directions: Directions) -> Naive {
    Naive {
        settings: settings(max_depth),
        directions,
    }
}

fn forward(max_depth: u32) -> Forward {
    Forward {
        settings: settings(max_depth),
    }
}

/// Nine comparisons at a family-wise α of 10⁻³. The sphere's model does not say that it reflects
/// only, so that directions are drawn from the whole sphere.
#[test]
fn chance_agrees_with_the_geometric_series() {
    let world = Sphere::new(0.6, Fault::None);
    for directions in ALL {
        for (segments, expected) in [(3, series(0.6, 3)), (u32::MAX, 2.5)] {
            let z = z_score(&naive(segments, directions), &world, expected, N);
            assert!(z.abs() < LIMIT, "{directions:?}, {segments}: z = {z:.2}");
        }
    }
    for (segments, expected) in [(1, 1.0), (3, series(0.6, 3)), (u32::MAX, 2.5)] {
        let z = z_score(&forward(segments), &world, expected, N);
        assert!(z.abs() < LIMIT, "forward, {segments}: z = {z:.2}");
    }
}

/// A cosine forgotten in the density of scattering, light that is too strong, a reception without
/// the cosine of arrival.
#[test]
fn faults_are_noticed_by_chance() {
    let world = |fault| Sphere::new(0.6, fault);
    let expected = series(0.6, 3);
    let bsdf = naive(3, Directions::Bsdf);
    for fault in [Fault::ScatteringDensity, Fault::Emission] {
        let z = z_score(&bsdf, &world(fault), expected, N);
        let number = fault as u32;
        assert!(z.abs() > LIMIT, "fault {number} unnoticed: z = {z:.2}");
    }
    let z = z_score(&forward(3), &world(Fault::Importance), expected, N);
    assert!(z.abs() > LIMIT, "reception without cosine: z = {z:.2}");
    // These ask the model for no density.
    let z = z_score(
        &naive(3, Directions::Cosine),
        &world(Fault::ScatteringDensity),
        expected,
        N,
    );
    assert!(z.abs() < LIMIT, "cosine: z = {z:.2}");
}
