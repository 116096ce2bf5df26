//! The findings as text for a terminal.

use super::findings::{EntrantResult, Findings, Uncertain};
use super::reference::ReferenceOrigin;

/// The whole text.
pub fn text(findings: &Findings) -> String {
    let rows = &findings.estimators;
    let longest = rows.iter().map(|row| row.name.chars().count()).max();
    let width = longest.unwrap_or(0).max("estimator".len());
    let first = rows.first().map_or("", |row| &row.name);
    let percent = 100.0 * findings.confidence;
    let mut text = format!("{}\n\n", reference(findings));
    text += &format!(
        "equal time: pictures of about {} s\n{:<width$}  {:>7}  {:>8}  {:>9}  {:>9}  {:>10}  {:>10}  x {first}\n",
        length(findings),
        "estimator",
        "spp",
        "seconds",
        "relMSE",
        "variance",
        "bias²",
        "1/(e·s)"
    );
    for row in rows {
        let size = &row.equal_time;
        let gain = row.gains.as_ref().map(|gains| factor(&gains.efficiency));
        text += &format!(
            "{:<width$}  {:>7}  {:>8}  {:>9}  {:>9}  {:>10}  {:>10}  {}\n",
            row.name,
            size.samples_per_pixel,
            number(size.seconds.value),
            number(size.rel_mse.value),
            number(size.variance.value),
            number(size.bias_squared.value),
            number(row.efficiency.value),
            gain.unwrap_or_default()
        );
    }
    let equal = rows
        .first()
        .map_or(0, |row| row.equal_samples.samples_per_pixel);
    text += &format!(
        "\nequal samples: {equal} per pixel\n{:<width$}  {:>9}  {:<22}  {:>9}  {:<22}\n",
        "estimator",
        "ns/sample",
        format!("faster than {}", shortened(first)),
        "relMSE",
        "lower by"
    );
    for row in rows {
        let gains = row.gains.as_ref();
        let told = |gain: Option<&Uncertain>| gain.map(factor).unwrap_or_default();
        text += &format!(
            "{:<width$}  {:>9.0}  {:<22}  {:>9}  {:<22}\n",
            row.name,
            row.nanoseconds_per_sample,
            told(gains.map(|gains| &gains.speed)),
            number(row.equal_samples.rel_mse.value),
            told(gains.map(|gains| &gains.error_at_equal_samples)),
        );
    }
    text += &format!(
        "\n{:<width$}  {:<32}  {:<24}  {}\n",
        "estimator", "mean difference, widest channel", "exponent of mse", "to 1 % error"
    );
    for row in rows {
        text += &format!(
            "{:<width$}  {:<32}  {:<24}  {}\n",
            row.name,
            difference(row),
            exponent(&row.convergence.exponent),
            time(&row.seconds_to_one_percent)
        );
    }
    text += &format!("\nintervals: {percent} %\n");
    for remark in &findings.remarks {
        text += &format!("note: {remark}\n");
    }
    let lines = text.lines().map(|line| format!("{}\n", line.trim_end()));
    lines.collect()
}

/// How long a picture at equal time took: the mean over estimators.
fn length(findings: &Findings) -> String {
    let times: Vec<f64> = (findings.estimators.iter())
        .filter_map(|row| row.equal_time.seconds.value)
        .collect();
    number((!times.is_empty()).then(|| times.iter().sum::<f64>() / times.len() as f64))
}

/// Where the reference comes from, in a sentence.
pub fn reference(findings: &Findings) -> String {
    let origin = match &findings.reference.origin {
        ReferenceOrigin::File {
            path,
            integrator,
            samples_per_pixel,
        } => {
            let by = integrator.as_ref().map(|name| format!(" by `{name}`"));
            let spp = samples_per_pixel.map(|spp| format!(", {spp} samples per pixel"));
            let (by, spp) = (by.unwrap_or_default(), spp.unwrap_or_default());
            format!("reference: {path}{by}{spp}")
        }
        ReferenceOrigin::Rendered {
            estimator,
            sampler,
            samples_per_replicate,
            replicates,
            seed,
            share_of_time,
        } => format!(
            "reference: rendered with `{estimator}` ({sampler}), {} samples per pixel in {replicates} \
             replicates, seed {seed:#x}, {:.0} % of the time",
            u64::from(*samples_per_replicate) * u64::from(*replicates),
            100.0 * share_of_time
        ),
    };
    let noise = match findings.reference.rel_mse {
        Some(noise) => format!("; its own relMSE {} is subtracted", number(Some(noise))),
        None => String::new(),
    };
    origin + &noise
}

fn shortened(name: &str) -> String {
    match name.char_indices().nth(10) {
        Some((end, _)) => format!("{}…", &name[..end]),
        None => name.to_owned(),
    }
}

/// Three digits.
pub fn number(value: Option<f64>) -> String {
    let Some(value) = value.filter(|value| value.is_finite()) else {
        return "–".to_owned();
    };
    let size = value.abs();
    match size {
        0.0 => "0".to_owned(),
        _ if !(1e-3..1e6).contains(&size) => format!("{value:.2e}"),
        _ if size >= 100.0 => format!("{value:.0}"),
        _ if size >= 10.0 => format!("{value:.1}"),
        _ if size >= 1.0 => format!("{value:.2}"),
        _ => format!("{value:.4}"),
    }
}

/// A ratio with what is known of it.
pub fn factor(gain: &Uncertain) -> String {
    let value = number(gain.value);
    match (gain.interval, gain.at_least) {
        (Some([low, high]), _) => {
            format!("{value} [{}, {}]", number(Some(low)), number(Some(high)))
        }
        (None, Some(bound)) => format!("{value} [≥ {}]", number(Some(bound))),
        (None, None) => "unknown".to_owned(),
    }
}

/// The mean's difference in the channel that allows most.
pub fn difference(row: &EntrantResult) -> String {
    let Some(worst) = row.widest_difference() else {
        return String::new();
    };
    let interval = match worst.interval {
        Some([low, high]) => format!("[{:+.3}, {:+.3}]", 100.0 * low, 100.0 * high),
        None => "undecided".to_owned(),
    };
    let value = 100.0 * worst.relative;
    format!("{} {value:+.3} % {interval}", worst.channel)
}

/// An exponent with its interval.
pub fn exponent(exponent: &Uncertain) -> String {
    match (exponent.value, exponent.interval) {
        (Some(value), Some([low, high])) => format!("{value:.2} [{low:.2}, {high:.2}]"),
        _ => "–".to_owned(),
    }
}

/// A time with what is known of it.
pub fn time(seconds: &Uncertain) -> String {
    match (seconds.value, seconds.interval, seconds.at_least) {
        (Some(value), Some([low, high]), _) => format!(
            "{} s [{}, {}]",
            number(Some(value)),
            number(Some(low)),
            number(Some(high))
        ),
        (Some(value), None, Some(bound)) => {
            format!("{} s [≥ {}]", number(Some(value)), number(Some(bound)))
        }
        (None, _, Some(bound)) if bound.is_infinite() => "never".to_owned(),
        (None, _, Some(bound)) => format!("at least {} s", number(Some(bound))),
        (Some(value), None, None) => format!("{} s", number(Some(value))),
        _ => "unknown".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        let shown = [0.0, 123456.0, 99.94, 1.2345, 0.012345, -0.5, 3.2e-5, 4.5e7].map(Some);
        assert_eq!(
            shown.map(number),
            [
                "0", "123456", "99.9", "1.23", "0.0123", "-0.5000", "3.20e-5", "4.50e7"
            ]
        );
        assert_eq!([None, Some(f64::NAN)].map(number), ["–", "–"]);
    }

    #[test]
    fn what_is_not_known_is_said() {
        let known = Uncertain {
            value: Some(2.0),
            interval: Some([1.5, 3.0]),
            at_least: None,
        };
        let bound = Uncertain {
            interval: None,
            at_least: Some(1.2),
            ..known
        };
        let never = Uncertain {
            value: None,
            at_least: Some(f64::INFINITY),
            ..bound
        };
        let open = Uncertain::default();
        assert_eq!(
            [known, bound, open].map(|u| factor(&u)),
            ["2.00 [1.50, 3.00]", "2.00 [≥ 1.20]", "unknown"]
        );
        let times = [known, bound, never, open].map(|u| time(&u));
        assert_eq!(
            times,
            ["2.00 s [1.50, 3.00]", "2.00 s [≥ 1.20]", "never", "unknown"]
        );
        assert_eq!(
            [known, open].map(|u| exponent(&u)),
            ["2.00 [1.50, 3.00]", "–"]
        );
    }
}
