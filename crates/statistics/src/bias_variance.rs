//! Bias and variance of a consistent but biased method, told apart by independent replicates.
//!
//! With dᵢ the vector of errors of replicate i (over pixels, say), |v|² the mean of its squares,
//!
//! MSE = E|d|² = bias² + variance, bias² = |E d|² = E⟨dᵢ, dⱼ⟩ for i ≠ j.
//!
//! The mean of ⟨dᵢ, dⱼ⟩ over all pairs of the R replicates is unbiased for bias² (it may be negative
//! where there is none), whatever the dependence between pixels; standard errors are the
//! jackknife's over replicates (Quenouille 1956, Tukey 1958), which treats each replicate as one.
//! Nothing here is clamped at zero.

use crate::estimate::Estimate;

/// The parts of a mean squared error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BiasVariance {
    /// The mean squared error of one replicate.
    pub mean_squared_error: Estimate,
    /// The squared bias; an unbiased estimate, so it may be negative.
    pub bias_squared: Estimate,
    /// The variance of one replicate.
    pub variance: Estimate,
}

impl BiasVariance {
    /// Of replicates, one after the other, of `truth.len()` numbers each; `None` of fewer than
    /// three, of incomplete ones or of non-finite numbers.
    #[must_use]
    pub fn of(replicates: &[f64], truth: &[f64]) -> Option<Self> {
        let size = truth.len();
        if size == 0 || !replicates.len().is_multiple_of(size) || replicates.len() < 3 * size {
            return None;
        }
        let errors = || {
            replicates
                .chunks_exact(size)
                .map(|replicate| replicate.iter().zip(truth).map(|(x, t)| x - t))
        };
        let mut sum = vec![0.0; size];
        for error in errors() {
            for (sum, d) in sum.iter_mut().zip(error) {
                *sum += d;
            }
        }
        let n = size as f64;
        let total = sum.iter().map(|s| s * s).sum::<f64>() / n;
        // Per replicate: ⟨dᵢ, dᵢ⟩ and ⟨Σd, dᵢ⟩.
        let products: Vec<(f64, f64)> = errors()
            .map(|error| {
                let (own, shared) = error.zip(&sum).fold((0.0, 0.0), |(own, shared), (d, s)| {
                    (own + d * d, shared + s * d)
                });
                (own / n, shared / n)
            })
            .collect();
        let squares: f64 = products.iter().map(|(own, _)| own).sum();
        let parts = |total: f64, squares: f64, count: f64| {
            let mse = squares / count;
            let bias = (total - squares) / (count * (count - 1.0));
            [mse, bias, mse - bias]
        };
        let count = products.len() as f64;
        let whole = parts(total, squares, count);
        let without: Vec<[f64; 3]> = products
            .iter()
            .map(|(own, shared)| parts(total - 2.0 * shared + own, squares - own, count - 1.0))
            .collect();
        let estimate = |i: usize| {
            let mean = without.iter().map(|part| part[i]).sum::<f64>() / count;
            let spread: f64 = without
                .iter()
                .map(|part| (part[i] - mean) * (part[i] - mean))
                .sum();
            let error = (spread * (count - 1.0) / count).sqrt();
            Estimate::new(whole[i], error, count - 1.0)
        };
        Some(Self {
            mean_squared_error: estimate(0)?,
            bias_squared: estimate(1)?,
            variance: estimate(2)?,
        })
    }
}
