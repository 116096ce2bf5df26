//! The place of a part in the whole image.

use crate::ReplicateSet;
use serde::{Deserialize, Serialize};

/// The place of a part in the whole image.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PartFacts {
    /// Replicates of the whole picture.
    pub of: u32,
    /// Those that are here, counted from 0.
    pub replicates: ReplicateSet,
    /// BLAKE3 over everything else that a file says of itself, but its time, and the exact sums.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub checksum: String,
}

impl PartFacts {
    /// The most replicates whose exact sums cannot leave their range.
    pub const MOST: u32 = 1 << 15;

    /// Checks them against a picture of `count` replicates. There may be none if one was begun.
    pub(crate) fn check(&self, count: u32, spp: u64, begun: bool) -> Result<(), String> {
        let sound = self.of <= Self::MOST
            && self.replicates.end() <= self.of
            && (begun || !self.replicates.is_empty())
            && self.replicates.count() == count
            && spp.is_multiple_of(count.into())
            && spp / u64::from(count.max(1)) <= u32::MAX.into();
        if sound {
            return Ok(());
        }
        let (of, here) = (self.of, &self.replicates);
        Err(format!(
            "they are of the replicates {here} of {of}, but also of {count} with {spp} samples"
        ))
    }
}
