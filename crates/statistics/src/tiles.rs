//! Do two images agree, tile by tile?
//!
//! An image is given by the means of its tiles in each of R independent replicates. Per tile,
//! Welch's t compares the replicates of one image with those of the other (Jung, Hanika &
//! Dachsbacher 2020, who do so per pixel). Tiles of one replicate may depend on each other in any
//! way, since nothing here needs them not to: the family of tiles is corrected by Holm's
//! procedure, and agreement is an intersection-union test, which needs no correction at all
//! (Berger 1982). A whole image is a single tile.

use crate::estimate::Estimate;
use crate::family::holm;
use crate::summary::Summary;
use crate::verdict::Verdict;

/// The tile means of an image's replicates.
#[derive(Clone, Copy, Debug)]
pub struct Replicates<'a> {
    means: &'a [f64],
    tiles: usize,
}

/// Why tiles could not be compared. Refusing is not agreeing.
#[derive(Clone, Debug, PartialEq)]
pub enum TilesError {
    /// The number of means is not a multiple of the number of tiles, or there are no tiles.
    BadShape {
        /// Means given.
        means: usize,
        /// Tiles per replicate.
        tiles: usize,
    },
    /// A single replicate has no standard error.
    TooFewReplicates {
        /// Replicates given.
        replicates: usize,
    },
    /// A mean is infinite or not a number.
    NotFinite {
        /// The replicate.
        replicate: usize,
        /// The tile.
        tile: usize,
    },
    /// The two sides do not have the same tiles.
    DifferentTiles {
        /// Tiles of the first.
        first: usize,
        /// Tiles of the second.
        second: usize,
    },
}

impl std::fmt::Display for TilesError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::BadShape { means, tiles } => {
                write!(f, "{means} means are not whole replicates of {tiles} tiles")
            }
            Self::TooFewReplicates { replicates } => write!(
                f,
                "{replicates} replicate(s) have no standard error; at least 2 are needed"
            ),
            Self::NotFinite { replicate, tile } => {
                write!(f, "tile {tile} of replicate {replicate} is not finite")
            }
            Self::DifferentTiles { first, second } => {
                write!(f, "one image has {first} tiles, the other {second}")
            }
        }
    }
}

impl std::error::Error for TilesError {}

impl<'a> Replicates<'a> {
    /// Replicates of `tiles` means each, one replicate after the other.
    ///
    /// # Errors
    /// [`TilesError`] unless there are at least two whole replicates of finite numbers.
    pub fn new(means: &'a [f64], tiles: usize) -> Result<Self, TilesError> {
        if tiles == 0 || !means.len().is_multiple_of(tiles) {
            return Err(TilesError::BadShape {
                means: means.len(),
                tiles,
            });
        }
        let replicates = means.len() / tiles;
        if replicates < 2 {
            return Err(TilesError::TooFewReplicates { replicates });
        }
        if let Some(bad) = means.iter().position(|mean| !mean.is_finite()) {
            return Err(TilesError::NotFinite {
                replicate: bad / tiles,
                tile: bad % tiles,
            });
        }
        Ok(Self { means, tiles })
    }

    /// The number of replicates.
    #[must_use]
    pub fn count(&self) -> usize {
        self.means.len() / self.tiles
    }

    /// The number of tiles.
    #[must_use]
    pub fn tiles(&self) -> usize {
        self.tiles
    }

    /// The replicates of one tile.
    pub fn tile(&self, tile: usize) -> impl Iterator<Item = f64> + Clone + 'a {
        self.means.iter().copied().skip(tile).step_by(self.tiles)
    }

    /// Number, mean and variance of one tile.
    ///
    /// # Errors
    /// [`TilesError::NotFinite`] where the variance overflows.
    pub fn summary(&self, tile: usize) -> Result<Summary, TilesError> {
        Summary::of_iter(self.tile(tile)).ok_or(TilesError::NotFinite { replicate: 0, tile })
    }
}

/// The differences of two images, tile by tile.
#[derive(Clone, Debug, PartialEq)]
pub struct TileDifferences {
    differences: Vec<Estimate>,
}

/// What became of a comparison of tiles.
#[derive(Clone, Debug, PartialEq)]
pub struct TileDecision {
    /// Whether all tiles agree, any differs, or neither is shown.
    pub verdict: Verdict,
    /// The p-value of the hypothesis that every tile is within its tolerance.
    pub p_differs: f64,
    /// The p-value of the hypothesis that some tile is not within its tolerance.
    pub p_agrees: f64,
    /// Holm's adjusted p-value of each tile.
    pub adjusted: Vec<f64>,
    /// The tile with the smallest p-value.
    pub worst: usize,
}

impl TileDecision {
    /// The tiles that are shown to differ at this level.
    pub fn differing(&self, alpha: f64) -> impl Iterator<Item = usize> + '_ {
        (self.adjusted.iter().enumerate())
            .filter(move |&(_, &p)| p <= alpha)
            .map(|(tile, _)| tile)
    }
}

impl TileDifferences {
    /// Those of two images, first minus second.
    ///
    /// # Errors
    /// [`TilesError::DifferentTiles`] where the numbers of tiles differ.
    pub fn between(first: &Replicates<'_>, second: &Replicates<'_>) -> Result<Self, TilesError> {
        same(first.tiles, second.tiles)?;
        let differences = (0..first.tiles)
            .map(|tile| {
                Ok(Estimate::welch(
                    &first.summary(tile)?,
                    &second.summary(tile)?,
                ))
            })
            .collect::<Result<_, _>>()?;
        Ok(Self { differences })
    }

    /// Those of an image from known values.
    ///
    /// # Errors
    /// [`TilesError::DifferentTiles`] where the numbers of tiles differ.
    pub fn from_known(image: &Replicates<'_>, known: &[f64]) -> Result<Self, TilesError> {
        same(image.tiles, known.len())?;
        let differences = known
            .iter()
            .enumerate()
            .map(|(tile, &known)| Ok(Estimate::excess(&image.summary(tile)?, known)))
            .collect::<Result<_, _>>()?;
        Ok(Self { differences })
    }

    /// One estimate per tile.
    #[must_use]
    pub fn estimates(&self) -> &[Estimate] {
        &self.differences
    }

    /// Decides at level `alpha`, with a tolerance for each tile.
    ///
    /// *Differs* if the family of tiles rejects |βₜ| ≤ δₜ for any tile (false with probability
    /// at most `alpha`); *agrees* if each tile rejects |βₜ| ≥ δₜ (false with probability at
    /// most `alpha`); *undecided* otherwise.
    ///
    /// # Panics
    /// If there is not one tolerance for each tile.
    #[must_use]
    pub fn decide(&self, tolerances: &[f64], alpha: f64) -> TileDecision {
        assert_eq!(
            tolerances.len(),
            self.differences.len(),
            "one tolerance per tile"
        );
        let pairs = || self.differences.iter().zip(tolerances);
        let own: Vec<_> = pairs().map(|(d, &t)| d.p_differs(t)).collect();
        let p_agrees = pairs().map(|(d, &t)| d.p_agrees(t)).fold(0.0, f64::max);
        let adjusted = holm(&own);
        let worst = (0..own.len())
            .min_by(|&a, &b| own[a].total_cmp(&own[b]))
            .unwrap_or(0);
        let p_differs = adjusted.iter().copied().fold(1.0, f64::min);
        let verdict = if p_differs <= alpha {
            Verdict::Differs
        } else if p_agrees <= alpha {
            Verdict::Agrees
        } else {
            Verdict::Undecided
        };
        TileDecision {
            verdict,
            p_differs,
            p_agrees,
            adjusted,
            worst,
        }
    }

    /// The largest of the tiles' smallest detectable differences at a level of `alpha` over the
    /// number of tiles; NaN unless 0 < that < `power` < 1.
    #[must_use]
    pub fn smallest_detectable(&self, alpha: f64, power: f64) -> f64 {
        let each = alpha / self.differences.len() as f64;
        let mut differences: Vec<&Estimate> = self.differences.iter().collect();
        differences.sort_by(|a, b| b.standard_error().total_cmp(&a.standard_error()));
        // In standard errors, fewer degrees of freedom see less. The fewest bound every tile, so
        // that few are computed.
        let fewest = differences
            .iter()
            .map(|difference| difference.degrees_of_freedom())
            .fold(f64::INFINITY, f64::min);
        let most = crate::power::detectable(fewest, each, power);
        if most.is_nan() {
            return most;
        }
        let mut greatest = 0.0;
        for difference in differences {
            if difference.standard_error() * most <= greatest {
                break;
            }
            greatest = difference.smallest_detectable(each, power).max(greatest);
        }
        greatest
    }
}

fn same(first: usize, second: usize) -> Result<(), TilesError> {
    if first == second {
        Ok(())
    } else {
        Err(TilesError::DifferentTiles { first, second })
    }
}
