//! From measured pictures to findings.
//!
//! - Means (time, relMSE, variance, squared bias) have Student's interval, or the studentised
//!   bootstrap's where the tails forbid that, or none ([`etalon_statistics::judgement`]).
//! - All pictures share one reference, whose noise is subtracted as it is on average. What it is in
//!   this very reference does not show in the pictures' spread, so the squared bias's interval is
//!   widened by that noise on either side: no bias is shown that a converged reference might deny.
//! - Efficiency and every ratio have bootstrap percentiles over pictures; where the denominator
//!   hangs on a single picture, only a lower bound ([`etalon_statistics::ratio`]).
//! - The time to an error e: pictures of relMSE = bias² + variance that take T each, averaged k at
//!   a time, have the error bias² + variance/k, so it is T · variance / (e² − bias²), or never. A bias
//!   that is not shown counts as none in the value, and as far as it may reach in the interval.

use super::cell::{Cell, Measured as Picture, Pair};
use super::estimator_config::EstimatorConfig;
use super::findings::{
    AtSize, Convergence, Difference, EntrantResult, Findings, Gains, Pictures, ReferenceFacts,
    Step, Uncertain,
};
use super::options::Options;
use super::reference::Reference;
use super::{CONFIDENCE, remarks};
use crate::VERSION;
use crate::pipeline::{Loaded, sampler_name};
use etalon_math::float64;
use etalon_spectrum::colour_space::luminance;
use etalon_statistics::bootstrap::{Resampling, percentile_bootstrap};
use etalon_statistics::judgement::{Method, Symmetry, judge, judge_difference};
use etalon_statistics::metrics::EPSILON;
use etalon_statistics::ratio::{self, Known};
use etalon_statistics::tails::Limits;
use etalon_statistics::{Estimate, Line, LineWithErrors, Summary};

/// The relMSE of "one percent error".
const ONE_PERCENT: f64 = 1e-4;

/// The channels of every picture.
const CHANNELS: [&str; 3] = ["R", "G", "B"];

/// Resamples behind every bootstrap interval.
const RESAMPLES: u32 = 9_999;

/// Everything that was measured.
pub struct Measured<'a> {
    /// The scene.
    pub scene: &'a Loaded,
    /// The estimators.
    pub entrants: &'a [EstimatorConfig],
    /// What was asked for.
    pub options: &'a Options,
    /// The step of the ladders where samples are equal.
    pub equal_samples: usize,
    /// What errors are measured against.
    pub reference: &'a Reference,
    /// Of every estimator the pictures at equal time, then its ladder.
    pub cells: &'a [Vec<Cell>],
    /// How long it took.
    pub seconds: f64,
    /// How many pictures were left out for lack of time, and how many were planned.
    pub left_out: [u32; 2],
}

/// Draws the conclusions.
pub fn findings(measured: &Measured<'_>) -> Findings {
    let plan = Resampling::independent(RESAMPLES, measured.options.seed);
    let rows = measured.entrants.iter().zip(measured.cells);
    let estimators: Vec<EntrantResult> = rows
        .map(|(entrant, cells)| outcome(measured, entrant, cells, &plan))
        .collect();
    let first_pictures = measured.cells.iter().map(|cells| cells[0].first.clone());
    let mut findings = Findings {
        format: Findings::FORMAT,
        version: VERSION.to_owned(),
        scene: measured.scene.path.display().to_string(),
        scene_hash: measured.scene.hash.clone(),
        size: measured.reference.size(),
        seed: measured.options.seed,
        threads: rayon::current_num_threads(),
        seconds_asked: measured.options.seconds,
        seconds_taken: measured.seconds,
        confidence: CONFIDENCE,
        epsilon: EPSILON,
        reference: ReferenceFacts {
            origin: measured.reference.origin.clone(),
            rel_mse: measured.reference.noise,
        },
        estimators,
        remarks: Vec::new(),
        pictures: Pictures {
            reference: measured.reference.picture().values().to_vec(),
            estimators: first_pictures.map(Option::unwrap_or_default).collect(),
        },
    };
    let of_cell = |cell: &Cell| cell.measured.iter().all(|one| one.mean == [0.0; 3]);
    let black = remarks::Black {
        reference: (measured.reference.picture().values().iter()).all(|value| *value == 0.0),
        estimators: (measured.cells.iter())
            .map(|cells| cells.iter().all(of_cell))
            .collect(),
    };
    findings.remarks = remarks::about(&findings, &black);
    if black.reference {
        return findings;
    }
    findings.remarks.extend(remarks::late(measured.left_out));
    let noise = measured.reference.squared_noise.unwrap_or(0.0);
    let rows = findings.estimators.iter().zip(measured.cells);
    let carried = rows.filter_map(|(row, cells)| {
        let errors = cells[0].of(|picture| picture.squared + noise);
        remarks::few(&row.name, &errors)
    });
    findings.remarks.extend(carried.collect::<Vec<_>>());
    findings
}

fn outcome(
    measured: &Measured<'_>,
    entrant: &EstimatorConfig,
    cells: &[Cell],
    plan: &Resampling,
) -> EntrantResult {
    let (timed, ladder) = (&cells[0], &cells[1..]);
    let first = &measured.cells[0];
    let is_first = std::ptr::eq(first.as_slice(), cells);
    let equal_samples = &ladder[measured.equal_samples];
    let equal_time = at_size(timed, measured.reference, plan);
    let [width, height] = measured.reference.size();
    let per_pixel = width as f64 * height as f64;
    let seconds = mean(&timed.of(|p| p.seconds));
    let others = measured.cells.len() - 1;
    let reach = seconds_to(ONE_PERCENT, seconds, &equal_time);
    EntrantResult {
        name: entrant.name.clone(),
        integrator: entrant.integrator_name.clone(),
        sampler: sampler_name(entrant.sampler).to_owned(),
        filter: entrant.film.filter.to_string(),
        prepares: entrant.integrator.prepares(),
        nanoseconds_per_sample: 1e9 * seconds / (per_pixel * f64::from(timed.size.samples)),
        efficiency: efficiency(timed, plan),
        gains: (!is_first).then(|| Gains {
            efficiency: gain(&first[0].measured, &timed.measured, plan, cost),
            speed: gain(&first[0].measured, &timed.measured, plan, |pictures| {
                pictures.iter().map(|p| p.seconds).sum::<f64>() / pictures.len() as f64
            })
            .times(f64::from(timed.size.samples) / f64::from(first[0].size.samples)),
            error_at_equal_samples: gain(
                &first[1 + measured.equal_samples].measured,
                &equal_samples.measured,
                plan,
                error,
            ),
        }),
        reaches_one_percent: reach.at_least != Some(f64::INFINITY),
        seconds_to_one_percent: reach,
        means: mean_colour(timed),
        differences: match is_first {
            true => Vec::new(),
            false => differences(timed, &first[0], others, plan),
        },
        convergence: convergence(ladder),
        non_finite: cells.iter().map(|cell| cell.faults).sum(),
        equal_samples: at_size(equal_samples, measured.reference, plan),
        equal_time,
    }
}

fn mean(numbers: &[f64]) -> f64 {
    numbers.iter().sum::<f64>() / numbers.len() as f64
}

fn mean_colour(cell: &Cell) -> [f64; 3] {
    [0, 1, 2].map(|channel| mean(&cell.of(|p| p.mean[channel])))
}

/// relMSE of a picture, on average.
fn error(pictures: &[Picture]) -> f64 {
    pictures.iter().map(|p| p.error).sum::<f64>() / pictures.len() as f64
}

/// relMSE · time, on average: one over the efficiency.
fn cost(pictures: &[Picture]) -> f64 {
    let seconds: f64 = pictures.iter().map(|p| p.seconds).sum();
    error(pictures) * seconds / pictures.len() as f64
}

impl Uncertain {
    /// A mean with the interval that its tails allow.
    fn mean(numbers: &[f64], plan: &Resampling) -> Self {
        let limits = Limits::DECLARED;
        let judged = judge(numbers, 1.0 - CONFIDENCE, Symmetry::Unknown, &limits, plan);
        let interval = judged.and_then(|judged| judged.interval);
        Self {
            value: Some(mean(numbers)),
            interval: interval.map(|(interval, _)| [interval.low, interval.high]),
            at_least: None,
        }
    }

    /// The same number, less certain by `doubt` either way.
    fn widened(self, doubt: f64) -> Self {
        Self {
            interval: self.interval.map(|[low, high]| [low - doubt, high + doubt]),
            ..self
        }
    }

    /// The same number in other units.
    fn times(self, factor: f64) -> Self {
        Self {
            value: self.value.map(|value| value * factor),
            interval: self
                .interval
                .map(|interval| interval.map(|end| end * factor)),
            at_least: self.at_least.map(|bound| bound * factor),
        }
    }
}

fn at_size(cell: &Cell, reference: &Reference, plan: &Resampling) -> AtSize {
    let pairs = |number: fn(&Pair) -> f64| -> Vec<f64> { cell.pairs.iter().map(number).collect() };
    AtSize {
        samples_per_pixel: cell.size.samples,
        replicates: cell.size.replicates,
        seconds: Uncertain::mean(&cell.of(|p| p.seconds), plan),
        rel_mse: Uncertain::mean(&cell.of(|p| p.error), plan),
        variance: Uncertain::mean(&pairs(|pair| pair.variance), plan),
        bias_squared: Uncertain::mean(&pairs(|pair| pair.bias_squared), plan)
            .widened(reference.noise.unwrap_or(0.0)),
    }
}

fn efficiency(cell: &Cell, plan: &Resampling) -> Uncertain {
    let pictures = &cell.measured;
    let value = cost(pictures);
    if !(value > 0.0) {
        return Uncertain::default();
    }
    let mut drawn = Vec::new();
    let interval = percentile_bootstrap(pictures.len(), plan, CONFIDENCE, |indices| {
        drawn.clear();
        drawn.extend(indices.iter().map(|&i| pictures[i]));
        cost(&drawn)
    });
    let interval = interval.filter(|interval| interval.low > 0.0);
    Uncertain {
        value: Some(1.0 / value),
        interval: interval.map(|interval| [1.0 / interval.high, 1.0 / interval.low]),
        at_least: None,
    }
}

/// A statistic of the first estimator's pictures over that of this one's.
fn gain(
    first: &[Picture],
    this: &[Picture],
    plan: &Resampling,
    statistic: fn(&[Picture]) -> f64,
) -> Uncertain {
    let Some(ratio) = ratio::of(first, this, plan, CONFIDENCE, statistic) else {
        return Uncertain::default();
    };
    let (interval, at_least) = match ratio.known {
        Known::Between(interval) => (Some([interval.low, interval.high]), None),
        Known::AtLeast(bound) => (None, Some(bound)),
    };
    Uncertain {
        value: Some(ratio.value),
        interval,
        at_least,
    }
}

/// The time to a relMSE of `goal`, by averaging pictures that take `seconds` each. No value, but an
/// infinite bound, if the bias alone is shown to be greater.
fn seconds_to(goal: f64, seconds: f64, size: &AtSize) -> Uncertain {
    let Some(variance) = size.variance.value.filter(|variance| *variance > 0.0) else {
        return Uncertain::default();
    };
    let time = |bias: f64, variance: f64| seconds * variance / (goal - bias);
    // Nothing is known of a bias without interval.
    let [low, high] = (size.bias_squared.interval).unwrap_or([0.0, f64::INFINITY]);
    let least = low.max(0.0);
    if least >= goal {
        return Uncertain {
            at_least: Some(f64::INFINITY),
            ..Uncertain::default()
        };
    }
    let bias = size.bias_squared.value.filter(|_| low > 0.0);
    let bias = bias.unwrap_or(0.0);
    let [smallest, greatest] = size.variance.interval.unwrap_or([0.0, f64::INFINITY]);
    let from = time(least, smallest.max(0.0));
    let known = high < goal && greatest.is_finite();
    Uncertain {
        value: (bias < goal).then(|| time(bias, variance)),
        interval: known.then(|| [from, time(high.max(0.0), greatest)]),
        at_least: (!known && from > 0.0).then_some(from),
    }
}

/// The differences of the channels' means; all their intervals hold together.
fn differences(this: &Cell, first: &Cell, others: usize, plan: &Resampling) -> Vec<Difference> {
    let alpha = (1.0 - CONFIDENCE) / (CHANNELS.len() * others) as f64;
    let means = mean_colour(first);
    let floor = 0.05 * luminance(means).abs();
    let difference = |(index, channel): (usize, &'static str)| {
        let (a, b) = (this.of(|p| p.mean[index]), first.of(|p| p.mean[index]));
        let scale = means[index].abs().max(floor);
        let scale = if scale > 0.0 { scale } else { 1.0 };
        let limits = Limits::DECLARED;
        let judged = judge_difference(&a, &b, alpha, Symmetry::Unknown, &limits, plan);
        let interval = judged.and_then(|judged| judged.interval);
        Difference {
            channel,
            relative: (mean(&a) - mean(&b)) / scale,
            interval: interval.map(|(interval, _)| [interval.low / scale, interval.high / scale]),
            method: interval.map(|(_, method)| match method {
                Method::Student => "student",
                Method::SignFlip => "sign_flip",
                Method::Bootstrap => "bootstrap",
                Method::Lowered => "student_at_lower_level",
            }),
        }
    };
    CHANNELS.into_iter().enumerate().map(difference).collect()
}

/// The squared error along the ladder, and its exponent.
fn convergence(ladder: &[Cell]) -> Convergence {
    let steps: Vec<Step> = ladder
        .iter()
        .map(|cell| {
            let errors = cell.of(|p| p.squared);
            Step {
                samples_per_pixel: cell.size.samples,
                replicates: cell.size.replicates,
                seconds: mean(&cell.of(|p| p.seconds)),
                mse: mean(&errors),
                standard_error: Summary::of(&errors).map_or(f64::NAN, |s| s.standard_error()),
            }
        })
        .collect();
    let line = fit(&steps);
    let exponent = line.as_ref().and_then(exponent);
    Convergence {
        exponent: exponent.unwrap_or_default(),
        intercept: line.as_ref().map(|fit| fit.line.intercept.value()),
        p_power_law: line.as_ref().map(|fit| fit.p_straight),
        steps,
    }
}

fn fit(steps: &[Step]) -> Option<LineWithErrors> {
    let of = |number: fn(&Step) -> f64| -> Vec<f64> { steps.iter().map(number).collect() };
    let samples = of(|step| f64::from(step.samples_per_pixel));
    let (mse, errors) = (of(|step| step.mse), of(|step| step.standard_error));
    Line::fit_power_law_with_errors(&samples, &mse, &errors)
}

/// The slope with a t interval: the points' errors are estimated from [`super::schedule::LADDER`]
/// pictures each. Points off a power law by more than their errors widen it by as much.
fn exponent(fit: &LineWithErrors) -> Option<Uncertain> {
    let slope = fit.line.slope;
    let freedom = f64::from(super::schedule::LADDER) - 1.0;
    let error = slope.standard_error() * fit.line.scatter.max(1.0);
    let interval = Estimate::new(slope.value(), error, freedom)?.interval(CONFIDENCE);
    Some(Uncertain {
        value: Some(slope.value()),
        interval: Some([interval.low, interval.high]),
        at_least: None,
    })
}

impl Convergence {
    /// The fitted mse at so many samples per pixel.
    pub fn fitted(&self, samples: f64) -> Option<f64> {
        Some(float64::exp(
            self.intercept? + self.exponent.value? * float64::ln(samples),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn size(variance: [f64; 3], bias: [f64; 3]) -> AtSize {
        let uncertain = |[value, low, high]: [f64; 3]| Uncertain {
            value: Some(value),
            interval: Some([low, high]),
            at_least: None,
        };
        AtSize {
            samples_per_pixel: 4,
            replicates: 24,
            seconds: Uncertain::default(),
            rel_mse: Uncertain::default(),
            variance: uncertain(variance),
            bias_squared: uncertain(bias),
        }
    }

    #[test]
    fn time_to_an_error_adds_pictures_up() {
        // 0.01 of variance in 2 s each: a hundred pictures make 10⁻⁴.
        let variance = [0.01, 0.009, 0.012];
        let unbiased = seconds_to(1e-4, 2.0, &size(variance, [1e-6, -1e-5, 1e-5]));
        let (value, [low, high]) = (unbiased.value, unbiased.interval.expect("known"));
        assert!((value.expect("a time") - 200.0).abs() < 1e-9);
        assert!((low - 180.0).abs() < 1e-9 && (high - 2.0 * 0.012 / 9e-5).abs() < 1e-9);
        // A bias of half the goal takes twice the pictures.
        let half = seconds_to(1e-4, 2.0, &size(variance, [5e-5, 4e-5, 6e-5]));
        assert!((half.value.expect("a time") - 400.0).abs() < 1e-9);
        // One that may exceed the goal leaves a bound, one that does leaves no hope.
        let open = seconds_to(1e-4, 2.0, &size(variance, [5e-5, -1e-4, 2e-4]));
        assert!(open.interval.is_none() && (open.at_least.expect("one") - 180.0).abs() < 1e-9);
        let never = seconds_to(1e-4, 2.0, &size(variance, [2e-3, 1e-3, 3e-3]));
        assert_eq!((never.value, never.at_least), (None, Some(f64::INFINITY)));
    }
}
