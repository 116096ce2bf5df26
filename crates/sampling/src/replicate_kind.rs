//! How the replicates of an image are related.

use crate::sampler::SampleId;
use serde::{Deserialize, Serialize};

/// How the samples of an image's replicates are related.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ReplicateKind {
    /// Each replicate has a scrambling of its own: replicates are independent.
    #[default]
    Independent,
    /// The replicates are consecutive blocks of one sequence per pixel. A block of n samples, n being a
    /// number that the sampler can stratify, is by itself what an independent replicate is; all of
    /// them together have the variance of one replicate of as many samples.
    ///
    /// The spread of the blocks overstates the variance of their mean by minus the mean covariance of
    /// two blocks, which is negative for nearly every integrand. There is no theorem: Owen's gain
    /// coefficients (1997) exceed one for some, such as a checkerboard that is aligned with the net.
    Blocks,
}

impl ReplicateKind {
    /// Its name in files and messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Blocks => "blocks",
        }
    }

    /// Whether replicates are independent.
    pub fn is_independent(&self) -> bool {
        *self == Self::Independent
    }

    /// The address from which a sample's numbers are drawn. `of` is the sample as it is counted
    /// within its replicate; `replicates` are those of the whole image.
    ///
    /// Any sizes are valid. If the samples of a replicate are no power of two, the blocks of `Sobol` are
    /// no nets by themselves, though each is unbiased; if `replicates` is none, they are only together
    /// no net.
    #[inline]
    pub fn address(self, of: SampleId, replicates: u32) -> SampleId {
        match self {
            Self::Independent => of,
            Self::Blocks => {
                let before = u64::from(of.replicate) * u64::from(of.samples_per_replicate);
                let index = before + u64::from(of.sample);
                SampleId {
                    // A sequence has 2³² points; more samples begin another one.
                    replicate: (index >> 32) as u32,
                    sample: index as u32,
                    blocks: replicates,
                    ..of
                }
            }
        }
    }
}
