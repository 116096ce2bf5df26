//! What a reader should know before believing the figures of a comparison.

use super::findings::{EntrantResult, Findings, Step};
use etalon_film::light_carriers::{FEW, carriers};

/// The reference's noise is small if it is less than this share of an error.
const CONVERGED: f64 = 0.1;

/// The share of relMSE from which on bias is worth a word.
const MUCH_BIAS: f64 = 0.1;

/// The p-value of a power law below which it is called none.
const NO_LINE: f64 = 1e-3;

/// Where nothing but black was found.
#[derive(Clone, Debug)]
pub struct Black {
    /// Whether the reference is black.
    pub reference: bool,
    /// Whether all pictures of each estimator are.
    pub estimators: Vec<bool>,
}

/// Pictures of fewer samples per pixel say little of those that people render.
const ENOUGH_SAMPLES: u32 = 8;

/// Nor do pictures of fewer say much of an estimator that learns from its own.
const ENOUGH_TO_LEARN: u32 = 64;

/// How many times its efficiency a four times longer picture has, of an estimator that is still learning.
const STILL_LEARNING: f64 = 1.25;

/// Standard errors that this must be beyond.
const SURE: f64 = 2.0;

/// How many times the efficiency of a short picture a longer one has, as far as it is sure: the last size of the ladder against the
/// largest of at most a quarter of it.
fn growth(steps: &[Step]) -> Option<f64> {
    let last = steps.last()?;
    let before =
        (steps.iter().rev()).find(|s| 4 * s.samples_per_pixel <= last.samples_per_pixel)?;
    let cost = |step: &Step| step.mse * step.seconds;
    let ratio = cost(before) / cost(last);
    let error = |step: &Step| step.standard_error / step.mse;
    let spread = (error(last).powi(2) + error(before).powi(2)).sqrt();
    let least = ratio * (1.0 - SURE * spread);
    (before.mse > 0.0 && last.mse > 0.0 && least > 1.0 && ratio > STILL_LEARNING).then_some(ratio)
}

/// What is to be said of an estimator that learns, whose pictures were too short for it.
fn too_short(row: &EntrantResult) -> Option<String> {
    let (samples, seconds) = (
        row.equal_time.samples_per_pixel,
        row.equal_time.seconds.value?,
    );
    if !row.prepares {
        return None;
    }
    let length = format!(
        "`{}` learns or prepares for each picture, and those at equal time took {seconds:.2} s",
        row.name
    );
    let advice = "in longer ones it may stand otherwise: ask for the length of those you mean to render with `--picture-time`";
    let grown = growth(&row.convergence.steps);
    match grown {
        Some(ratio) => Some(format!(
            "{length}; its efficiency still grows, by {ratio:.1} from its shorter pictures to four times as long ones: {advice}"
        )),
        None if samples < ENOUGH_TO_LEARN => {
            Some(format!("{length}, {samples} samples per pixel: {advice}"))
        }
        None => None,
    }
}

/// What is to be said of pictures that were left out, of so many.
pub fn late([left_out, all]: [u32; 2]) -> Option<String> {
    (left_out > 0).then(|| {
        format!(
            "the machine was slower than in the pilot: {left_out} of {all} pictures were left out, to end in time"
        )
    })
}

/// What is to be said of an estimator whose error few of its pictures carry; these errors still have the reference's noise, which all
/// pictures share: without it those of an estimator at the noise have either sign, and nothing carries their sum.
pub fn few(name: &str, errors: &[f64]) -> Option<String> {
    let [sum, squares] = errors
        .iter()
        .fold([0.0; 2], |[sum, squares], x| [sum + x, squares + x * x]);
    let carriers = carriers(sum, squares);
    (carriers < FEW && errors.len() >= 8).then(|| {
        format!(
            "the error of `{name}` is that of {carriers:.1} of its {} pictures at equal time: samples that are rarer still \
             may be missing, and its figures say little",
            errors.len()
        )
    })
}

/// All remarks, each one sentence.
pub fn about(findings: &Findings, black: &Black) -> Vec<String> {
    let mut remarks = Vec::new();
    if black.reference && black.estimators.iter().all(|&black| black) {
        remarks.push(
            "the picture is black: not one sample found light, neither of the reference nor of any \
             estimator, so there is no error to compare"
                .to_owned(),
        );
        return remarks;
    }
    if black.reference {
        remarks.push(
            "the reference is black, and the scene is not: it says nothing of the errors; take another \
             estimator or a file for it"
                .to_owned(),
        );
    } else {
        reference(findings, &mut remarks);
    }
    let first = findings.estimators.first().map_or("", |row| &row.name);
    for (row, &black) in findings.estimators.iter().zip(&black.estimators) {
        if black {
            remarks.push(format!(
                "the pictures of `{}` are black: not one of its samples found light",
                row.name
            ));
            continue;
        }
        let shown = row.differences.iter().filter(|d| d.is_shown());
        let worst = shown.max_by(|a, b| a.relative.abs().total_cmp(&b.relative.abs()));
        if let Some(worst) = worst {
            remarks.push(format!(
                "`{}` and `{first}` do not estimate the same picture: their means of {} differ by {:+.3} %",
                row.name,
                worst.channel,
                100.0 * worst.relative
            ));
        }
        let bias = &row.equal_time.bias_squared;
        let share = bias.value.zip(row.equal_time.rel_mse.value);
        let share = share.map_or(0.0, |(bias, error)| bias / error);
        if bias.interval.is_some_and(|[low, _]| low > 0.0) && share > MUCH_BIAS {
            remarks.push(format!(
                "{:.0} % of the relMSE of `{}` is bias, which no more samples take away",
                100.0 * share.min(1.0),
                row.name
            ));
        }
        let samples = row.equal_time.samples_per_pixel;
        remarks.extend(too_short(row));
        if samples < ENOUGH_SAMPLES && !row.prepares {
            remarks.push(format!(
                "the pictures of `{}` have {samples} samples per pixel, fewer than a picture of use: give {:.0} times the time or \
                 more",
                row.name,
                (f64::from(ENOUGH_SAMPLES) / f64::from(samples.max(1))).ceil()
            ));
        }
        let noisy = row.equal_time.rel_mse.value != Some(0.0);
        if row.convergence.exponent.value.is_none() && !noisy {
            remarks.push(format!(
                "`{}` has no exponent: its pictures have no error at all",
                row.name
            ));
        } else if row.convergence.exponent.value.is_none() {
            remarks.push(format!(
                "`{}` has no exponent: {} sizes do not make a line; give more time",
                row.name,
                row.convergence.steps.len()
            ));
        }
        if let Some(p) = row.convergence.p_power_law.filter(|p| *p < NO_LINE) {
            remarks.push(format!(
                "the squared error of `{}` does not follow a power law (p = {p:.0e}): its exponent is \
                 that of a line through a curve",
                row.name
            ));
        }
        if row.non_finite > 0 {
            remarks.push(format!(
                "`{}` had {} contributions that were not finite; they were left out",
                row.name, row.non_finite
            ));
        }
    }
    filters(findings, &mut remarks);
    remarks
}

/// Whether the reference is good enough.
fn reference(findings: &Findings, remarks: &mut Vec<String>) {
    let Some(noise) = findings.reference.rel_mse else {
        remarks.push(
            "the reference has no standard errors: its own noise counts as everybody's error"
                .to_owned(),
        );
        return;
    };
    let errors = findings.estimators.iter();
    let errors = errors.filter_map(|row| Some((row.equal_time.rel_mse.value?, &row.name)));
    if let Some((error, name)) = errors.min_by(|a, b| a.0.total_cmp(&b.0))
        // Where there is neither noise nor error there is nothing to wish for.
        && !(noise < CONVERGED * error || noise == 0.0)
    {
        let share = match error > 0.0 {
            true => format!("{:.0} %", 100.0 * noise / error),
            false => "more than all".to_owned(),
        };
        remarks.push(format!(
            "the reference is not converged: its own relMSE, which was subtracted, is {share} of that \
             of `{name}`; give it more of the time, or a better file"
        ));
    }
}

/// Filters estimate different pictures, by design.
fn filters(findings: &Findings, remarks: &mut Vec<String>) {
    let mut rows = findings.estimators.iter();
    let Some(first) = rows.next() else { return };
    if rows.any(|row| row.filter != first.filter) {
        remarks.push(format!(
            "the filters differ, and so do the pictures they aim at: against a reference by `{}`, what \
             another filter blurs or sharpens counts as its bias",
            first.filter
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sizes 1, 2, 4 and 8 with these squared errors, known to a share of them; each sample takes a second.
    fn steps(errors: [f64; 4], share: f64) -> Vec<Step> {
        let step = |(samples_per_pixel, mse): (u32, f64)| Step {
            samples_per_pixel,
            replicates: 8,
            seconds: f64::from(samples_per_pixel),
            mse,
            standard_error: share * mse,
        };
        [1, 2, 4, 8].into_iter().zip(errors).map(step).collect()
    }

    /// Mutants rejected: growth where errors fall as 1/n; none where the last falls twice as fast; growth within the noise.
    #[test]
    fn who_still_learns_is_found() {
        assert_eq!(growth(&steps([1.0, 0.5, 0.25, 0.125], 0.01)), None);
        let learning = [1.0, 0.5, 0.2, 0.0625];
        let ratio = growth(&steps(learning, 0.05)).expect("it grows");
        assert!((ratio - 2.0).abs() < 1e-12, "{ratio}");
        assert_eq!(growth(&steps(learning, 0.4)), None, "not sure");
        assert_eq!(growth(&[]), None);
    }
}
