//! Tables against the probabilities and densities they state.

use crate::evidence::{Map, chi_square};
use etalon_sampling::discrete::{
    AliasTable, Bilinear, PiecewiseConstant, PiecewiseConstant2d, PiecewiseLinear,
    SignedPiecewiseLinear, TableError,
};
use etalon_sampling::hash::{mix64, random_float};
use glam::Vec2;

/// Seeded uniform numbers.
fn numbers(count: u64, seed: u64) -> impl Iterator<Item = Vec2> {
    (0..count).map(move |i| {
        let bits = mix64(seed << 32 | i);
        Vec2::new(random_float(bits as u32), random_float((bits >> 32) as u32))
    })
}

const WEIGHTS: [f64; 9] = [3.0, 0.0, 1.0, 10.0, 0.5, 0.0, 2.0, 2.0, 0.0];

#[test]
fn alias_table_chooses_with_its_probabilities() {
    let table = AliasTable::new(&WEIGHTS).expect("weights");
    assert_eq!(table.total(), 18.5);
    assert_eq!(table.len(), 9);
    let n = 200_000;
    let expected: Vec<f64> = WEIGHTS.iter().map(|w| w / 18.5 * n as f64).collect();
    for fine in [false, true] {
        let mut counts = [0.0; 9];
        // What is left, by choice: 9 × 10 cells.
        let mut rest = vec![0.0; 90];
        for u in numbers(n, 1) {
            let choice = if fine {
                table.sample_fine(u)
            } else {
                table.sample(u.x)
            };
            assert_eq!(choice.probability, table.probability(choice.index));
            assert!(choice.probability > 0.0 && (0.0..1.0).contains(&choice.rest));
            counts[choice.index] += 1.0;
            rest[choice.index * 10 + (choice.rest * 10.0) as usize] += 1.0;
        }
        // α = 10⁻⁴ each; the mutant expects the two weights of 2.0 to be 1.9 and 2.1.
        assert!(chi_square(&counts, &expected) > 1e-4);
        let by_rest: Vec<f64> = (0..90).map(|i| expected[i / 10] / 10.0).collect();
        assert!(chi_square(&rest, &by_rest) > 1e-4);
        let mut mutant = expected.clone();
        mutant[6] *= 0.95;
        mutant[7] *= 1.05;
        assert!(chi_square(&counts, &mutant) < 1e-4);
    }
}

#[test]
fn alias_table_covers_its_columns_exactly() {
    // The share of each entry, by running through all columns on a lattice: no chance involved.
    for n in [1usize, 2, 7, 1000] {
        let weights: Vec<f64> = (0..n as u64)
            .map(|i| (mix64(i) % 1000) as f64 + 1.0)
            .collect();
        let table = AliasTable::new(&weights).expect("weights");
        let per_column = 1 << 12;
        let mut counts = vec![0u32; n];
        for i in 0..n * per_column {
            let u = (i as f64 + 0.5) / (n * per_column) as f64;
            let coarse = u as f32;
            let fine = ((u - f64::from(coarse)) * f64::from(1u32 << 24)) as f32;
            counts[table.sample_fine(Vec2::new(coarse, fine)).index] += 1;
        }
        for (i, &count) in counts.iter().enumerate() {
            let share = f64::from(count) / (n * per_column) as f64;
            let error = (share - f64::from(table.probability(i))).abs();
            // Each column that an entry appears in may be off by one lattice point.
            assert!(error < (n + 1) as f64 / (n * per_column) as f64, "{n}: {i}");
        }
    }
}

#[test]
fn piecewise_constant_inverts_and_never_chooses_nothing() {
    let table = PiecewiseConstant::new(&WEIGHTS).expect("weights");
    assert!((table.integral() - 18.5 / 9.0).abs() < 1e-12);
    let mut last = 0.0;
    for i in 0..10_000 {
        let u = f64::from(i) / 10_000.0;
        let x = table.sample(u);
        assert!((0.0..1.0).contains(&x) && x >= last);
        assert!(table.density(x) > 0.0, "{u} chose an empty cell at {x}");
        assert!((table.invert(x) - u).abs() < 1e-6);
        last = x;
    }
    let cells = WEIGHTS.len() as f64;
    let integral: f64 = (0..900)
        .map(|i| table.density((f64::from(i) + 0.5) / 900.0))
        .sum();
    assert!((integral / 900.0 - 1.0).abs() < 1e-12);
    assert!((table.density(3.5 / cells) - 10.0 / 18.5 * cells).abs() < 1e-12);
}

/// A grid with empty cells, an empty row and great contrast.
fn grid(width: usize, height: usize) -> Vec<f64> {
    (0..width * height)
        .map(|i| match (i % width, i / width) {
            (_, 2) => 0.0,
            (x, y) if (x * y) % 5 == 3 => 0.0,
            (7, 1) => 1000.0,
            (x, y) => 1.0 + (x * 3 + y) as f64,
        })
        .collect()
}

#[test]
fn piecewise_constant_grid() {
    let (width, height) = (16, 9);
    let weights = grid(width, height);
    let table = PiecewiseConstant2d::new(&weights, width).expect("weights");
    let total: f64 = weights.iter().sum();
    assert!((table.integral() * (width * height) as f64 / total - 1.0).abs() < 1e-12);
    let n = 300_000;
    let mut counts = vec![0.0; width * height];
    for u in numbers(n, 2) {
        let p = table.sample(u);
        let cell = (p.y * height as f32) as usize * width + (p.x * width as f32) as usize;
        counts[cell] += 1.0;
        let density = weights[cell] / total * (width * height) as f64;
        assert!((f64::from(table.density(p)) / density - 1.0).abs() < 1e-6);
        // Back to u, as far as a point in single precision tells.
        let error = (table.invert(p) - u).abs();
        assert!(error.x < 1e-4 && error.y < 1e-4, "{u} {p}");
    }
    let expected: Vec<f64> = weights.iter().map(|w| w / total * n as f64).collect();
    assert!(chi_square(&counts, &expected) > 1e-4, "α = 10⁻⁴");
    // Mutant: rows upside down.
    let flipped: Vec<f64> = expected.chunks(width).rev().flatten().copied().collect();
    assert!(chi_square(&counts, &flipped) < 1e-4);
}

#[test]
fn a_point_next_to_an_empty_cell_stays_out_of_it() {
    let mut weights = vec![0.0; 3000];
    weights[1] = 1.0;
    weights[2998] = 1.0;
    let table = PiecewiseConstant2d::new(&weights, 3000).expect("weights");
    let last = 1.0 - 1.0 / (1 << 24) as f32;
    for x in [0.0, 0.499_999_97, 0.5, last] {
        for y in [0.0, last] {
            let p = table.sample(Vec2::new(x, y));
            assert!(table.density(p) > 0.0, "{x} {y} {p}");
        }
    }
}

#[test]
fn bilinear_grid() {
    let nodes: Vec<f32> = grid(9, 6).iter().map(|&v| v.min(60.0) as f32).collect();
    let table = Bilinear::new(&nodes, 9).expect("nodes");
    let map = Map {
        name: "bilinear",
        sample: &|u| table.sample(u).extend(0.0),
        invert: &|p| table.invert(p.truncate()),
        density: &|p| table.density(p.truncate()),
    };
    assert!(map.round_trip_error() < 1e-3);
    // The integral of the density by the midpoint rule on a grid that the nodes are part of;
    // exact for each bilinear patch.
    let (nx, ny) = (8 * 10, 5 * 10);
    let sum: f64 = (0..nx * ny)
        .map(|i| Vec2::new((i % nx) as f32 + 0.5, (i / nx) as f32 + 0.5))
        .map(|p| f64::from(table.density(p / Vec2::new(nx as f32, ny as f32))))
        .sum();
    assert!((sum / f64::from(nx * ny) - 1.0).abs() < 1e-5);
    let n = 300_000;
    let mut counts = vec![0.0; (nx * ny) as usize];
    for u in numbers(n, 3) {
        let p = table.sample(u);
        assert!(table.density(p) > 0.0 || u.min_element() == 0.0);
        counts[(p.y * ny as f32) as usize * nx as usize + (p.x * nx as f32) as usize] += 1.0;
    }
    let expected = |density: &dyn Fn(Vec2) -> f32| -> Vec<f64> {
        (0..nx * ny)
            .map(|i| Vec2::new((i % nx) as f32 + 0.5, (i / nx) as f32 + 0.5))
            .map(|p| density(p / Vec2::new(nx as f32, ny as f32)))
            .map(|d| f64::from(d) * n as f64 / f64::from(nx * ny))
            .collect()
    };
    // α = 10⁻⁴; mutant: the density of the mean of each patch.
    assert!(chi_square(&counts, &expected(&|p| table.density(p))) > 1e-4);
    let constant = |p: Vec2| {
        let size = Vec2::new(8.0, 5.0);
        table.density(((p * size).floor() + 0.5) / size)
    };
    assert!(chi_square(&counts, &expected(&constant)) < 1e-4);
}

#[test]
fn piecewise_linear_inverts() {
    let x = [-2.0, -1.0, 0.0, 0.5, 3.0];
    let table = PiecewiseLinear::new(&x, &[0.0, 2.0, 0.0, 0.0, 1.0]).expect("points");
    assert!((table.integral() - 3.25).abs() < 1e-12);
    for i in 0..5000 {
        let u = (f64::from(i) + 0.5) / 5000.0;
        let at = table.sample(u);
        assert!((table.invert(at) - u).abs() < 1e-12);
        let slope = (table.sample(u + 1e-6) - table.sample(u - 1e-6)) / 2e-6;
        // Not across the gap between the two triangles of mass 2 and 1.25.
        if (u * 3.25 - 2.0).abs() > 0.01 && (u * 3.25 - 1.0).abs() > 0.01 && u > 0.01 {
            assert!((table.density(at) * slope - 1.0).abs() < 1e-3, "{u}");
        }
    }
    assert_eq!(table.density(-2.1), 0.0);
    assert_eq!(table.density(3.1), 0.0);
    assert_eq!(table.sample(0.0), -2.0);
}

#[test]
fn a_function_with_negative_lobes_keeps_its_integral_and_the_share_of_each_sign() {
    // cos over [−3π/2, 3π/2]: ∫ = −2, ∫|·| = 6. Crossings at ±π/2 are not nodes.
    let n = 1001;
    let at = |i: usize| (i as f64 / (n - 1) as f64 * 2.0 - 1.0) * 1.5 * core::f64::consts::PI;
    let x: Vec<f64> = (0..n).map(at).collect();
    let values: Vec<f64> = x.iter().map(|&x| etalon_math::float64::cos(x)).collect();
    let table = SignedPiecewiseLinear::new(&x, &values).expect("finite");
    assert!((table.integral() + 2.0).abs() < 1e-4);
    assert!((table.absolute_integral() - 6.0).abs() < 1e-4);
    let samples: u32 = 999;
    let mut sum = 0.0;
    let mut positive = 0u32;
    for i in 0..samples {
        let sample = table.sample((f64::from(i) + 0.5) / f64::from(samples));
        let value = etalon_math::float64::cos(sample.x);
        assert!(value * sample.sign > 0.0);
        let density = value.abs() / 6.0;
        assert!((table.density(sample.x) - density).abs() < 1e-5);
        positive += u32::from(sample.sign > 0.0);
        sum += sample.sign * table.absolute_integral();
    }
    // A third is positive: exactly, since the numbers are stratified.
    assert_eq!(positive, 333);
    assert!((sum / f64::from(samples) + 2.0).abs() < 1e-3);
    // One sign alone.
    let negative = SignedPiecewiseLinear::new(&[0.0, 1.0], &[-1.0, -2.0]).expect("finite");
    assert_eq!(negative.sample(0.0).sign, -1.0);
    assert!((negative.sample(1.0 - 1e-15).x - 1.0).abs() < 1e-12);
}

#[test]
fn bad_tables_are_refused() {
    let nan = f64::NAN;
    assert_eq!(AliasTable::new(&[0.0]).err(), Some(TableError::Zero));
    assert!(matches!(
        AliasTable::new(&[1.0, -1.0]),
        Err(TableError::BadEntry { index: 1, .. })
    ));
    assert!(PiecewiseConstant::new(&[]).is_err());
    assert!(PiecewiseConstant::new(&[nan]).is_err());
    assert_eq!(
        PiecewiseConstant::new(&[f64::MAX, f64::MAX]).err(),
        Some(TableError::Overflow)
    );
    assert!(AliasTable::new(&[f64::MAX, f64::MAX]).is_ok());
    assert!(PiecewiseConstant2d::new(&[1.0, 2.0, 3.0], 2).is_err());
    assert!(PiecewiseConstant2d::new(&[1.0], 0).is_err());
    assert!(Bilinear::new(&[1.0, 1.0], 2).is_err());
    assert!(Bilinear::new(&[0.0; 4], 2).is_err());
    assert!(PiecewiseLinear::new(&[0.0, 0.0], &[1.0, 1.0]).is_err());
    assert!(PiecewiseLinear::new(&[0.0, nan], &[1.0, 1.0]).is_err());
    assert!(PiecewiseLinear::new(&[0.0], &[1.0, 1.0]).is_err());
    assert!(SignedPiecewiseLinear::new(&[0.0, 1.0], &[0.0, 0.0]).is_err());
    assert!(SignedPiecewiseLinear::new(&[0.0, 1.0], &[nan, 0.0]).is_err());
    let message = AliasTable::new(&[1.0, nan])
        .expect_err("not a number")
        .to_string();
    assert!(
        message.contains("entry 1") && message.contains("NaN"),
        "{message}"
    );
}
