//! What a format that holds less than floats could not hold.

/// Numbers of samples that a file holds differently from the image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Losses {
    /// Negative samples, written as 0.
    pub negative: usize,
    /// Samples above what the format holds, written as its greatest value.
    pub too_bright: usize,
    /// Samples that are infinite or not a number.
    pub not_finite: usize,
}

impl Losses {
    /// Whether there were none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}
