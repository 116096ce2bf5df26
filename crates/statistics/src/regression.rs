//! A straight line through points, with intervals.
//!
//! y = a + b·x + ε with independent normal ε of one unknown variance: least squares, and
//! t-distributed errors with n − 2 degrees of freedom. Fitted to logarithms, b is the exponent of
//! a power law, such as the −1 of an independent sampler's squared error against its samples.

use crate::estimate::Estimate;

/// A fitted line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// b.
    pub slope: Estimate,
    /// a.
    pub intercept: Estimate,
    /// The standard deviation of ε.
    pub scatter: f64,
}

impl Line {
    /// The line through these points; `None` of unequal numbers, of fewer than three points, of
    /// non-finite ones, or if all x are equal.
    #[must_use]
    pub fn fit(x: &[f64], y: &[f64]) -> Option<Self> {
        Self::fit_weighted(x, y, &vec![1.0; x.len()])
    }

    /// The line through points whose errors' variances are *proportional* to 1/`weight`; `None`
    /// as for [`Line::fit`], or for a weight that is not positive.
    #[must_use]
    pub fn fit_weighted(x: &[f64], y: &[f64], weight: &[f64]) -> Option<Self> {
        let n = x.len();
        let usable = n >= 3
            && y.len() == n
            && weight.len() == n
            && weight.iter().all(|&w| w > 0.0 && w.is_finite());
        if !usable {
            return None;
        }
        let sum = |term: &dyn Fn(usize) -> f64| (0..n).map(|i| weight[i] * term(i)).sum::<f64>();
        let total = sum(&|_| 1.0);
        let (mx, my) = (sum(&|i| x[i]) / total, sum(&|i| y[i]) / total);
        let spread = sum(&|i| (x[i] - mx) * (x[i] - mx));
        if !(spread > 0.0) {
            return None;
        }
        let slope = sum(&|i| (x[i] - mx) * (y[i] - my)) / spread;
        let intercept = my - slope * mx;
        let residue = |i: usize| y[i] - my - slope * (x[i] - mx);
        let freedom = n as f64 - 2.0;
        let variance = sum(&|i| residue(i) * residue(i)) / freedom;
        Some(Self {
            slope: Estimate::new(slope, (variance / spread).sqrt(), freedom)?,
            intercept: Estimate::new(
                intercept,
                (variance * (1.0 / total + mx * mx / spread)).sqrt(),
                freedom,
            )?,
            scatter: variance.sqrt(),
        })
    }

    /// The power law y = exp(a)·xᵇ through these points, fitted to their logarithms: `slope` is
    /// the exponent b. `None` as for [`Line::fit`], or for numbers that are not positive.
    #[must_use]
    pub fn fit_power_law(x: &[f64], y: &[f64]) -> Option<Self> {
        let logarithms = |numbers: &[f64]| -> Option<Vec<f64>> {
            numbers
                .iter()
                .map(|&number| (number > 0.0).then(|| libm::log(number)))
                .collect()
        };
        Self::fit(&logarithms(x)?, &logarithms(y)?)
    }
}
