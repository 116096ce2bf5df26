//! What a test needs to know of a sample: its size, mean and variance.

/// Size, mean and unbiased variance of a sample of independent numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    count: u64,
    mean: f64,
    variance: f64,
}

impl Summary {
    /// A sample of `count` ≥ 2 with this mean and variance ≥ 0; `None` for anything else,
    /// non-finite numbers included.
    #[must_use]
    pub fn new(count: u64, mean: f64, variance: f64) -> Option<Self> {
        let usable = count >= 2 && mean.is_finite() && variance.is_finite() && variance >= 0.0;
        usable.then_some(Self {
            count,
            mean,
            variance,
        })
    }

    /// Of these numbers, in two passes; `None` of fewer than two or of non-finite ones.
    #[must_use]
    pub fn of(sample: &[f64]) -> Option<Self> {
        Self::of_iter(sample.iter().copied())
    }

    /// As [`Summary::of`], of anything that can be walked twice.
    #[must_use]
    pub fn of_iter(sample: impl Iterator<Item = f64> + Clone) -> Option<Self> {
        let count = sample.clone().count();
        if count < 2 {
            return None;
        }
        let n = count as f64;
        let rough = sample.clone().sum::<f64>() / n;
        // The second pass gives the variance and the rounding error of the first.
        let (error, squares) = sample.fold((0.0, 0.0), |(error, squares), x| {
            let d = x - rough;
            (error + d, squares + d * d)
        });
        let variance = (squares - error * error / n).max(0.0) / (n - 1.0);
        Self::new(count as u64, rough + error / n, variance)
    }

    /// The number of observations.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The mean.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// The unbiased variance of one observation.
    #[must_use]
    pub fn variance(&self) -> f64 {
        self.variance
    }

    /// The variance of the mean.
    #[must_use]
    pub fn variance_of_mean(&self) -> f64 {
        self.variance / self.count as f64
    }

    /// The standard error of the mean.
    #[must_use]
    pub fn standard_error(&self) -> f64 {
        self.variance_of_mean().sqrt()
    }
}
