//! Against the numbers of Mitsuba 3.9.1 (`mitsuba_values.txt`, written by `mitsuba_values.py`).

use crate::scene::Sample;
use etalon_transport::{Bsdf, SamplePdf, TransportMode};
use glam::{Vec2, Vec3, Vec4};

const VALUES: &str = include_str!("mitsuba_values.txt");

fn numbers(text: &str) -> Vec<f32> {
    text.split_whitespace()
        .map(|word| word.parse().expect("a number"))
        .collect()
}

fn vector(text: &str) -> Vec3 {
    Vec3::from_slice(&numbers(text))
}

fn lanes(text: &str) -> Vec4 {
    match numbers(text)[..] {
        [value] => Vec4::splat(value),
        ref values => Vec4::from_slice(values),
    }
}

/// The relative difference that a record may have.
///
/// 2·10⁻⁴ is what single precision leaves of normals and half-vectors at grazing angles on either
/// side. `roughplastic` differs by more, since Mitsuba integrates its tables with another
/// quadrature of the same order, and `hair`, since Mitsuba sums ten terms of I₀ where more count.
fn tolerance(material: &str) -> f32 {
    if material.contains("roughplastic") {
        1e-3
    } else if material.contains("hair") {
        8e-3
    } else {
        2e-4
    }
}

fn close(a: Vec4, b: Vec4, relative: f32) -> bool {
    (a - b)
        .abs()
        .cmple(b.abs() * relative + Vec4::splat(1e-7))
        .all()
}

/// Whether our choice among lobes is Mitsuba's too, so that densities must agree: not for the
/// coats (ours goes by albedo at the angle), nor for tables (ours has a diffuse share)
/// and hair (ours goes by wavelength), nor for Beckmann's visible normals (ours is exact,
/// Mitsuba's uses the rational G1).
fn same_density(material: &str) -> bool {
    !material.contains("plastic")
        && !material.contains("measured")
        && !material.contains("hair")
        && (!material.contains("rough")
            || material.contains("ggx")
            || material.contains("sample_visible=b:false"))
}

#[test]
fn values_agree_with_mitsuba() {
    let mut sample = None;
    let mut failures = Vec::new();
    let mut records = 0;
    for line in VALUES.lines() {
        if let Some(text) = line.strip_prefix("material ") {
            sample = Some(Sample::new(text));
            continue;
        }
        let sample = sample.as_ref().expect("a material comes first");
        let fields: Vec<&str> = line.split(" ; ").collect();
        let head: Vec<&str> = fields[0].split_whitespace().collect();
        let mode = match head[1] {
            "radiance" => TransportMode::Radiance,
            _ => TransportMode::Importance,
        };
        let (wo, wi) = (vector(fields[1]), vector(fields[2]));
        let (value, pdf) = (lanes(fields[3]), lanes(fields[4]).x);
        if wo.z < 0.0 && sample.material().is_one_way() {
            // No curve is seen from inside; Mitsuba then takes the way across the hair from the wrong side.
            continue;
        }
        let bsdf = sample.at(wo);
        let relative = tolerance(&sample.text);
        records += 1;
        let mut fail = |what: &str, ours: String| {
            failures.push(format!("{}\n  {line}\n  {what} {ours}", sample.text));
        };
        if head[0] == "eval" {
            let (ours, density) = bsdf.eval_and_density(wo, wi, mode);
            if !close(ours, value, relative) {
                fail("value", format!("{ours}"));
            }
            if same_density(&sample.text) && !close(density.lanes(), Vec4::splat(pdf), relative) {
                fail("density", format!("{}", density.lanes()));
            }
        } else if head[0] == "albedo" {
            let ours = bsdf.albedo(wo);
            if !close(ours, value, relative) {
                fail("albedo", format!("{ours}"));
            }
        } else {
            // Mitsuba's passing light comes first or last, as the number for its lobe says; ours
            // is found by its direction.
            let found = [1e-6, 0.9999f32, 0.5]
                .into_iter()
                .filter_map(|u_lobe| bsdf.sample(wo, u_lobe, Vec2::new(0.3, 0.6), mode))
                .find(|s| s.chance_is_discrete() && (s.wi - wi).length() < 1e-4);
            match found {
                Some(s) => {
                    let eta = lanes(fields[5]).x;
                    if !close(s.value, value, relative) || (s.eta - eta).abs() > 1e-5 * eta {
                        fail("sample", format!("{s:?}"));
                    }
                }
                None => fail("sample", "not found".to_owned()),
            }
        }
    }
    assert!(records > 700, "{records}");
    assert!(
        failures.is_empty(),
        "{} of {records} records differ:\n{}",
        failures.len(),
        failures[..failures.len().min(20)].join("\n")
    );
}

trait Discrete {
    fn chance_is_discrete(&self) -> bool;
}

impl Discrete for etalon_transport::BsdfSample {
    fn chance_is_discrete(&self) -> bool {
        matches!(self.chance, SamplePdf::Discrete(_))
    }
}
