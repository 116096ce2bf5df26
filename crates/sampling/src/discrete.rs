//! Distributions given by tables: discrete choices, and densities that are constant or linear
//! between the entries of a table.
//!
//! Tables are in double precision, so that a sum over millions of texels is as exact as one
//! over three. Every table has the density (or probability) of its samples, and the inverse of
//! its map.

mod alias;
mod bilinear;
mod piecewise_constant;
mod piecewise_constant_2d;
mod piecewise_linear;
mod quadtree;
mod signed;

pub use alias::{AliasTable, Choice};
pub use bilinear::Bilinear;
pub use piecewise_constant::PiecewiseConstant;
pub use piecewise_constant_2d::PiecewiseConstant2d;
pub use piecewise_linear::PiecewiseLinear;
pub use quadtree::{Quadtree, Refinement};
pub use signed::{SignedPiecewiseLinear, SignedSample};

use core::fmt;

/// Why a table is not a distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableError {
    /// There are too few entries.
    TooShort {
        /// Number of entries.
        entries: usize,
        /// The least number.
        needed: usize,
    },
    /// The number of entries is not what the shape of the table says.
    WrongShape {
        /// Number of entries.
        entries: usize,
        /// The number that the shape needs.
        needed: usize,
    },
    /// An entry is negative, infinite or not a number.
    BadEntry {
        /// Its index.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// Abscissae do not increase.
    NotIncreasing {
        /// The first abscissa that is not above its predecessor.
        index: usize,
    },
    /// All entries vanish.
    Zero,
    /// The sum of the entries is beyond double precision.
    Overflow,
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::TooShort { entries, needed } => {
                write!(f, "the table has {entries} entries, {needed} are needed")
            }
            Self::WrongShape { entries, needed } => {
                write!(
                    f,
                    "the table has {entries} entries, its shape asks for {needed}"
                )
            }
            Self::BadEntry { index, value } => write!(
                f,
                "entry {index} of the table is {value}; entries must be finite and not negative"
            ),
            Self::NotIncreasing { index } => {
                write!(
                    f,
                    "abscissa {index} of the table is not above the one before it"
                )
            }
            Self::Zero => write!(f, "all entries of the table are zero"),
            Self::Overflow => write!(f, "the sum of the entries of the table overflows"),
        }
    }
}

impl core::error::Error for TableError {}

/// Refuses tables with fewer than `needed` entries, or entries that are no weights.
fn check_weights(weights: &[f64], needed: usize) -> Result<(), TableError> {
    if weights.len() < needed {
        return Err(TableError::TooShort {
            entries: weights.len(),
            needed,
        });
    }
    match weights.iter().position(|&w| !(w >= 0.0 && w.is_finite())) {
        Some(index) => Err(TableError::BadEntry {
            index,
            value: weights[index],
        }),
        None => Ok(()),
    }
}

/// The cell of an increasing table of sums, from 0 to 1, in which `u` falls. Cells of no
/// width are never chosen.
#[inline]
fn cell_of(sums: &[f64], u: f64) -> usize {
    let last = sums.len() - 2;
    let cell = sums[1..=last].partition_point(|&sum| sum <= u);
    debug_assert!(cell <= last);
    cell
}

/// Running sums of `weights`, from 0 to exactly 1, with the total. Final cells of no weight
/// begin at 1, so that `cell_of` cannot choose them for u < 1.
fn normalised_sums(weights: &[f64]) -> Result<(Vec<f64>, f64), TableError> {
    let mut sums = Vec::with_capacity(weights.len() + 1);
    let mut total = 0.0;
    sums.push(0.0);
    for weight in weights {
        total += weight;
        sums.push(total);
    }
    if total == 0.0 {
        return Err(TableError::Zero);
    }
    if !total.is_finite() {
        return Err(TableError::Overflow);
    }
    for sum in &mut sums {
        *sum /= total;
    }
    Ok((sums, total))
}
