//! What went wrong in a render, sample by sample: numbers that were refused, and fireflies.
//!
//! A firefly is a sample that brings more than all others of its pixel and replicate together, and
//! lifts its pixel in the finished image by more than the image's mean (of its brightest colour);
//! see [`etalon_film::outliers`]. The mean is rounded up to a power of two over the replicates.

use super::again;
use crate::args::RenderArgs;
use etalon_film::{FaultLog, Metadata, Outlier, OutlierLog, RenderedImage};
use etalon_integrators::RenderPlan;
use serde_json::{Value, json};

/// The fireflies of an image.
pub(super) struct Fireflies<'a> {
    /// How many there are.
    pub(super) count: u64,
    /// By how much each lifts its pixel at least.
    from: f64,
    /// The image's mean in its brightest colour.
    mean: f64,
    /// The largest samples that stand out, fireflies only.
    largest: Vec<&'a Outlier>,
    replicates: f64,
}

impl<'a> Fireflies<'a> {
    /// Those of an image; `None` where there is no mean to compare with.
    pub(super) fn of(developed: &RenderedImage, metadata: &'a Metadata) -> Option<Self> {
        let colours = developed.colours();
        let means = colours.iter().filter_map(|name| {
            let pixels = developed.image.channel(name)?;
            Some(pixels.iter().map(|&x| f64::from(x)).sum::<f64>() / pixels.len() as f64)
        });
        let mean = means.fold(0.0, f64::max);
        let replicates = f64::from(metadata.replicates);
        let exponent = OutlierLog::exponent_above((mean * replicates) as f32)?;
        let log = &metadata.outliers;
        let count = log.count_from(exponent);
        let largest = log.largest().iter().take(count as usize);
        Some(Self {
            count,
            from: power_of_two(exponent) / replicates,
            mean,
            largest: largest.collect(),
            replicates,
        })
    }

    /// The largest.
    pub(super) fn first(&self) -> Option<&'a Outlier> {
        self.largest.first().copied()
    }

    /// The largest ones, the largest first.
    pub(super) fn largest(&self) -> impl Iterator<Item = &'a Outlier> {
        self.largest.iter().copied()
    }

    /// By how much a sample lifts its pixel in the image.
    pub(super) fn lift(&self, outlier: &Outlier) -> f64 {
        f64::from(outlier.lift) / self.replicates
    }

    fn to_json(&self, again: &Again<'_>) -> Value {
        let each = self.largest.iter().map(|&outlier| {
            json!({
                "pixel": outlier.pixel,
                "replicate": outlier.replicate,
                "sample": outlier.sample,
                "seed": again.plan.seed,
                "value": outlier.value,
                "lift": self.lift(outlier),
                "replay": again.of_outlier(outlier),
            })
        });
        json!({
            "count": self.count,
            "lift_from": self.from,
            "mean": self.mean,
            "largest": each.collect::<Vec<_>>(),
        })
    }
}

/// 2ᵉ, exactly.
fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((1023 + i64::from(exponent)) as u64) << 52)
}

/// How to draw samples of a render again.
#[derive(Clone, Copy)]
pub(super) struct Again<'a> {
    pub(super) args: &'a RenderArgs,
    pub(super) plan: &'a RenderPlan,
    /// The size of the pilot that dealt the samples, if they were not dealt evenly.
    pub(super) pilot: Option<u32>,
}

impl Again<'_> {
    fn command(&self, pixel: [i32; 2], replicate: u32, sample: u32) -> String {
        again::command(self.args, self.plan, self.pilot, pixel, replicate, sample)
    }

    /// The command for a sample that stands out.
    pub(super) fn of_outlier(&self, outlier: &Outlier) -> String {
        let pixel = outlier.pixel.map(u32::cast_signed);
        self.command(pixel, outlier.replicate, outlier.sample)
    }

    /// The command for the first refused number that a single sample is to blame for.
    pub(super) fn of_faults(&self, faults: &FaultLog) -> Option<String> {
        let mut first = faults.first.iter();
        first.find_map(|o| Some(self.command(o.pixel, o.replicate, o.sample?)))
    }
}

/// The refused numbers for `--stats`.
pub(super) fn faults_to_json(faults: &FaultLog, again: &Again<'_>) -> Value {
    let first = faults.first.iter().map(|o| {
        let replay = o.sample.map(|s| again.command(o.pixel, o.replicate, s));
        json!({
            "pixel": o.pixel,
            "replicate": o.replicate,
            "sample": o.sample,
            "seed": again.plan.seed,
            "source": o.source,
            "kind": o.kind,
            "replay": replay,
        })
    });
    json!({
        "nan": faults.nan,
        "infinite": faults.infinite,
        "overflow": faults.overflow,
        "first": first.collect::<Vec<_>>(),
    })
}

/// The fireflies for `--stats`.
pub(super) fn fireflies_to_json(
    developed: &RenderedImage,
    metadata: &Metadata,
    again: &Again<'_>,
) -> Value {
    Fireflies::of(developed, metadata).map_or(Value::Null, |found| found.to_json(again))
}
