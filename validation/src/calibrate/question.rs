//! The single questions whose p-values are told.

/// Which question a p-value answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Question {
    /// The image's mean, against a formula (Student's t).
    MeanFormula,
    /// A tile's mean, against a formula.
    TileFormula,
    /// The image's mean, of two pictures (Welch's t).
    MeanPictures,
    /// A tile's mean, of two pictures.
    TilePictures,
}

impl Question {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::MeanFormula,
        Self::TileFormula,
        Self::MeanPictures,
        Self::TilePictures,
    ];
}

impl std::fmt::Display for Question {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::MeanFormula => "image mean, formula",
            Self::TileFormula => "tile mean, formula",
            Self::MeanPictures => "image mean, two pictures",
            Self::TilePictures => "tile mean, two pictures",
        })
    }
}
