//! What a comparison found: the schema of its JSON (`docs/estimators-json.md`).

use super::reference::ReferenceOrigin;
use etalon_statistics::Verdict;
use serde::Serialize;

/// Everything that was found.
#[derive(Clone, Debug, Serialize)]
pub struct Findings {
    /// The version of this description: [`Findings::FORMAT`].
    pub format: u32,
    /// The version of the program.
    pub version: String,
    /// The scene file as it was named.
    pub scene: String,
    /// Hash over everything that was read with the first integrator.
    pub scene_hash: String,
    /// Width and height of every picture (pixels).
    pub size: [usize; 2],
    /// The seed of all randomness.
    pub seed: u64,
    /// Threads that rendered.
    pub threads: usize,
    /// The time that was asked for (s).
    pub seconds_asked: f64,
    /// The time from the reference to the last picture (s).
    pub seconds_taken: f64,
    /// The confidence of every interval.
    pub confidence: f64,
    /// ε of relMSE.
    pub epsilon: f64,
    /// What errors are measured against.
    pub reference: ReferenceFacts,
    /// The estimators, in the order they were named; ratios are to the first.
    pub estimators: Vec<EntrantResult>,
    /// What a reader should know before believing the rest.
    pub remarks: Vec<String>,
    /// Pictures for the eye, by estimator.
    #[serde(skip)]
    pub pictures: Pictures,
}

/// The findings about one estimator.
pub type Row = EntrantResult;

impl Findings {
    /// The version of the description that is written.
    pub const FORMAT: u32 = 1;

    /// Whether all estimators have the mean of the first, to a relative tolerance.
    pub fn verdict(&self, tolerance: f64) -> Verdict {
        let differences = self.estimators.iter().flat_map(|row| &row.differences);
        differences.fold(Verdict::Agrees, |all, one| all.and(one.verdict(tolerance)))
    }
}

/// The reference.
#[derive(Clone, Debug, Serialize)]
pub struct ReferenceFacts {
    /// Where it comes from.
    pub origin: ReferenceOrigin,
    /// Its own relMSE, which was subtracted; absent without standard errors.
    pub rel_mse: Option<f64>,
}

/// A number with its confidence interval, where one could be had.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Uncertain {
    /// The number; absent where it makes no sense, such as a time to an error that is below the bias.
    pub value: Option<f64>,
    /// Its interval.
    pub interval: Option<[f64; 2]>,
    /// In place of an interval, a bound that the true number exceeds.
    pub at_least: Option<f64>,
}

/// Pictures of one size.
#[derive(Clone, Debug, Serialize)]
pub struct AtSize {
    /// Samples per pixel of one picture.
    pub samples_per_pixel: u32,
    /// Independent pictures.
    pub replicates: u32,
    /// Time of one picture (s).
    pub seconds: Uncertain,
    /// relMSE of one picture, bias included, the reference's noise subtracted.
    pub rel_mse: Uncertain,
    /// The part of it that is variance.
    pub variance: Uncertain,
    /// The part of it that is bias; an unbiased estimate, so it may be negative.
    pub bias_squared: Uncertain,
}

/// How many times as good as the first estimator: greater is better.
#[derive(Clone, Debug, Serialize)]
pub struct Gains {
    /// Efficiency.
    pub efficiency: Uncertain,
    /// Samples per second.
    pub speed: Uncertain,
    /// One over relMSE, with equally many samples per pixel.
    pub error_at_equal_samples: Uncertain,
}

/// The difference of one channel's mean from the first estimator's.
#[derive(Clone, Debug, Serialize)]
pub struct Difference {
    /// The channel.
    pub channel: &'static str,
    /// This mean less the first estimator's, relative to the latter (or to 5 % of its luminance, if
    /// that is more).
    pub relative: f64,
    /// Its interval; those of all channels and estimators hold together. Absent where no method
    /// reaches that confidence.
    pub interval: Option<[f64; 2]>,
    /// How the interval came about: `student`, or `bootstrap` where the tails forbid it.
    pub method: Option<&'static str>,
}

impl Difference {
    /// Whether the interval excludes "none".
    pub fn is_shown(&self) -> bool {
        self.interval
            .is_some_and(|[low, high]| low > 0.0 || high < 0.0)
    }

    /// The greatest difference that the interval allows; infinite without one.
    pub fn bound(&self) -> f64 {
        self.interval
            .map_or(f64::INFINITY, |[low, high]| low.abs().max(high.abs()))
    }

    /// Whether the interval lies within the tolerance, or outside of it.
    pub fn verdict(&self, tolerance: f64) -> Verdict {
        match self.interval {
            Some([low, high]) if low > tolerance || high < -tolerance => Verdict::Differs,
            _ if self.bound() <= tolerance => Verdict::Agrees,
            _ => Verdict::Undecided,
        }
    }
}

/// Pictures of one size, on the way down.
#[derive(Clone, Debug, Serialize)]
pub struct Step {
    /// Samples per pixel of one picture.
    pub samples_per_pixel: u32,
    /// Independent pictures.
    pub replicates: u32,
    /// Time of one picture (s).
    pub seconds: f64,
    /// The mean squared error, the reference's noise subtracted.
    pub mse: f64,
    /// Its standard error.
    pub standard_error: f64,
}

/// The squared error against samples.
#[derive(Clone, Debug, Serialize)]
pub struct Convergence {
    /// The sizes, the smallest first.
    pub steps: Vec<Step>,
    /// The exponent b of mse ∝ samplesᵇ: −1 for independent samples. Absent of fewer than three sizes.
    pub exponent: Uncertain,
    /// The logarithm of the fitted mse at one sample per pixel.
    pub intercept: Option<f64>,
    /// The probability of steps at least as far from a power law, if it is one.
    pub p_power_law: Option<f64>,
}

/// What was found about one estimator.
#[derive(Clone, Debug, Serialize)]
pub struct EntrantResult {
    /// What tells it from the others.
    pub name: String,
    /// The integrator, nested ones after a slash.
    pub integrator: String,
    /// The sampler.
    pub sampler: String,
    /// The reconstruction filter with its parameters.
    pub filter: String,
    /// Whether it learns or prepares something for each picture, so that short pictures say little of long ones.
    pub prepares: bool,
    /// Pictures that take as long as the others'.
    pub equal_time: AtSize,
    /// Pictures of as many samples as the others'.
    pub equal_samples: AtSize,
    /// Wall-clock time of one camera sample, all threads together (ns).
    pub nanoseconds_per_sample: f64,
    /// 1 / (relMSE · time) of pictures at equal time (s⁻¹).
    pub efficiency: Uncertain,
    /// Ratios to the first estimator; absent of the first.
    pub gains: Option<Gains>,
    /// The time to √relMSE = 1 % by averaging independent pictures of the size at equal time (s).
    /// Nothing at all if the bias alone is greater: see `reaches_one_percent`.
    pub seconds_to_one_percent: Uncertain,
    /// Whether that error can be reached: false if the bias alone is shown to be greater.
    pub reaches_one_percent: bool,
    /// The means of red, green and blue.
    pub means: [f64; 3],
    /// Differences from the first estimator's means; empty of the first.
    pub differences: Vec<Difference>,
    /// The squared error against samples.
    pub convergence: Convergence,
    /// Contributions that were not finite, and refused.
    pub non_finite: u64,
}

impl EntrantResult {
    /// The difference whose interval allows most.
    pub fn widest_difference(&self) -> Option<&Difference> {
        let differences = self.differences.iter();
        differences.max_by(|a, b| a.bound().total_cmp(&b.bound()))
    }
}

/// Pictures for the eye.
#[derive(Clone, Debug, Default)]
pub struct Pictures {
    /// The reference: red, green and blue, interleaved.
    pub reference: Vec<f32>,
    /// One picture at equal time by every estimator.
    pub estimators: Vec<Vec<f32>>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_verdict_is_that_of_the_interval() {
        for (interval, verdict) in [
            (Some([0.001, 0.002]), Verdict::Agrees),
            (Some([-0.01, 0.01]), Verdict::Agrees),
            (Some([0.02, 0.03]), Verdict::Differs),
            (Some([-0.03, -0.02]), Verdict::Differs),
            (Some([-0.02, 0.005]), Verdict::Undecided),
            (None, Verdict::Undecided),
        ] {
            let difference = Difference {
                channel: "R",
                relative: 0.0,
                interval,
                method: None,
            };
            assert_eq!(difference.verdict(0.01), verdict, "{interval:?}");
        }
    }
}
