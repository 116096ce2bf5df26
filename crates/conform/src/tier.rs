//! How much is rendered.

use crate::question::Question;

/// How much is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tier {
    /// The questions of few samples, 16 pictures of each.
    Quick,
    /// All, 32 pictures of each; four times as many of what is undecided.
    Standard,
}

impl Tier {
    /// All, with their names.
    pub const ALL: [(&'static str, Self); 2] =
        [("quick", Self::Quick), ("standard", Self::Standard)];

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

    /// Pictures of each question, look by look, those of the looks before included.
    pub fn looks(self) -> &'static [u32] {
        match self {
            Self::Quick => &[16],
            Self::Standard => &[32, 128],
        }
    }
}
