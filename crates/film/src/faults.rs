//! Numbers a film refuses: how many there were, and where the first of them came from.

use etalon_statistics::InvalidValue;
use serde::{Deserialize, Serialize};

/// Why a number was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InvalidKind {
    /// Not a number.
    Nan,
    /// Infinite.
    Infinite,
    /// Larger than the accumulators' range.
    Overflow,
}

impl From<InvalidValue> for InvalidKind {
    fn from(fault: InvalidValue) -> Self {
        match fault {
            InvalidValue::NotANumber => Self::Nan,
            InvalidValue::Infinite => Self::Infinite,
            InvalidValue::OutOfRange => Self::Overflow,
        }
    }
}

/// The address of a refused number: enough to compute the sample again.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct InvalidSample {
    /// The replicate.
    pub replicate: u32,
    /// The pixel for which the sample was drawn; it may lie a little outside of the film.
    pub pixel: [i32; 2],
    /// The index of the sample within the pixel and replicate; absent where only the sum of
    /// many is out of range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample: Option<u32>,
    /// `radiance`, `splat` or the name of a channel.
    pub source: String,
    /// The kind of fault.
    pub kind: InvalidKind,
}

impl InvalidSample {
    /// The order of a render on one thread, so that "the first" are the same on many.
    fn key(&self) -> impl Ord + '_ {
        let [x, y] = self.pixel;
        (
            self.replicate,
            y,
            x,
            self.sample,
            self.source.as_str(),
            self.kind,
        )
    }
}

/// Counts of refused numbers, and the first few.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FaultLog {
    /// Not numbers.
    pub nan: u64,
    /// Infinities.
    pub infinite: u64,
    /// Out of range.
    pub overflow: u64,
    /// The first [`FaultLog::KEPT`] in the order replicate, row, column, sample.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub first: Vec<InvalidSample>,
}

impl FaultLog {
    /// Number of faults that are kept.
    pub const KEPT: usize = 8;

    /// All kinds together.
    pub fn total(&self) -> u64 {
        self.nan
            .saturating_add(self.infinite)
            .saturating_add(self.overflow)
    }

    /// Whether nothing was refused.
    pub fn is_empty(&self) -> bool {
        self.total() == 0
    }

    /// Counts an offence and keeps it if it is among the first.
    pub(crate) fn note(&mut self, offence: InvalidSample) {
        match offence.kind {
            InvalidKind::Nan => self.nan += 1,
            InvalidKind::Infinite => self.infinite += 1,
            InvalidKind::Overflow => self.overflow += 1,
        }
        self.keep(offence);
    }

    /// Adds another log; the order of additions does not matter.
    pub(crate) fn merge(&mut self, other: Self) {
        self.nan = self.nan.saturating_add(other.nan);
        self.infinite = self.infinite.saturating_add(other.infinite);
        self.overflow = self.overflow.saturating_add(other.overflow);
        other
            .first
            .into_iter()
            .for_each(|offence| self.keep(offence));
    }

    fn keep(&mut self, offence: InvalidSample) {
        let place = self
            .first
            .partition_point(|kept| kept.key() <= offence.key());
        if place < Self::KEPT {
            self.first.insert(place, offence);
            self.first.truncate(Self::KEPT);
        }
    }
}
