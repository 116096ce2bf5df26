//! How much is rendered.

use crate::judge::Verdict;
use crate::question::Question;
use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// How much is rendered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tier {
    /// The questions of few samples, 16 pictures of each.
    Quick,
    /// All, 32 pictures of each; four times as many of what is undecided, and some with four times the samples of what does not agree.
    #[default]
    Standard,
    /// As standard, and some pictures with four times the samples of everything.
    Full,
}

const ALL: [Tier; 3] = [Tier::Quick, Tier::Standard, Tier::Full];

impl Tier {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Quick => "quick",
            Self::Standard => "standard",
            Self::Full => "full",
        }
    }

    /// Whether it asks a question.
    pub fn asks(self, question: &Question) -> bool {
        match self {
            Self::Quick => question.samples <= 64,
            Self::Standard | Self::Full => true,
        }
    }

    /// Whether it asks a question that has this verdict with more samples.
    pub fn refines(self, verdict: &Verdict) -> bool {
        match (self, verdict) {
            (Self::Quick, _) | (_, Verdict::NotSupported(_) | Verdict::Broken(_)) => false,
            (Self::Standard, verdict) => *verdict != Verdict::Agrees,
            (Self::Full, _) => true,
        }
    }

    /// The most pictures of a question with its own samples.
    pub fn most(self) -> u32 {
        self.looks().iter().copied().max().unwrap_or(0)
    }

    /// Pictures of each question, look by look, those of the looks before included.
    pub fn looks(self) -> &'static [u32] {
        match self {
            Self::Quick => &[16],
            Self::Standard | Self::Full => &[32, 128],
        }
    }
}

impl FromStr for Tier {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        (ALL.into_iter().find(|tier| tier.name() == name))
            .ok_or_else(|| format!("expected `{}`", ALL.map(Self::name).join("`, `")))
    }
}
