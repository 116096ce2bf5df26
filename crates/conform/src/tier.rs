//! How much is rendered.

use crate::question::Question;
use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// How much is rendered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tier {
    /// The questions of few samples, 16 pictures of each.
    Quick,
    /// All, 32 pictures of each; four times as many of what is undecided.
    #[default]
    Standard,
}

impl Tier {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Quick => "quick",
            Self::Standard => "standard",
        }
    }

    /// Whether it asks a question.
    pub fn asks(self, question: &Question) -> bool {
        match self {
            Self::Quick => question.samples <= 64,
            Self::Standard => true,
        }
    }

    /// The most pictures of a question.
    pub fn most(self) -> u32 {
        self.looks().iter().copied().max().unwrap_or(0)
    }

    /// Pictures of each question, look by look, those of the looks before included.
    pub fn looks(self) -> &'static [u32] {
        match self {
            Self::Quick => &[16],
            Self::Standard => &[32, 128],
        }
    }
}

impl FromStr for Tier {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let mut all = [Self::Quick, Self::Standard].into_iter();
        all.find(|tier| tier.name() == name)
            .ok_or_else(|| "expected `quick` or `standard`".to_owned())
    }
}
