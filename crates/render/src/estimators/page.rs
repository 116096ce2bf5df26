//! The findings as a self-contained HTML page.

use super::findings::{EntrantResult, Findings, Uncertain};
use super::table::{difference, exponent, factor, number, reference, time};
use crate::report;
use crate::report::album::Album;
use crate::report::exposed;
use crate::report::plot::{self, Curve};
use etalon_images::Image;
use maud::{Markup, html};

/// The whole page; `command` is how to make it again.
pub fn page(findings: &Findings, command: &str) -> String {
    let body = html! {
        p { code { (findings.scene) } ", " (findings.size[0]) " × " (findings.size[1]) " pixels, "
            (findings.threads) " threads, " (number(Some(findings.seconds_taken))) " s. "
            "Intervals: " (100.0 * findings.confidence) " %." }
        p { (prose(&reference(findings))) "." }
        @if !findings.remarks.is_empty() {
            ul class="remarks" { @for remark in &findings.remarks { li { (prose(remark)) } } }
        }
        h2 { "Equal time" }
        p { "Efficiency is 1 / (relMSE · seconds), bias included." }
        (equal_time(findings))
        (plot::bars(&efficiencies(findings), "efficiency"))
        h2 { "Equal samples" }
        (equal_samples(findings))
        h2 { "Means" }
        (means(findings))
        h2 { "Convergence" }
        p { "The mean squared error of one picture against its samples per pixel; bars are standard "
            "errors, dashed lines power laws." }
        (plot::curves(&convergence(findings), "samples per pixel", "mean squared error"))
        (exponents(findings))
        p { "The same against the time of one picture." }
        (plot::curves(&over_time(findings), "seconds", "mean squared error"))
        h2 { "Pictures at equal time" }
        (pictures(findings))
        h2 { "Again" }
        pre { (command) }
        p { "Etalon " (findings.version) ", scene " code { (findings.scene_hash) } ", seed "
            (findings.seed) ". How much each estimator renders follows from the machine's speed; what it "
            "renders follows from the seed." }
    };
    report::page("Estimators compared", &body)
}

/// Text with code between backticks.
fn prose(text: &str) -> Markup {
    html! {
        @for (index, part) in text.split('`').enumerate() {
            @if index % 2 == 0 { (part) } @else { code { (part) } }
        }
    }
}

fn first(findings: &Findings) -> &str {
    findings.estimators.first().map_or("", |row| &row.name)
}

fn with_interval(uncertain: &Uncertain) -> Markup {
    html! {
        (number(uncertain.value))
        @if let Some([low, high]) = uncertain.interval {
            br; small { (number(Some(low))) " …" br; (number(Some(high))) }
        }
    }
}

fn gain(row: &EntrantResult, of: impl Fn(&super::findings::Gains) -> Uncertain) -> String {
    row.gains
        .as_ref()
        .map_or_else(|| "1".to_owned(), |gains| factor(&of(gains)))
}

fn equal_time(findings: &Findings) -> Markup {
    html! {
        table {
            tr { th { "estimator" } th { "samples per pixel" } th { "pictures" } th { "seconds" }
                 th { "relMSE" } th { "variance" } th { "bias²" } th { "efficiency (1/s)" }
                 th { "times " (first(findings)) } th { "to 1 % error" } }
            @for row in &findings.estimators {
                @let size = &row.equal_time;
                tr {
                    td { (row.name) }
                    td { (size.samples_per_pixel) }
                    td { (size.replicates) }
                    td { (with_interval(&size.seconds)) }
                    td { (with_interval(&size.rel_mse)) }
                    td { (with_interval(&size.variance)) }
                    td { (with_interval(&size.bias_squared)) }
                    td { (with_interval(&row.efficiency)) }
                    td { (gain(row, |gains| gains.efficiency)) }
                    td { (time(&row.seconds_to_one_percent)) }
                }
            }
        }
    }
}

fn equal_samples(findings: &Findings) -> Markup {
    html! {
        table {
            tr { th { "estimator" } th { "samples per pixel" } th { "ns per sample" }
                 th { "faster than " (first(findings)) } th { "relMSE" } th { "variance" }
                 th { "relMSE lower by" } }
            @for row in &findings.estimators {
                @let size = &row.equal_samples;
                tr {
                    td { (row.name) }
                    td { (size.samples_per_pixel) }
                    td { (format!("{:.0}", row.nanoseconds_per_sample)) }
                    td { (gain(row, |gains| gains.speed)) }
                    td { (with_interval(&size.rel_mse)) }
                    td { (with_interval(&size.variance)) }
                    td { (gain(row, |gains| gains.error_at_equal_samples)) }
                }
            }
        }
    }
}

fn means(findings: &Findings) -> Markup {
    html! {
        table {
            tr { th { "estimator" } th { "R" } th { "G" } th { "B" }
                 th { "widest difference from " (first(findings)) } th { "interval by" } }
            @for row in &findings.estimators {
                tr {
                    td { (row.name) }
                    @for mean in row.means { td { (format!("{mean:.5}")) } }
                    td { (difference(row)) }
                    td { (row.widest_difference().and_then(|d| d.method).unwrap_or_default()) }
                }
            }
        }
    }
}

fn exponents(findings: &Findings) -> Markup {
    html! {
        table {
            tr { th { "estimator" } th { "exponent" } th { "p of a power law" } }
            @for row in &findings.estimators {
                tr {
                    td { (row.name) }
                    td { (exponent(&row.convergence.exponent)) }
                    td { (number(row.convergence.p_power_law)) }
                }
            }
        }
    }
}

fn efficiencies(findings: &Findings) -> Vec<(String, Uncertain)> {
    let rows = findings.estimators.iter();
    rows.map(|row| (row.name.clone(), row.efficiency)).collect()
}

fn convergence(findings: &Findings) -> Vec<Curve> {
    let curve = |row: &EntrantResult| {
        let law = &row.convergence;
        let samples = |step: &super::findings::Step| f64::from(step.samples_per_pixel);
        let end = |step: Option<&super::findings::Step>| {
            let x = samples(step?);
            Some([x, law.fitted(x)?])
        };
        Curve {
            name: row.name.clone(),
            points: (law.steps.iter())
                .map(|step| [samples(step), step.mse, step.standard_error])
                .collect(),
            fit: end(law.steps.first())
                .zip(end(law.steps.last()))
                .map(|(a, b)| [a, b]),
        }
    };
    findings.estimators.iter().map(curve).collect()
}

fn over_time(findings: &Findings) -> Vec<Curve> {
    let curve = |row: &EntrantResult| Curve {
        name: row.name.clone(),
        points: (row.convergence.steps.iter())
            .map(|step| [step.seconds, step.mse, step.standard_error])
            .collect(),
        fit: None,
    };
    findings.estimators.iter().map(curve).collect()
}

fn pictures(findings: &Findings) -> Markup {
    let size = findings.size;
    let mut album = Album::new();
    let rows = findings
        .estimators
        .iter()
        .zip(&findings.pictures.estimators);
    html! {
        (exposed::slider())
        div class="pictures" {
            (exposed::figure(&mut album, &image(&findings.pictures.reference, size), "reference"))
            @for (row, pixels) in rows {
                @let caption = format!("{}, {} samples per pixel, {} s", row.name,
                    row.equal_time.samples_per_pixel, number(row.equal_time.seconds.value));
                (exposed::figure(&mut album, &image(pixels, size), &caption))
            }
        }
        (album.markup())
    }
}

/// Interleaved pixels as planes.
fn image(pixels: &[f32], [width, height]: [usize; 2]) -> Image {
    let mut image = Image::new(width, height);
    for (position, name) in ["R", "G", "B"].into_iter().enumerate() {
        let plane = pixels.iter().skip(position).step_by(3).copied();
        image.push(name, plane.collect());
    }
    image
}
