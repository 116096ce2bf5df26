//! How many samples would decide a comparison that is open.

use crate::judge::ImageComparison;
use etalon_statistics::Verdict;

impl ImageComparison {
    /// How many times as many samples, in both images, would decide what their means leave open: until the widest
    /// interval that lies on both sides of a bound lies on one. `None` if nothing is open.
    ///
    /// The interval's half width falls as one over the root of the samples; the bias found is taken for the true one, so
    /// that this is no more than a guess where it is near the bound.
    pub fn more_samples(&self) -> Option<f64> {
        let bound = self.rules.image_bound;
        let open = self
            .images
            .iter()
            .filter(|row| row.verdict == Verdict::Undecided);
        open.map(|row| {
            let half = 0.5 * (row.interval[1] - row.interval[0]);
            (half / (row.bias.abs() - bound).abs()).powi(2)
        })
        .reduce(f64::max)
    }
}
