//! A density that runs straight between given points: pᵢ at xᵢ.

use super::{TableError, cell_of, check_weights, normalised_sums};

/// A piecewise linear density on [x₀, xₙ].
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseLinear {
    abscissae: Vec<f64>,
    /// The density at each abscissa.
    densities: Vec<f64>,
    sums: Vec<f64>,
    integral: f64,
}

impl PiecewiseLinear {
    /// The density proportional to the polygon through (`abscissae`, `values`).
    ///
    /// # Errors
    /// If there are fewer than two points, numbers differ, abscissae do not increase, all
    /// values are zero, or one is negative or not finite.
    pub fn new(abscissae: &[f64], values: &[f64]) -> Result<Self, TableError> {
        check_weights(values, 2)?;
        if abscissae.len() != values.len() {
            return Err(TableError::WrongShape {
                entries: abscissae.len(),
                needed: values.len(),
            });
        }
        let rises = |pair: &[f64]| pair[0] < pair[1] && (pair[1] - pair[0]).is_finite();
        if let Some(index) = abscissae.windows(2).position(|pair| !rises(pair)) {
            return Err(TableError::NotIncreasing { index: index + 1 });
        }
        let areas: Vec<f64> = abscissae
            .windows(2)
            .zip(values.windows(2))
            .map(|(x, v)| (x[1] - x[0]) * (0.5 * v[0] + 0.5 * v[1]))
            .collect();
        let (sums, integral) = normalised_sums(&areas)?;
        Ok(Self {
            abscissae: abscissae.to_vec(),
            densities: values.iter().map(|v| v / integral).collect(),
            sums,
            integral,
        })
    }

    /// The integral of the polygon.
    #[inline]
    pub fn integral(&self) -> f64 {
        self.integral
    }

    /// A number with this density, for `u` ∈ [0, 1).
    #[inline]
    pub fn sample(&self, u: f64) -> f64 {
        let cell = cell_of(&self.sums, u);
        let (x, width) = self.cell(cell);
        let (a, b) = (self.densities[cell], self.densities[cell + 1]);
        // ½ s t² + a t = u − sum, s the slope; the root that does not cancel.
        let mass = u - self.sums[cell];
        let root = (a * a + 2.0 * mass * (b - a) / width).max(0.0).sqrt();
        let divisor = a + root;
        let t = if divisor > 0.0 {
            2.0 * mass / divisor
        } else {
            0.0
        };
        x + t.clamp(0.0, width)
    }

    /// The inverse of [`PiecewiseLinear::sample`].
    #[inline]
    pub fn invert(&self, x: f64) -> f64 {
        let cell = self.cell_at(x);
        let (start, width) = self.cell(cell);
        let t = (x - start).clamp(0.0, width);
        let (a, b) = (self.densities[cell], self.densities[cell + 1]);
        self.sums[cell] + t * (a + 0.5 * (b - a) * t / width)
    }

    /// The density at `x`, per unit of length; zero outside.
    #[inline]
    pub fn density(&self, x: f64) -> f64 {
        let last = self.abscissae[self.abscissae.len() - 1];
        if !(x >= self.abscissae[0] && x <= last) {
            return 0.0;
        }
        let cell = self.cell_at(x);
        let (start, width) = self.cell(cell);
        let (a, b) = (self.densities[cell], self.densities[cell + 1]);
        a + (b - a) * ((x - start) / width)
    }

    #[inline]
    fn cell_at(&self, x: f64) -> usize {
        cell_of(&self.abscissae, x)
    }

    /// Start and width of the cell `index`.
    #[inline]
    fn cell(&self, index: usize) -> (f64, f64) {
        let start = self.abscissae[index];
        (start, self.abscissae[index + 1] - start)
    }
}
