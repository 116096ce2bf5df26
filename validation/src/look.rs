//! What each look at a comparison saw.

use crate::run::{Compared, WorstNumber};
use etalon_statistics::Verdict;
use serde::Serialize;

/// One look.
#[derive(Clone, Debug, Serialize)]
pub struct Look {
    /// Samples per pixel so far, all replicates together.
    pub spp: u64,
    /// Independent replicates so far.
    pub replicates: u32,
    /// The level that the look was granted.
    pub level: f64,
    /// The p-value of "no fault" at this look.
    pub p: f64,
    /// The channel whose interval reaches farthest, or the measure with the smallest p-value.
    pub of: String,
    /// Its relative bias, or the measure's number.
    pub value: f64,
    /// Its interval.
    pub interval: [f64; 2],
    /// The decision at this look's level.
    #[serde(serialize_with = "as_text")]
    pub verdict: Verdict,
    /// Seconds spent so far.
    pub seconds: f64,
}

fn as_text<S: serde::Serializer>(verdict: &Verdict, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(verdict)
}

impl Look {
    /// What was seen; `None` if there was nothing to see.
    pub fn of(compared: &Compared, level: f64, seconds: f64) -> Option<Self> {
        let (of, value, interval) = match compared.worst()? {
            WorstNumber::Channel(image) => (&image.channel, image.bias, image.interval),
            WorstNumber::Measure(measure) => (&measure.name, measure.value, measure.interval),
        };
        Some(Self {
            spp: compared.spp,
            replicates: compared.replicates,
            level,
            p: compared.p,
            of: of.clone(),
            value,
            interval,
            verdict: compared.verdict,
            seconds,
        })
    }
}
