//! Quadtrees that have learned: what they sample follows what they state.

use crate::evidence::chi_square;
use etalon_sampling::discrete::{Quadtree, Refinement};
use etalon_sampling::hash::{mix64, random_float};
use glam::Vec2;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn numbers(count: u64, seed: u64) -> impl Iterator<Item = Vec2> {
    (0..count).map(move |i| {
        let bits = mix64(seed << 32 | i);
        Vec2::new(random_float(bits as u32), random_float((bits >> 32) as u32))
    })
}

const FINE: Refinement = Refinement {
    share: 0.01,
    depth: 7,
};

/// Learns the function `f` of the square in some rounds, without noise at the leaves' centres.
fn learn(f: impl Fn(Vec2) -> f64, rounds: u32, refinement: Refinement) -> Quadtree {
    let mut tree = Quadtree::uniform();
    for round in 0..rounds {
        let mut mass = vec![0.0; tree.slots()];
        for at in numbers(20_000, u64::from(round)) {
            tree.spread(at, |slot, part| mass[slot] += f64::from(part) * f(at));
        }
        tree = tree.learned(|slot| mass[slot], refinement).expect("mass");
    }
    tree
}

/// A narrow peak, an empty quarter, and little elsewhere.
fn peak(at: Vec2) -> f64 {
    let empty = at.x > 0.5 && at.y < 0.5;
    if empty {
        return 0.0;
    }
    let d = f64::from(at.distance(Vec2::new(0.3, 0.9)));
    1.0 / (1e-3 + d * d)
}

const GRID: usize = 128;

/// The probability of each cell of a grid whose cells lie within the leaves.
fn probabilities(tree: &Quadtree) -> Vec<f64> {
    let cell = |i: usize| {
        let at = (Vec2::new((i % GRID) as f32, (i / GRID) as f32) + 0.5) / GRID as f32;
        f64::from(tree.density(at)) / (GRID * GRID) as f64
    };
    (0..GRID * GRID).map(cell).collect()
}

#[test]
fn samples_follow_the_density() {
    let tree = learn(peak, 5, FINE);
    assert!(tree.slots() > 150, "{} slots", tree.slots());
    let n = 400_000_u64;
    let mut counts = vec![0.0; GRID * GRID];
    for u in numbers(n, 77) {
        let (at, density) = tree.sample(u);
        assert!(density > 0.0 && at.min_element() >= 0.0 && at.max_element() < 1.0);
        assert_eq!(density, tree.density(at), "at {at}");
        let cell = (at * GRID as f32).as_usizevec2();
        counts[cell.y * GRID + cell.x] += 1.0;
    }
    let expected = probabilities(&tree);
    let expected: Vec<f64> = expected.iter().map(|p| p * n as f64).collect();
    // α = 10⁻⁴. The mutant takes a twentieth from the upper left quadrant for the lower left.
    assert!(chi_square(&counts, &expected) > 1e-4);
    let quarter = |upper: bool| {
        let inside = |i: &usize| i % GRID < GRID / 2 && (i / GRID >= GRID / 2) == upper;
        (0..GRID * GRID)
            .filter(inside)
            .map(|i| expected[i])
            .sum::<f64>()
    };
    let (lower, upper) = (quarter(false), quarter(true));
    let mutant = |(i, e): (usize, &f64)| match (i % GRID < GRID / 2, i / GRID < GRID / 2) {
        (true, false) => 0.95 * e,
        (true, true) => e * (1.0 + 0.05 * upper / lower),
        _ => *e,
    };
    let mutant: Vec<f64> = expected.iter().enumerate().map(mutant).collect();
    assert!(chi_square(&counts, &mutant) < 1e-4);
}

#[test]
fn it_learns_where_the_mass_is() {
    let tree = learn(peak, 6, FINE);
    // The empty quarter keeps at most what the filter spreads over its border.
    assert!(tree.density(Vec2::new(0.9, 0.1)) < 0.1);
    let peak_density = tree.density(Vec2::new(0.3, 0.9));
    assert!(peak_density > 50.0, "{peak_density}");
    // Where there is no mass any more leaves are merged: those of the peak, if all is elsewhere.
    let mut elsewhere = 0;
    tree.spread(Vec2::new(0.8, 0.2), |slot, _| elsewhere = slot);
    let nothing_is_large = Refinement { share: 2.0, ..FINE };
    let mass = |slot| f64::from(u8::from(slot == elsewhere));
    let moved = tree.learned(mass, nothing_is_large).expect("mass");
    assert_eq!(moved.density(Vec2::new(0.3, 0.9)), 0.0);
    assert!(moved.density(Vec2::new(0.8, 0.2)) > 1.0);
    assert_eq!(moved.slots(), 4);
    // And where all the mass is they are divided anew.
    let moved = tree.learned(mass, FINE).expect("mass");
    assert_eq!(moved.density(Vec2::new(0.8, 0.2)), 4.0);
    assert!(moved.slots() > 4);
    assert_eq!(tree.learned(|_| 0.0, FINE), None);
    assert_eq!(tree.learned(|_| f64::NAN, FINE), None);
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 40,
        rng_seed: RngSeed::Fixed(11),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Whatever the masses: densities integrate to one, samples have positive density, and mass that
    /// is spread is neither lost nor made.
    #[test]
    fn any_masses_make_a_density(
        masses in prop::collection::vec(prop_oneof![Just(0.0), 1e-12..1e12_f64], 4..64),
        share in 1e-4..0.9_f64,
        depth in 1..9_u32,
    ) {
        let refinement = Refinement { share, depth };
        let mut tree = Quadtree::uniform();
        for round in 0..4 {
            let Some(next) =
                tree.learned(|slot| masses[(slot + round) % masses.len()], refinement)
            else {
                return Ok(());
            };
            tree = next;
        }
        let n = 256;
        let sum: f64 = (0..n * n)
            .map(|i| (Vec2::new((i % n) as f32, (i / n) as f32) + 0.5) / n as f32)
            .map(|at| f64::from(tree.density(at)))
            .sum();
        prop_assert!((sum / f64::from(n * n) - 1.0).abs() < 1e-5, "{sum}");
        for u in numbers(200, 5) {
            let (at, density) = tree.sample(u);
            prop_assert!(density > 0.0);
            prop_assert_eq!(density, tree.density(at));
            let mut spread = 0.0;
            tree.spread(u, |_, part| spread += part);
            prop_assert!((spread - 1.0).abs() < 1e-4, "{}", spread);
        }
    }
}
