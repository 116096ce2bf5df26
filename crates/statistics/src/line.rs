//! A straight line through points, with intervals.
//!
//! y = a + b·x + ε with independent normal ε of one unknown variance: least squares, and
//! t-distributed errors with n − 2 degrees of freedom. Fitted to logarithms, b is the exponent of
//! a power law, such as the −1 of an independent sampler's squared error against its samples.
//!
//! Where each point's standard error is known, weights are their inverse squares, the line's errors
//! follow from them alone (normal, not t), and Σ (residue/error)² is χ² with n − 2 degrees of
//! freedom if the line is right (Press et al. 2007, section 15.2). A standard error s of y is one of
//! s/y of ln y to first order; the mean of ln y is lower than the logarithm of the mean by
//! s²/(2y²), which is added back.

use crate::chi_squared;
use crate::estimate::Estimate;

/// A fitted line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// b.
    pub slope: Estimate,
    /// a.
    pub intercept: Estimate,
    /// The standard deviation of ε, of a point of weight one.
    pub scatter: f64,
    /// The weighted mean of x.
    centre: f64,
}

/// A line through points of known errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineWithErrors {
    /// The line; its scatter is in units of the points' errors, one if they are right.
    pub line: Line,
    /// The probability of points at least this far off the line, in their errors, if it is right.
    pub p_straight: f64,
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
            centre: mx,
        })
    }

    /// The line through points whose standard errors are known; `None` as for [`Line::fit`], or
    /// for an error that is not positive.
    #[must_use]
    pub fn fit_with_errors(x: &[f64], y: &[f64], errors: &[f64]) -> Option<LineWithErrors> {
        let weight: Vec<f64> = errors.iter().map(|s| 1.0 / (s * s)).collect();
        let line = Self::fit_weighted(x, y, &weight)?;
        let freedom = x.len() as f64 - 2.0;
        let p_straight = chi_squared::sf(line.scatter * line.scatter * freedom, freedom);
        // What the known errors alone say of the line.
        let total: f64 = weight.iter().sum();
        let spread: f64 = (weight.iter().zip(x))
            .map(|(w, x)| w * (x - line.centre) * (x - line.centre))
            .sum();
        let intercept = 1.0 / total + line.centre * line.centre / spread;
        let known = Estimate::with_known_error;
        let line = Self {
            slope: known(line.slope.value(), (1.0 / spread).sqrt())?,
            intercept: known(line.intercept.value(), intercept.sqrt())?,
            ..line
        };
        Some(LineWithErrors { line, p_straight })
    }

    /// The power law y = exp(a)·xᵇ through points whose standard errors are known and small beside
    /// y: `slope` is the exponent b. `None` as for [`Line::fit_with_errors`], or for numbers that
    /// are not positive.
    #[must_use]
    pub fn fit_power_law_with_errors(
        x: &[f64],
        y: &[f64],
        errors: &[f64],
    ) -> Option<LineWithErrors> {
        if errors.len() != y.len() {
            return None;
        }
        let x = logarithms(x)?;
        let relative: Vec<f64> = errors.iter().zip(y).map(|(s, y)| s / y).collect();
        let y: Vec<f64> = logarithms(y)?
            .iter()
            .zip(&relative)
            .map(|(y, s)| y + 0.5 * s * s)
            .collect();
        Self::fit_with_errors(&x, &y, &relative)
    }

    /// The power law y = exp(a)·xᵇ through these points, fitted to their logarithms: `slope` is
    /// the exponent b. `None` as for [`Line::fit`], or for numbers that are not positive.
    #[must_use]
    pub fn fit_power_law(x: &[f64], y: &[f64]) -> Option<Self> {
        Self::fit(&logarithms(x)?, &logarithms(y)?)
    }
}

/// `None` if any number is not positive.
fn logarithms(numbers: &[f64]) -> Option<Vec<f64>> {
    numbers
        .iter()
        .map(|&number| (number > 0.0).then(|| libm::log(number)))
        .collect()
}
