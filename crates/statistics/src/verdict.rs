//! The three answers to "do these agree?".

/// What a comparison within a tolerance found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// The difference is shown to be within the tolerance.
    Agrees,
    /// The difference is shown to exceed the tolerance.
    Differs,
    /// Neither is shown; more samples are needed. This is never a pass.
    Undecided,
}

impl Verdict {
    /// The verdict on several comparisons that must all agree.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Differs, _) | (_, Self::Differs) => Self::Differs,
            (Self::Agrees, Self::Agrees) => Self::Agrees,
            _ => Self::Undecided,
        }
    }
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Agrees => "agrees",
            Self::Differs => "differs",
            Self::Undecided => "undecided",
        })
    }
}
