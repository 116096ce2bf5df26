//! Pictures of a pilot, which fix how many samples an image gets and where, and are no part of it.

use crate::loaded::Loaded;
use crate::pipeline::{self, RenderControls};
use etalon_film::{RenderedImage, SampleCounts};
use etalon_integrators::{Progress, RenderPlan};
use etalon_params::Diagnostic;
use etalon_sampling::ReplicateKind;
use etalon_sampling::hash::{derived_key, mix64};

/// Pictures of a pilot that bounds an error.
pub const GROUPS: u32 = 8;

/// Sets the seeds of pilots apart from those of images.
const SEEDS: u64 = 0x7069_6c6f_7400_0001;

/// Why a pilot gives nothing.
#[derive(Debug)]
pub enum Failure {
    /// One message.
    Refused(Diagnostic),
    /// Somebody asked to stop.
    Cancelled,
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Self {
        Self::Refused(diagnostic)
    }
}

/// One picture of a pilot: two replicates, independent so that their spread is the noise of one.
pub(crate) fn pilot_picture(
    loaded: &Loaded,
    plan: &RenderPlan,
    counts: Option<SampleCounts>,
    index: u32,
    samples: u32,
    progress: &dyn Progress,
) -> Result<(RenderedImage, f64), Failure> {
    let small = RenderPlan {
        seed: derived_key(mix64(plan.seed ^ SEEDS), index),
        replicates: 2,
        replicate_kind: ReplicateKind::Independent,
        samples_per_replicate: samples,
        ..*plan
    };
    let manner = RenderControls {
        counts,
        ..RenderControls::default()
    };
    let rendered = pipeline::render_as(loaded, &small, manner, progress)?;
    if progress.cancelled() {
        return Err(Failure::Cancelled);
    }
    Ok((rendered.developed, rendered.time.as_secs_f64()))
}
