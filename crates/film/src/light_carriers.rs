//! Whether few of a picture's replicates carry its light, so that their spread is not informative.
//!
//! The effective number of R replicates x with mean m and standard error s (L. Kish, Survey Sampling, 1965, section 11.7):
//!
//! ```text
//! N = (Σ x)² / Σ x² = R / (1 + (R − 1) (s/m)²)
//! ```
//!
//! N is R for equal replicates and 1 if only one found light. Below four, intervals cover far less often than their nominal
//! level, as the brightness of rare bright events is unknown. With exponentially distributed replicates, N falls below 4 of
//! 32 in none of 10⁵ pixels, and below 2 of 8 in 0.2 % of them.
//!
//! Light that no replicate has found leaves no trace in their spread, and is not detected.

use crate::RenderedImage;
use etalon_images::Image;

/// Effective number of replicates below which a pixel counts as carried by few.
pub const FEW: f64 = 4.0;

/// The share of a picture's light (over all channels) in such pixels above which there is a warning.
pub const TOLD: f64 = 0.05;

/// The effective number of replicates of a picture with standard errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightCarriers {
    /// Number of replicates.
    pub replicates: u32,
    /// The effective number below which they are few.
    pub few: f64,
    /// The share of the light that is in pixels which few replicates carry.
    pub share: f64,
}

impl LightCarriers {
    /// Those of a picture; `None` of one with less than eight replicates. Blocks of one sequence spread more than they err, so that
    /// theirs are fewer than there are.
    pub fn of(developed: &RenderedImage) -> Option<Self> {
        let metadata = developed.metadata.as_ref()?;
        let replicates = metadata.replicates;
        if replicates < 8 {
            return None;
        }
        let few = (f64::from(replicates) / 4.0).min(FEW);
        let [mut all, mut by_few] = [0.0; 2];
        for name in metadata.colours() {
            let plane = developed.image.channel(name)?;
            let errors = developed.standard_error(name)?;
            for (&mean, &error) in plane.iter().zip(errors) {
                let (mean, error) = (f64::from(mean), f64::from(error));
                if mean > 0.0 {
                    all += mean;
                    let carriers = effective(replicates, mean, error);
                    by_few += if carriers < few { mean } else { 0.0 };
                }
            }
        }
        (all > 0.0).then(|| Self {
            replicates,
            few,
            share: by_few / all,
        })
    }

    /// A warning, if there is reason for one.
    pub fn warning(self) -> Option<String> {
        let Self {
            replicates,
            few,
            share,
        } = self;
        (share >= TOLD).then(|| {
            format!(
                "{:.0} % of the light is in pixels that fewer than {few:.0} of {replicates} replicates carry: the standard \
                 errors there say little, and what was not found may be missing",
                100.0 * share
            )
        })
    }
}

/// As many values as would carry this sum with equal shares, where these are the sum and the sum of squares of some.
pub fn carriers(sum: f64, sum_of_squares: f64) -> f64 {
    sum * sum / sum_of_squares
}

/// As many replicates as would carry the mean with equal shares.
fn effective(replicates: u32, mean: f64, error: f64) -> f64 {
    let count = f64::from(replicates);
    let spread = (count - 1.0) * error * error;
    carriers(count * mean, count * (mean * mean + spread))
}

/// The pixels in which not one sample found light: 0 with a standard error of 0.
pub fn unlit(image: &Image, colours: &[&str]) -> Vec<usize> {
    let planes: Option<Vec<&[f32]>> = colours.iter().map(|name| image.channel(name)).collect();
    let planes = planes.unwrap_or_default();
    let count = planes.first().map_or(0, |plane| plane.len());
    let is_unlit = |pixel: &usize| planes.iter().all(|plane| plane[*pixel] == 0.0);
    (0..count).filter(is_unlit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_math::float64::ln;
    use etalon_sampling::hash::{derived_key, random_float};

    /// Mean and standard error of replicates.
    fn moments(values: &[f64]) -> (f64, f64) {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
        (mean, (squares / (count - 1.0) / count).sqrt())
    }

    #[test]
    fn equal_shares_are_counted() {
        for carriers in [1, 3, 16, 32] {
            let values: Vec<f64> = (0..32).map(|i| f64::from(u8::from(i < carriers))).collect();
            let (mean, error) = moments(&values);
            let found = effective(32, mean, error);
            assert!((found - f64::from(carriers)).abs() < 1e-9, "{found}");
        }
    }

    /// The stated rate of false alarms, and detection of light that one of 30 replicates finds.
    #[test]
    fn noise_alone_is_not_told() {
        let mut drawn = 0;
        let mut uniform = || {
            drawn += 1;
            f64::from(random_float(derived_key(7, drawn) as u32)).max(1e-9)
        };
        let mut few = |draw: &dyn Fn(f64, f64) -> f64, pixels: u32| {
            let is_few = |_: &u32| {
                let values: Vec<f64> = (0..32).map(|_| draw(uniform(), uniform())).collect();
                let (mean, error) = moments(&values);
                mean > 0.0 && effective(32, mean, error) < 4.0
            };
            (0..pixels).filter(is_few).count()
        };
        assert_eq!(few(&|u, _| -ln(u), 100_000), 0);
        let rare = few(&|u, v| if v < 1.0 / 30.0 { -ln(u) } else { 0.01 }, 1000);
        assert!(rare > 500, "{rare}");
    }
}
