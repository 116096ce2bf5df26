//! Pictures of one scene by one program: how much they differ, and how long they took.

use serde::Serialize;

/// Luminance of linear Rec. 709.
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// What is added to the squared mean, so that black pixels do not count above all.
const FLOOR: f64 = 0.01;

/// The pictures so far.
#[derive(Default)]
pub(super) struct Pictures {
    luminances: Vec<Vec<f64>>,
    seconds: Vec<f64>,
}

/// What they come to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Facts {
    /// The mean over pixels of var / (mean² + 0.01), and its standard error.
    pub(super) relative_variance: [f64; 2],
    /// The mean luminance, and its standard error.
    pub(super) mean: [f64; 2],
    /// The shortest time of a picture (s).
    pub(super) seconds: f64,
    /// Samples of a picture.
    pub(super) samples: u64,
}

impl Facts {
    /// 1 / (relative variance × time) (1/s).
    pub(super) fn efficiency(&self) -> f64 {
        1.0 / (self.relative_variance[0] * self.seconds)
    }

    /// Samples per second.
    pub(super) fn rate(&self) -> f64 {
        self.samples as f64 / self.seconds
    }
}

impl Pictures {
    /// Adds a picture.
    pub(super) fn add(&mut self, pixels: impl Iterator<Item = [f32; 3]>, seconds: f64) {
        let luminance = |rgb: [f32; 3]| {
            rgb.iter()
                .zip(LUMINANCE)
                .map(|(x, w)| f64::from(*x) * w)
                .sum()
        };
        self.luminances.push(pixels.map(luminance).collect());
        self.seconds.push(seconds);
    }

    /// What they come to, each with so many samples. The variance is a mean over pictures of their
    /// squared distances from the mean picture; the spread of these is its error.
    pub(super) fn facts(&self, samples: u64) -> Facts {
        let count = self.luminances.len() as f64;
        let pixels = self.luminances.first().map_or(0, Vec::len);
        let means: Vec<f64> = (0..pixels)
            .map(|i| {
                self.luminances
                    .iter()
                    .map(|picture| picture[i])
                    .sum::<f64>()
                    / count
            })
            .collect();
        let distance = |picture: &Vec<f64>| {
            let of = |(x, m): (&f64, &f64)| (x - m) * (x - m) / (m * m + FLOOR);
            picture.iter().zip(&means).map(of).sum::<f64>() / pixels as f64 * count / (count - 1.0)
        };
        let whole = |picture: &Vec<f64>| picture.iter().sum::<f64>() / pixels as f64;
        Facts {
            relative_variance: mean(self.luminances.iter().map(distance).collect()),
            mean: mean(self.luminances.iter().map(whole).collect()),
            seconds: self.seconds.iter().copied().fold(f64::INFINITY, f64::min),
            samples,
        }
    }
}

/// The mean and its standard error.
fn mean(values: Vec<f64>) -> [f64; 2] {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let spread: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
    [mean, (spread / (count * (count - 1.0))).sqrt()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_relative_variance_is_that_of_pixels() {
        let mut pictures = Pictures::default();
        // Two pixels: 1 ± 1 about 1, and always 3.
        for (x, seconds) in [(0.0, 2.0), (2.0, 1.0), (0.0, 4.0), (2.0, 3.0)] {
            pictures.add([[x; 3], [3.0; 3]].into_iter(), seconds);
        }
        let facts = pictures.facts(8);
        let expected = 0.5 * (4.0 / 3.0) / 1.01;
        assert!(
            (facts.relative_variance[0] - expected).abs() < 1e-9,
            "{facts:?}"
        );
        assert!((facts.mean[0] - 2.0).abs() < 1e-9 && (facts.seconds - 1.0).abs() < 1e-9);
        assert!((facts.rate() - 8.0).abs() < 1e-9);
    }
}
