//! What a test by resampling says, and what it cannot say.
//!
//! Counting *all* rearrangements that the hypothesis makes equally probable, the p-value is the share
//! that is at least as extreme as what was observed. Of B random ones it is (1 + those) / (1 + B),
//! which is valid for every B (Phipson & Smyth 2010). No level below the smallest possible p-value
//! can be reached: a claim that needs one stays undecided.

/// The outcome of a sign-flip or permutation test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResamplingTest {
    /// The probability of an outcome at least as extreme, under the hypothesis.
    pub p_value: f64,
    /// The smallest p-value the test could have given.
    pub least: f64,
    /// Whether all rearrangements were counted.
    pub exact: bool,
}

impl ResamplingTest {
    /// All of `possible` were counted; each has `images` that are as extreme, itself included.
    pub(crate) fn exact(extreme: u64, possible: u64, images: u64) -> Self {
        Self {
            p_value: extreme as f64 / possible as f64,
            least: images as f64 / possible as f64,
            exact: true,
        }
    }

    /// This many of `resamples` random ones were as extreme.
    pub(crate) fn drawn(extreme: u64, resamples: u64) -> Self {
        let possible = resamples as f64 + 1.0;
        Self {
            p_value: (extreme as f64 + 1.0) / possible,
            least: 1.0 / possible,
            exact: false,
        }
    }
}
