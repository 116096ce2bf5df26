//! Error rates of the tests under their hypotheses, and the faults they catch.

use crate::checks::Random;
use etalon_statistics::chi_squared::goodness_of_fit;
use etalon_statistics::{
    Estimate, Replicates, Summary, TileDifferences, TilesError, Verdict, proportion,
};

/// An image of 16 tiles that depend on each other strongly: one common error per replicate.
fn image(random: &mut Random, replicates: usize, energy: f64) -> Vec<f64> {
    let mut means = Vec::new();
    for _ in 0..replicates {
        let common = random.normal();
        for tile in 0..16 {
            let noise = 0.01 * (0.8 * common + 0.6 * random.normal());
            means.push(energy * (1.0 + 0.1 * f64::from(tile)) * (1.0 + noise));
        }
    }
    means
}

fn compare(a: &[f64], b: &[f64]) -> TileDifferences {
    let a = Replicates::new(a, 16).expect("well-formed");
    let b = Replicates::new(b, 16).expect("well-formed");
    TileDifferences::between(&a, &b).expect("same tiles")
}

/// α = 0.05 for each run; 2,000 runs. Holm's bound must hold under dependence: the share of
/// false alarms lies below 0.05 with an exact 99.9 % interval.
#[test]
fn equal_images_rarely_differ() {
    let mut random = Random(1);
    let alarms = (0..2000)
        .filter(|_| {
            let (a, b) = (image(&mut random, 8, 1.0), image(&mut random, 6, 1.0));
            compare(&a, &b).decide(&[0.0; 16], 0.05).verdict == Verdict::Differs
        })
        .count();
    let share = proportion::interval(alarms as u64, 2000, 0.999).expect("trials");
    assert!(share.low <= 0.05, "{alarms} of 2000");
    assert!(alarms > 0, "a test that never rejects proves nothing");
}

/// Mutant: energy × 1.02, in one image, is caught each time in 50 runs at α = 10⁻³.
#[test]
fn two_per_cent_are_caught() {
    let mut random = Random(2);
    for _ in 0..50 {
        let (a, b) = (image(&mut random, 32, 1.02), image(&mut random, 32, 1.0));
        let decision = compare(&a, &b).decide(&[0.0; 16], 1e-3);
        assert_eq!(decision.verdict, Verdict::Differs);
        assert!(decision.differing(1e-3).count() >= 1);
        assert_eq!(decision.p_differs, decision.adjusted[decision.worst]);
    }
}

/// A bias at the very edge of the tolerance is certified as agreement with probability at most
/// α = 0.05 (2,000 runs, 99.9 % interval). With 64 replicates a tile's standard error is
/// 0.01 · √(2/64) = 0.0018 of its mean, so an unbiased tile is certified within 1 % unless its
/// error exceeds 0.01 − 1.66 · 0.0018 = 0.007, four standard errors: nearly always.
#[test]
fn agreement_is_not_given_away() {
    let mut random = Random(3);
    let tolerances: Vec<f64> = (0..16).map(|t| 0.01 * (1.0 + 0.1 * f64::from(t))).collect();
    let mut agreements = |energy: f64| {
        (0..2000)
            .filter(|_| {
                let (a, b) = (image(&mut random, 64, energy), image(&mut random, 64, 1.0));
                compare(&a, &b).decide(&tolerances, 0.05).verdict == Verdict::Agrees
            })
            .count() as u64
    };
    let edge = proportion::interval(agreements(1.01), 2000, 0.999).expect("trials");
    assert!(edge.low <= 0.05, "{edge:?}");
    let centre = proportion::interval(agreements(1.0), 2000, 0.999).expect("trials");
    assert!(centre.low >= 0.99, "{centre:?}");
}

/// The p-values of Welch's test on normal samples are uniform (χ² of twenty bins, α = 10⁻³),
/// and intervals of 68, 95 and 99 % cover at their rate (exact 99.9 % intervals). Mutant: a
/// standard error off by √2 is rejected by both.
#[test]
fn welch_is_calibrated() {
    let mut random = Random(4);
    let mut estimates: Vec<Estimate> = Vec::new();
    for _ in 0..4000 {
        let mut sample = |n: usize| (0..n).map(|_| random.normal()).collect::<Vec<_>>();
        let (a, b) = (sample(9), sample(9));
        let summary = |s: &[f64]| Summary::of(s).expect("finite");
        estimates.push(Estimate::welch(&summary(&a), &summary(&b)));
    }
    let p_value = |scale: f64| {
        let p: Vec<f64> = estimates
            .iter()
            .map(|e| {
                Estimate::new(
                    e.value(),
                    e.standard_error() * scale,
                    e.degrees_of_freedom(),
                )
                .expect("finite")
                .p_differs(0.0)
            })
            .collect();
        let mut bins = [0; 20];
        for p in p {
            bins[((20.0 * p) as usize).min(19)] += 1;
        }
        let fit = goodness_of_fit(&bins, &[200.0; 20]).expect("counts");
        fit.p_value
    };
    assert!(p_value(1.0) > 1e-3);
    assert!(p_value(std::f64::consts::SQRT_2) < 1e-12);

    for confidence in [0.68, 0.95, 0.99] {
        let covered = estimates
            .iter()
            .filter(|e| e.interval(confidence).contains(0.0))
            .count();
        let share = proportion::interval(covered as u64, 4000, 0.999).expect("trials");
        assert!(share.contains(confidence), "{confidence}: {share:?}");
    }
}

/// Counts of 4,096 points in a 16 × 8 grid whose cells have quite different probabilities:
/// α = 0.01 alarms in 1 % of 2,000 runs (exact 99.9 % interval). Mutant: a density off by the
/// factors 1.25 and 0.75 in alternate columns, normalised (non-centrality 4096 · 0.25² = 256
/// against some 100 ± 14), is rejected at 10⁻³ in all of 20 runs.
#[test]
fn the_grid_test_is_calibrated() {
    let density = |column: usize, row: usize| (1.0 + column as f64).powi(2) * (0.1 + row as f64);
    let cells: Vec<_> = (0..128).map(|i| (i % 16, i / 16)).collect();
    let total: f64 = cells.iter().map(|&(x, y)| density(x, y)).sum();
    let tilt = |x: usize| if x.is_multiple_of(2) { 1.25 } else { 0.75 };
    let wrong: f64 = cells.iter().map(|&(x, y)| density(x, y) * tilt(x)).sum();
    let right_counts: Vec<_> = cells
        .iter()
        .map(|&(x, y)| 4096.0 * density(x, y) / total)
        .collect();
    let wrong_counts: Vec<_> = cells
        .iter()
        .map(|&(x, y)| 4096.0 * density(x, y) * tilt(x) / wrong)
        .collect();
    let mut random = Random(6);
    let mut draw = || {
        let mut counts = vec![0_u64; 128];
        for _ in 0..4096 {
            let mut left = random.uniform() * 4096.0;
            let cell = right_counts
                .iter()
                .position(|&count| {
                    left -= count;
                    left < 0.0
                })
                .unwrap_or(127);
            counts[cell] += 1;
        }
        counts
    };
    let p_value = |counts: &[u64], expected: &[f64]| {
        goodness_of_fit(counts, expected).expect("testable").p_value
    };
    let alarms = (0..2000)
        .filter(|_| p_value(&draw(), &right_counts) <= 0.01)
        .count();
    let share = proportion::interval(alarms as u64, 2000, 0.999).expect("trials");
    assert!(share.contains(0.01), "{alarms} of 2000");
    for _ in 0..20 {
        assert!(p_value(&draw(), &wrong_counts) < 1e-3);
    }
}

#[test]
fn known_values_are_a_reference_too() {
    let mut random = Random(5);
    let image = image(&mut random, 16, 1.0);
    let replicates = Replicates::new(&image, 16).expect("well-formed");
    let truth: Vec<f64> = (0..16).map(|t| 1.0 + 0.1 * f64::from(t)).collect();
    let right = TileDifferences::from_known(&replicates, &truth).expect("same tiles");
    assert_ne!(right.decide(&[0.0; 16], 1e-3).verdict, Verdict::Differs);
    let wrong: Vec<f64> = truth.iter().map(|x| x * 1.05).collect();
    let wrong = TileDifferences::from_known(&replicates, &wrong).expect("same tiles");
    assert_eq!(wrong.decide(&[0.0; 16], 1e-3).verdict, Verdict::Differs);
    // The same as the greatest of the tiles' own.
    let each = wrong
        .estimates()
        .iter()
        .map(|estimate| estimate.smallest_detectable(1e-3 / 16.0, 0.9));
    let greatest = each.fold(0.0, f64::max);
    assert_eq!(wrong.smallest_detectable(1e-3, 0.9), greatest);
    assert!(greatest > 0.0);
    assert!(wrong.smallest_detectable(0.9, 1e-3).is_nan());
    assert_eq!(wrong.estimates().len(), 16);
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let means = [1.0; 12];
    assert!(Replicates::new(&means, 4).is_ok());
    for (tiles, expected) in [
        (
            5,
            TilesError::BadShape {
                means: 12,
                tiles: 5,
            },
        ),
        (
            0,
            TilesError::BadShape {
                means: 12,
                tiles: 0,
            },
        ),
        (12, TilesError::TooFewReplicates { replicates: 1 }),
    ] {
        assert_eq!(Replicates::new(&means, tiles).err(), Some(expected));
    }
    let broken = [1.0, 2.0, 3.0, f64::NAN];
    assert_eq!(
        Replicates::new(&broken, 2).err(),
        Some(TilesError::NotFinite {
            replicate: 1,
            tile: 1
        })
    );
    let (a, b) = (
        Replicates::new(&means, 4).expect("well-formed"),
        Replicates::new(&means, 3).expect("well-formed"),
    );
    assert!(TileDifferences::between(&a, &b).is_err());
    assert!(TileDifferences::from_known(&a, &[1.0]).is_err());
}
