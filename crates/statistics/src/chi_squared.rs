//! Pearson's χ² test of counts against expected counts, with pooled cells.
//!
//! χ² = Σ (oᵢ − eᵢ)² / eᵢ is χ²-distributed with (cells − 1) degrees of freedom where every eᵢ is
//! large enough; Cochran's rule, eᵢ ≥ 5, is met by pooling the smallest cells, chosen by expected
//! and never by observed counts.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// No cell that is tested expects less than this.
pub const LEAST_EXPECTED: f64 = 5.0;

/// How far the expected counts may add up to more than was observed, relatively: the error of
/// the quadrature they may come from.
const QUADRATURE: f64 = 1e-4;

/// The probability that a χ² number with these degrees of freedom exceeds `x`; NaN for a NaN or
/// for degrees of freedom that are not positive.
#[must_use]
pub fn sf(x: f64, degrees_of_freedom: f64) -> f64 {
    if x.is_nan() {
        return f64::NAN;
    }
    if x <= 0.0 {
        return 1.0;
    }
    if x.is_infinite() {
        return 0.0;
    }
    ChiSquared::new(degrees_of_freedom).map_or(f64::NAN, |chi| chi.sf(x))
}

/// The outcome of [`goodness_of_fit`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiSquaredTest {
    /// Pearson's statistic; infinite if something impossible was observed.
    pub statistic: f64,
    /// Cells after pooling, less one.
    pub degrees_of_freedom: f64,
    /// Cells after pooling.
    pub cells: usize,
    /// The probability of a statistic at least this large under the hypothesis.
    pub p_value: f64,
}

/// Why counts could not be tested.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CountsError {
    /// There are not as many expected counts as observed ones.
    UnequalLengths {
        /// Cells observed.
        observed: usize,
        /// Cells expected.
        expected: usize,
    },
    /// An expected count is negative, infinite or not a number.
    BadExpectation {
        /// The cell.
        cell: usize,
        /// What it expects.
        expected: f64,
    },
    /// More is expected altogether than was observed, so the expectations cannot be
    /// probabilities times the number of observations.
    TooMuchExpected {
        /// Observations.
        observed: f64,
        /// The sum of the expected counts.
        expected: f64,
    },
    /// Fewer than two cells are left after pooling: there are too few observations, or no choice.
    TooFewCells,
}

impl std::fmt::Display for CountsError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::UnequalLengths { observed, expected } => {
                write!(f, "{observed} cells observed, but {expected} expected")
            }
            Self::BadExpectation { cell, expected } => {
                write!(f, "cell {cell} expects {expected} observations")
            }
            Self::TooMuchExpected { observed, expected } => write!(
                f,
                "{expected} observations expected altogether, but only {observed} made"
            ),
            Self::TooFewCells => f.write_str("fewer than two cells are left after pooling"),
        }
    }
}

impl std::error::Error for CountsError {}

/// Tests whether observed counts follow the expected ones, `expected[i]` = N · pᵢ with N the sum
/// of `observed`.
///
/// If less is expected than observed (a density that does not integrate to one), what is missing
/// counts as one more cell, in which nothing was observed.
///
/// # Errors
/// [`CountsError`] where the counts cannot be tested.
pub fn goodness_of_fit(observed: &[u64], expected: &[f64]) -> Result<ChiSquaredTest, CountsError> {
    if observed.len() != expected.len() {
        return Err(CountsError::UnequalLengths {
            observed: observed.len(),
            expected: expected.len(),
        });
    }
    if let Some(cell) = expected.iter().position(|&e| !e.is_finite() || e < 0.0) {
        return Err(CountsError::BadExpectation {
            cell,
            expected: expected[cell],
        });
    }
    let trials: f64 = observed.iter().map(|&o| o as f64).sum();
    let foreseen: f64 = expected.iter().sum();
    if foreseen > trials * (1.0 + QUADRATURE) {
        return Err(CountsError::TooMuchExpected {
            observed: trials,
            expected: foreseen,
        });
    }

    let mut cells: Vec<(f64, f64)> = observed
        .iter()
        .zip(expected)
        .map(|(&o, &e)| (o as f64, e))
        .collect();
    cells.push((0.0, (trials - foreseen).max(0.0)));
    if cells.iter().any(|&(o, e)| e == 0.0 && o > 0.0) {
        return Ok(ChiSquaredTest {
            statistic: f64::INFINITY,
            degrees_of_freedom: cells.len() as f64 - 1.0,
            cells: cells.len(),
            p_value: 0.0,
        });
    }
    pool(&mut cells);
    if cells.len() < 2 {
        return Err(CountsError::TooFewCells);
    }
    let statistic = cells.iter().map(|(o, e)| (o - e) * (o - e) / e).sum();
    let degrees_of_freedom = cells.len() as f64 - 1.0;
    Ok(ChiSquaredTest {
        statistic,
        degrees_of_freedom,
        cells: cells.len(),
        p_value: sf(statistic, degrees_of_freedom),
    })
}

/// Unites the cells that expect least until each that is left expects enough.
fn pool(cells: &mut Vec<(f64, f64)>) {
    cells.retain(|&(_, e)| e > 0.0);
    cells.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut pooled = (0.0, 0.0);
    let mut taken = 0;
    for &(o, e) in cells.iter() {
        if e >= LEAST_EXPECTED && (taken == 0 || pooled.1 >= LEAST_EXPECTED) {
            break;
        }
        pooled = (pooled.0 + o, pooled.1 + e);
        taken += 1;
    }
    if taken > 0 {
        cells.splice(..taken, (pooled.1 >= LEAST_EXPECTED).then_some(pooled));
    }
}
