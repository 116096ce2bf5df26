//! Error metrics of an image t against a reference r, over N pixels and three channels.
//!
//! - MSE = (1/3N) Σ (t − r)²;
//! - relMSE = (1/3N) Σ (t − r)² / (r² + ε), ε = 10⁻² unless stated (Rousselle, Knaus & Zwicker
//!   2011);
//! - SMAPE = (1/3N) Σ |t − r| / (|t| + |r| + ε), ε = 10⁻² unless stated (Vogels et al. 2018).
//!
//! Sums are in double precision, in the order of the pixels. The squared error of a noisy image
//! against a noisy reference holds both variances: only against a converged reference is it the
//! image's own.

use crate::picture::{Picture, PictureError};

/// The ε of [`rel_mse`] and [`smape`] unless stated.
pub const EPSILON: f64 = 1e-2;

/// The mean squared error.
///
/// # Errors
/// [`PictureError::DifferentSizes`].
pub fn mse(test: &Picture<'_>, reference: &Picture<'_>) -> Result<f64, PictureError> {
    mean(test, reference, |t, r| (t - r) * (t - r))
}

/// The mean squared error relative to r² + `epsilon`.
///
/// # Errors
/// [`PictureError::DifferentSizes`], or [`PictureError::BadOption`] unless `epsilon` > 0.
pub fn rel_mse(
    test: &Picture<'_>,
    reference: &Picture<'_>,
    epsilon: f64,
) -> Result<f64, PictureError> {
    positive(epsilon)?;
    mean(test, reference, |t, r| relative(t, r, epsilon))
}

/// The mean of |t − r| / (|t| + |r| + `epsilon`), in [0, 1].
///
/// # Errors
/// [`PictureError::DifferentSizes`], or [`PictureError::BadOption`] unless `epsilon` > 0.
pub fn smape(
    test: &Picture<'_>,
    reference: &Picture<'_>,
    epsilon: f64,
) -> Result<f64, PictureError> {
    positive(epsilon)?;
    mean(test, reference, |t, r| {
        (t - r).abs() / (t.abs() + r.abs() + epsilon)
    })
}

fn relative(t: f64, r: f64, epsilon: f64) -> f64 {
    (t - r) * (t - r) / (r * r + epsilon)
}

fn positive(epsilon: f64) -> Result<(), PictureError> {
    if epsilon > 0.0 && epsilon.is_finite() {
        Ok(())
    } else {
        Err(PictureError::BadOption { option: "epsilon" })
    }
}

fn mean(
    test: &Picture<'_>,
    reference: &Picture<'_>,
    error: impl Fn(f64, f64) -> f64,
) -> Result<f64, PictureError> {
    test.same_size(reference)?;
    let pairs = test.values().iter().zip(reference.values());
    let sum: f64 = pairs
        .map(|(&t, &r)| error(f64::from(t), f64::from(r)))
        .sum();
    Ok(sum / test.values().len() as f64)
}
