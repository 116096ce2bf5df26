//! The plan of a render: number of replicates, samples per replicate, and the source of random numbers.

use crate::render::ReplicateRange;
use etalon_sampling::{ReplicateKind, SampleId, SamplerKind};
#[cfg(doc)]
use etalon_transport::Integrator;
use glam::UVec2;

/// The plan of a render.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderPlan {
    /// The seed of the image.
    pub seed: u64,
    /// Replicates of the image.
    pub replicates: u32,
    /// How they are related. Blocks are for integrators that declare them ([`Integrator::replicate_kind`]).
    pub replicate_kind: ReplicateKind,
    /// The replicates that are rendered here; `None` for all of them.
    pub share: Option<ReplicateRange>,
    /// Samples per pixel in each replicate.
    pub samples_per_replicate: u32,
    /// The kind of sampler.
    pub sampler: SamplerKind,
}

impl RenderPlan {
    /// The replicates that are rendered.
    pub fn share(&self) -> ReplicateRange {
        self.share.unwrap_or(ReplicateRange {
            first: 0,
            count: self.replicates,
        })
    }

    /// Where a sample's numbers are drawn from: sample `sample` of `dealt` that the pixel gets in a
    /// replicate.
    #[inline]
    pub(crate) fn address(
        &self,
        replicate: u32,
        pixel: UVec2,
        sample: u32,
        dealt: u32,
    ) -> SampleId {
        let within = SampleId {
            seed: self.seed,
            replicate,
            pixel: pixel.into(),
            sample,
            samples_per_replicate: dealt,
            blocks: 1,
        };
        self.replicate_kind.address(within, self.replicates)
    }
}
