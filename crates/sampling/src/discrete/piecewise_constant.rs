//! A density on [0, 1] that is constant in each of n equal cells, sampled by inverting its
//! cumulative sums.
//!
//! Unlike the alias method the map is monotonic: stratified numbers give stratified points.

use super::{TableError, cell_of, check_weights, normalised_sums};

/// The greatest place within a cell: below 1 by enough that adding the number of the cell, of up
/// to 2²⁸ cells, does not round up into the next.
const LAST_PLACE: f64 = 1.0 - 1.0 / (1 << 24) as f64;

/// A piecewise constant density on [0, 1].
#[derive(Clone, Debug)]
pub struct PiecewiseConstant {
    sums: Vec<f64>,
    total: f64,
}

impl PiecewiseConstant {
    /// The density proportional to `weights` in as many equal cells.
    ///
    /// # Errors
    /// If there are no weights, all are zero, or one is negative or not finite.
    pub fn new(weights: &[f64]) -> Result<Self, TableError> {
        check_weights(weights, 1)?;
        let (sums, total) = normalised_sums(weights)?;
        Ok(Self { sums, total })
    }

    /// Number of cells.
    #[inline]
    pub fn len(&self) -> usize {
        self.sums.len() - 1
    }

    /// Never: a distribution has cells.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The mean of the weights: the integral of the function that they tabulate on [0, 1].
    #[inline]
    pub fn integral(&self) -> f64 {
        self.total / self.len() as f64
    }

    /// The probability of cell `index`.
    #[inline]
    pub fn probability(&self, index: usize) -> f64 {
        self.sums[index + 1] - self.sums[index]
    }

    /// The cell in which `u` ∈ [0, 1) falls, and where in it, in [0, 1).
    #[inline]
    pub fn choose(&self, u: f64) -> (usize, f64) {
        let cell = cell_of(&self.sums, u);
        let place = (u - self.sums[cell]) / self.probability(cell);
        (cell, place.clamp(0.0, LAST_PLACE))
    }

    /// A number in [0, 1) with this density.
    #[inline]
    pub fn sample(&self, u: f64) -> f64 {
        let (cell, place) = self.choose(u);
        (cell as f64 + place) / self.len() as f64
    }

    /// The inverse of [`PiecewiseConstant::sample`].
    #[inline]
    pub fn invert(&self, x: f64) -> f64 {
        let cell = self.cell(x);
        self.unchoose(cell, x * self.len() as f64 - cell as f64)
    }

    /// The inverse of [`PiecewiseConstant::choose`].
    #[inline]
    pub fn unchoose(&self, cell: usize, place: f64) -> f64 {
        self.sums[cell] + place * self.probability(cell)
    }

    /// The density at `x` ∈ [0, 1], per unit of length.
    #[inline]
    pub fn density(&self, x: f64) -> f64 {
        self.probability(self.cell(x)) * self.len() as f64
    }

    #[inline]
    fn cell(&self, x: f64) -> usize {
        ((x * self.len() as f64) as usize).min(self.len() - 1)
    }
}
