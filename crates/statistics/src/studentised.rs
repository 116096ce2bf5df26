//! The studentised bootstrap of a mean, and of the difference of two: intervals for skewed samples.
//!
//! The interval of a mean is x̄ − t*·s, with t* the percentiles of (x̄* − x̄)/s* over B samples drawn
//! with replacement; it corrects for skewness to second order (Efron 1979; Hall 1992, section 3.5).
//!
//! Decisions that are corrected over a whole run ask for levels of 10⁻⁷, and so for 10⁸ resamples. They
//! are drawn a few nanoseconds a number, by sums of deviations from the observed mean and of their
//! squares, and only the extremes that the percentiles can need are kept.
//!
//! A bootstrap knows no tail that the sample does not show: below [`FEWEST`] numbers, or with fewer
//! than ten resamples beyond each end, it is refused.

use crate::bootstrap::Resampling;
use crate::estimate::Estimate;
use crate::interval::Interval;
use crate::random::SplitMix64;
use crate::summary::Summary;

/// The fewest numbers whose tails an interval is based on.
pub const FEWEST: usize = 20;

/// The interval of the mean of independent numbers; `None` of fewer than [`FEWEST`], of non-finite ones, or
/// where the plan cannot resolve the confidence.
#[must_use]
pub fn mean(sample: &[f64], plan: &Resampling, confidence: f64) -> Option<Interval> {
    let observed = Estimate::mean(&Summary::of(sample)?);
    let deviations = Deviations::of(sample)?;
    let mut random = SplitMix64::new(plan.seed);
    interval(&observed, plan, confidence, || {
        let drawn = deviations.draw(&mut random);
        studentise(drawn.mean, drawn.variance_of_mean)
    })
}

/// The interval of the difference of two means, `a` − `b`, of independent samples whose distributions may
/// differ; `None` as for [`mean`], of either.
#[must_use]
pub fn difference(a: &[f64], b: &[f64], plan: &Resampling, confidence: f64) -> Option<Interval> {
    let observed = Estimate::welch(&Summary::of(a)?, &Summary::of(b)?);
    let (a, b) = (Deviations::of(a)?, Deviations::of(b)?);
    let mut random = SplitMix64::new(plan.seed);
    interval(&observed, plan, confidence, || {
        let (a, b) = (a.draw(&mut random), b.draw(&mut random));
        studentise(a.mean - b.mean, a.variance_of_mean + b.variance_of_mean)
    })
}

/// A sample's deviations from its mean.
struct Deviations(Vec<f64>);

/// The mean of resampled deviations.
struct Drawn {
    mean: f64,
    variance_of_mean: f64,
}

impl Deviations {
    fn of(sample: &[f64]) -> Option<Self> {
        let mean = Summary::of(sample)?.mean();
        let enough = sample.len() >= FEWEST;
        enough.then(|| Self(sample.iter().map(|x| x - mean).collect()))
    }

    /// Draws as many as there are, with replacement. The mean of the deviations is zero, so that
    /// their squares may be summed as they are: of Σd² − n·d̄² no more is lost than one bit in n.
    #[inline]
    fn draw(&self, random: &mut SplitMix64) -> Drawn {
        let (mut sum, mut squares) = (0.0, 0.0);
        let mut add = |deviation: f64| {
            sum += deviation;
            squares += deviation * deviation;
        };
        let n = self.0.len();
        for _ in 0..n / 2 {
            let [a, b] = random.two_below(n);
            add(self.0[a]);
            add(self.0[b]);
        }
        if n % 2 == 1 {
            add(self.0[random.below(n)]);
        }
        let n = n as f64;
        let mean = sum / n;
        let variance = (squares - sum * mean).max(0.0) / (n - 1.0);
        Drawn {
            mean,
            variance_of_mean: variance / n,
        }
    }
}

/// How many of its own standard errors a resampled estimate is from the observed one; infinite where
/// it has none, which is as far as can be.
#[inline]
fn studentise(distance: f64, variance: f64) -> f64 {
    if distance == 0.0 {
        0.0
    } else {
        distance / variance.sqrt()
    }
}

/// The observed estimate less the quantiles of its studentised resamples.
fn interval(
    observed: &Estimate,
    plan: &Resampling,
    confidence: f64,
    mut resample: impl FnMut() -> f64,
) -> Option<Interval> {
    if !plan.resolves(confidence) {
        return None;
    }
    let tail = 0.5 * (1.0 - confidence);
    // Between the neighbours: Hyndman & Fan 1996, type 6.
    let rank = tail * (f64::from(plan.resamples) + 1.0) - 1.0;
    let mut low = Extremes::new(rank);
    let mut high = Extremes::new(rank);
    for _ in 0..plan.resamples {
        let value = resample();
        if value.is_nan() {
            return None;
        }
        low.take(-value);
        high.take(value);
    }
    let reach = |extreme: f64| extreme * observed.standard_error();
    let interval = Interval {
        low: observed.value() - reach(high.at_rank()),
        high: observed.value() + reach(low.at_rank()),
    };
    (!interval.low.is_nan() && !interval.high.is_nan()).then_some(interval)
}

/// The greatest numbers of many.
struct Extremes {
    /// The rank that is asked for, from 0 and from the greatest; between two if it is broken.
    rank: f64,
    /// How many are enough.
    enough: usize,
    kept: Vec<f64>,
    /// Nothing below is among them.
    threshold: f64,
}

impl Extremes {
    fn new(rank: f64) -> Self {
        let enough = rank.max(0.0) as usize + 2;
        Self {
            rank: rank.max(0.0),
            enough,
            kept: Vec::with_capacity(2 * enough),
            threshold: f64::NEG_INFINITY,
        }
    }

    #[inline]
    fn take(&mut self, value: f64) {
        if value > self.threshold || self.kept.len() < self.enough {
            self.kept.push(value);
            if self.kept.len() == 2 * self.enough {
                self.drop_lesser();
            }
        }
    }

    /// Keeps the greatest only.
    fn drop_lesser(&mut self) {
        self.kept.sort_by(|a, b| b.total_cmp(a));
        self.kept.truncate(self.enough);
        self.threshold = self.kept[self.kept.len() - 1];
    }

    /// The number at the rank asked for.
    fn at_rank(&mut self) -> f64 {
        self.drop_lesser();
        let below = (self.rank as usize).min(self.kept.len() - 1);
        let above = (below + 1).min(self.kept.len() - 1);
        let (a, b) = (self.kept[below], self.kept[above]);
        if a == b {
            return a;
        }
        a + (b - a) * (self.rank - below as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::Extremes;
    use crate::random::SplitMix64;

    /// Mutant rejected: a list that is cut before it holds what is asked for.
    #[test]
    fn extremes_are_those_of_the_sorted_list() {
        let mut random = SplitMix64::new(3);
        for count in [2_usize, 3, 10, 100, 1000] {
            for rank in [0.0, 0.5, 1.0, 3.25, 17.75] {
                if rank as usize + 2 > count {
                    continue;
                }
                let numbers: Vec<f64> = (0..count).map(|_| random.below(50) as f64).collect();
                let mut extremes = Extremes::new(rank);
                numbers.iter().for_each(|x| extremes.take(*x));
                let mut sorted = numbers;
                sorted.sort_by(|a, b| b.total_cmp(a));
                let (at, part) = (rank as usize, rank.fract());
                let expected = sorted[at] + part * (sorted[at + 1] - sorted[at]);
                assert_eq!(extremes.at_rank(), expected, "{count} {rank}");
            }
        }
    }
}
