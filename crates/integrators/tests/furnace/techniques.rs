//! The techniques of bidirectional path tracing, one by one.
//!
//! In the glowing sphere paths of n segments bring the radiance ρⁿ⁻¹. A technique with s vertices
//! from the light and t from the camera makes all paths of s + t − 1 segments, unless it is s = 1,
//! t = 1, which is left to s = 0. So each alone, unweighted, must find ρ^(s+t−2).

use crate::world::{Fault, Sphere};
use crate::{settings, z_score};
use etalon_integrators::bdpt::{Bidirectional, Technique};

const REFLECTANCE: f32 = 0.6;

/// Techniques of up to five segments: 19 of them.
fn techniques() -> impl Iterator<Item = [usize; 2]> {
    let all = (2..=6).flat_map(|n| (0..n).map(move |light| [light, n - light]));
    all.filter(|technique| *technique != [1, 1])
}

fn z_of([light, camera]: [usize; 2], fault: Fault) -> f64 {
    let integrator = Bidirectional {
        settings: settings(5),
        only: Some(Technique {
            light,
            camera,
            weighted: false,
        }),
    };
    let world = Sphere::new(REFLECTANCE, fault);
    let expected = f64::from(REFLECTANCE).powi((light + camera - 2) as i32);
    z_score(&integrator, &world, expected, N)
}

/// 19 comparisons at a family-wise α of 10⁻³ (two-sided normal quantile of 10⁻³/19 ≈ 4.04).
const LIMIT: f64 = 4.04;
const N: u32 = 60_000;

#[test]
fn each_technique_alone_finds_all_paths_of_its_length() {
    for technique in techniques() {
        let z = z_of(technique, Fault::None);
        assert!(z.abs() < LIMIT, "s, t = {technique:?}: z = {z:.2}");
    }
}

#[test]
fn a_fault_shows_in_the_techniques_that_it_touches() {
    // Mutant: a camera whose importance lacks a cosine. Only t = 1 connects with the camera.
    for technique in techniques() {
        let z = z_of(technique, Fault::Importance);
        let found = z.abs() > LIMIT;
        assert_eq!(found, technique[1] == 1, "s, t = {technique:?}: z = {z:.2}");
    }
}
