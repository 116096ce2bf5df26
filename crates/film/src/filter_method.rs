//! Methods of reconstruction from a film's samples.

use crate::Filter;
use std::fmt;

/// How the reconstruction filter is applied to camera samples.
///
/// With x the position of a sample, v its value, cₚ the centre of pixel p and f the filter:
///
/// | method | positions | pixel p |
/// |---|---|---|
/// | splatting | evenly in each pixel | Σ v f(cₚ − x) / (n (∫f)²), over all samples under the filter |
/// | weighted mean | evenly in each pixel | Σ v f(cₚ − x) / Σ f(cₚ − x), over the same |
/// | importance sampling | by \|f\|, see [`crate::pixel_filter`] | the mean over the pixel's own samples |
///
/// f is the product over both axes; n is the number of samples of a pixel. The weighted mean is Mitsuba's; it is biased,
/// but consistent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FilterMethod {
    /// A sample counts for every pixel under the filter, divided by the filter's integral: unbiased.
    #[default]
    Splatting,
    /// The same, divided by the sum of the filter's values: a constant stays a constant.
    WeightedMean,
    /// A sample counts for one pixel: unbiased, and pixels are independent.
    ImportanceSampling,
}

impl FilterMethod {
    /// All of them, and their names in scenes.
    pub const ALL: [(&'static str, Self); 3] = [
        ("splatting", Self::Splatting),
        ("weighted_mean", Self::WeightedMean),
        ("importance_sampling", Self::ImportanceSampling),
    ];

    /// The widest filter (radius in pixels) whose samples are shared: the time of a sample and the border around
    /// the film grow with it. Wider ones are importance-sampled.
    pub const WIDEST: f64 = 16.0;

    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        let named = Self::ALL.iter().find(|(_, method)| *method == self);
        named.map_or("", |(name, _)| name)
    }

    /// The method that a film with this filter uses: where no sample reaches a second pixel all are the same, and
    /// too wide filters are importance-sampled.
    #[must_use]
    pub fn with(self, filter: &Filter) -> Self {
        let shared = filter.radius() > 0.5 && filter.radius() <= Self::WIDEST;
        if shared {
            self
        } else {
            Self::ImportanceSampling
        }
    }
}

impl fmt::Display for FilterMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
