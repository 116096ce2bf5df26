//! How far a sample is from normal, and when that is too far.
//!
//! - Skewness G₁ = √(n(n−1))/(n−2) · m₃/m₂^{3/2} and excess kurtosis G₂ (Joanes & Gill 1998).
//! - The share of the energy Σ|x|, and of the variance Σ(x − x̄)², that a single replicate carries.
//! - The Hill (1975) index k / Σᵢ ln(y₍ᵢ₎/y₍ₖ₊₁₎) of the k greatest y = |x − median|: the exponent of
//!   the tail. At 2 or less the variance does not exist.
//!
//! **The declared limit** ([`Limits::DECLARED`]). A normal approximation at one-sided level α is
//! refused where
//!
//! 1. the skewness is such as normal samples of this size show with probability 10⁻³ at most
//!    (D'Agostino 1970), *and* its first Edgeworth term distorts the level of the one-sided
//!    t-test, G₁ (2z² + 1) φ(z) / (6 √n Φ̄(z)) with z at α (Hall 1992, section 2.6), by more than half; or
//! 2. one replicate carries a share of the variance that normal samples show with probability
//!    10⁻³ at most (Grubbs 1950: (n−1)/n · t²/(n−2+t²), t at 10⁻³/2n with n − 2 degrees of freedom); or
//! 3. one replicate carries more than half of the energy of at least four; or
//! 4. the Hill index of at least 100 replicates is at most 2.
//!
//! A sample of eight cannot show much; rules 1 and 2 ask for what is both harmful and visible. The
//! approximate point of rule 1 is 7 % too high for eight replicates, 3 % from 16 on.

use crate::normal;
use crate::student_t;
use std::f64::consts::PI;

/// Fewer than this many replicates are not asked for their skewness or outliers.
const FEWEST: usize = 8;

/// Fewer than this many have no Hill index.
const FEWEST_FOR_HILL: usize = 100;

/// What a sample looks like beyond its mean and variance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tails {
    count: usize,
    skewness: f64,
    excess_kurtosis: f64,
    energy_share: f64,
    variance_share: f64,
    hill: Option<f64>,
}

/// Where a normal approximation ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The greatest relative distortion of a one-sided level by skewness.
    pub distortion: f64,
    /// The probability with which a normal sample's skewness, and its outlier, is refused.
    pub rarity: f64,
    /// The greatest share of the energy in one replicate.
    pub energy_share: f64,
    /// The Hill index that is still refused.
    pub hill: f64,
}

impl Limits {
    /// The limits this crate decides by.
    pub const DECLARED: Self = Self {
        distortion: 0.5,
        rarity: 1e-3,
        energy_share: 0.5,
        hill: 2.0,
    };
}

/// Why a normal approximation is refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    /// The sample is skewed, and the level would be distorted.
    Skewness {
        /// G₁.
        skewness: f64,
        /// The relative distortion of the one-sided level.
        distortion: f64,
    },
    /// One replicate makes the variance.
    Outlier {
        /// Its share.
        share: f64,
        /// The greatest share allowed.
        limit: f64,
    },
    /// One replicate makes the mean.
    Energy {
        /// Its share.
        share: f64,
    },
    /// The variance does not exist.
    HeavyTail {
        /// The Hill index.
        hill: f64,
    },
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Skewness {
                skewness,
                distortion,
            } => write!(
                f,
                "a skewness of {skewness:.2} would distort the error level by {:.0} %",
                100.0 * distortion
            ),
            Self::Outlier { share, limit } => write!(
                f,
                "one replicate makes {:.0} % of the variance (normal samples: up to {:.0} %)",
                100.0 * share,
                100.0 * limit
            ),
            Self::Energy { share } => {
                write!(
                    f,
                    "one replicate carries {:.0} % of the energy",
                    100.0 * share
                )
            }
            Self::HeavyTail { hill } => {
                write!(f, "a Hill index of {hill:.2}: the variance may not exist")
            }
        }
    }
}

impl Tails {
    /// Of a sample of at least three finite numbers; `None` of anything else.
    #[must_use]
    pub fn of(sample: &[f64]) -> Option<Self> {
        let count = sample.len();
        if count < 3 || sample.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let n = count as f64;
        let mean = sample.iter().sum::<f64>() / n;
        // In units of the greatest deviation, so that no power under- or overflows.
        let scale = sample.iter().map(|x| (x - mean).abs()).fold(0.0, f64::max);
        let deviations = || {
            sample
                .iter()
                .map(|x| if scale > 0.0 { (x - mean) / scale } else { 0.0 })
        };
        let [second, third, fourth] = [2, 3, 4].map(|power| {
            deviations()
                .map(|d| (0..power).fold(1.0, |product, _| product * d))
                .sum::<f64>()
                / n
        });
        let (mut skewness, mut excess_kurtosis) = (0.0, 0.0);
        if second > 0.0 {
            skewness = third / (second * second.sqrt()) * (n * (n - 1.0)).sqrt() / (n - 2.0);
            if count > 3 {
                let plain = fourth / (second * second) - 3.0;
                excess_kurtosis = (n - 1.0) / ((n - 2.0) * (n - 3.0)) * ((n + 1.0) * plain + 6.0);
            }
        }
        let variance_share = if second > 0.0 {
            1.0 / (n * second)
        } else {
            1.0 / n
        };
        Some(Self {
            count,
            skewness,
            excess_kurtosis,
            energy_share: energy_share(sample, 1)?,
            variance_share,
            hill: deviation_index(sample),
        })
    }

    /// The number of replicates.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// G₁; 0 of a constant sample.
    #[must_use]
    pub fn skewness(&self) -> f64 {
        self.skewness
    }

    /// G₂; 0 of a constant sample or of three numbers.
    #[must_use]
    pub fn excess_kurtosis(&self) -> f64 {
        self.excess_kurtosis
    }

    /// The share of Σ|x| in the greatest replicate.
    #[must_use]
    pub fn energy_share(&self) -> f64 {
        self.energy_share
    }

    /// The share of Σ(x − x̄)² in the farthest replicate.
    #[must_use]
    pub fn variance_share(&self) -> f64 {
        self.variance_share
    }

    /// The Hill index of the ⌈√n⌉ greatest deviations from the median; `None` of fewer than 100
    /// replicates, or where the deviation below the greatest is zero.
    #[must_use]
    pub fn hill(&self) -> Option<f64> {
        self.hill
    }

    /// The predicted relative distortion of a one-sided t-test at level `alpha`, by the first
    /// Edgeworth term.
    #[must_use]
    pub fn distortion(&self, alpha: f64) -> f64 {
        distortion(self.standardised_skewness(), alpha)
    }

    /// The skewness of the mean, G₁/√n.
    #[must_use]
    pub fn standardised_skewness(&self) -> f64 {
        self.skewness / (self.count as f64).sqrt()
    }

    /// Why a normal approximation is refused at one-sided level `alpha`, if it is.
    #[must_use]
    pub fn refusal(&self, alpha: f64, limits: &Limits) -> Option<Refusal> {
        self.refusal_given(self.standardised_skewness(), alpha, limits)
    }

    /// As [`Tails::refusal`], where what is tested has this standardised skewness.
    pub(crate) fn refusal_given(
        &self,
        standardised: f64,
        alpha: f64,
        limits: &Limits,
    ) -> Option<Refusal> {
        if let Some(hill) = self.hill.filter(|&hill| hill <= limits.hill) {
            return Some(Refusal::HeavyTail { hill });
        }
        if self.count >= FEWEST {
            let distortion = distortion(standardised, alpha);
            let visible = self.skewness.abs() > normal_skewness(self.count, limits.rarity);
            if visible && distortion > limits.distortion {
                return Some(Refusal::Skewness {
                    skewness: self.skewness,
                    distortion,
                });
            }
            let limit = normal_variance_share(self.count, limits.rarity);
            if self.variance_share > limit {
                return Some(Refusal::Outlier {
                    share: self.variance_share,
                    limit,
                });
            }
        }
        let heaviest = self.count >= 4 && self.energy_share > limits.energy_share;
        heaviest.then_some(Refusal::Energy {
            share: self.energy_share,
        })
    }
}

/// The first Edgeworth term of the level of a one-sided t-test, relative to it.
pub(crate) fn distortion(standardised: f64, alpha: f64) -> f64 {
    let z = normal::upper_quantile(alpha);
    let density = libm::exp(-0.5 * z * z) / (2.0 * PI).sqrt();
    standardised.abs() * (2.0 * z * z + 1.0) * density / (6.0 * alpha)
}

/// The share of Σ|x| in the `top` greatest |x|; `None` of an empty or non-finite sample, 0 where
/// all are zero.
#[must_use]
pub fn energy_share(sample: &[f64], top: usize) -> Option<f64> {
    if sample.is_empty() || sample.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let mut energies: Vec<f64> = sample.iter().map(|x| x.abs()).collect();
    energies.sort_by(|a, b| b.total_cmp(a));
    let scale = energies[0];
    if scale == 0.0 {
        return Some(0.0);
    }
    let sum = |energies: &[f64]| energies.iter().map(|x| x / scale).sum::<f64>();
    Some(sum(&energies[..top.min(energies.len())]) / sum(&energies))
}

/// The Hill index of the `top` greatest of positive numbers; `None` unless 0 < `top` < their
/// count and the one below the top is positive.
#[must_use]
pub fn hill_index(sample: &[f64], top: usize) -> Option<f64> {
    let mut values = sample.to_vec();
    values.sort_by(|a, b| b.total_cmp(a));
    let threshold = *values.get(top).filter(|&&x| top > 0 && x > 0.0)?;
    let sum: f64 = values[..top].iter().map(|x| libm::log(x / threshold)).sum();
    (values[0].is_finite() && sum > 0.0).then(|| top as f64 / sum)
}

/// The Hill index of a sample's deviations from its median.
fn deviation_index(sample: &[f64]) -> Option<f64> {
    if sample.len() < FEWEST_FOR_HILL {
        return None;
    }
    let mut values = sample.to_vec();
    values.sort_by(f64::total_cmp);
    let n = values.len();
    let median = 0.5 * (values[(n - 1) / 2] + values[n / 2]);
    let deviations: Vec<f64> = values.iter().map(|x| (x - median).abs()).collect();
    hill_index(&deviations, (n as f64).sqrt().ceil() as usize)
}

/// The |G₁| that normal samples of `n` ≥ 8 exceed with probability `rarity`, by D'Agostino's
/// (1970) transformation of √b₁ to normal.
#[must_use]
pub fn normal_skewness(n: usize, rarity: f64) -> f64 {
    let n = n as f64;
    let kurtosis = 3.0 * (n * n + 27.0 * n - 70.0) * (n + 1.0) * (n + 3.0)
        / ((n - 2.0) * (n + 5.0) * (n + 7.0) * (n + 9.0));
    let w2 = (2.0 * (kurtosis - 1.0)).sqrt() - 1.0;
    let delta = 1.0 / (0.5 * libm::log(w2)).sqrt();
    let scale = (2.0 / (w2 - 1.0)).sqrt();
    let z = normal::upper_quantile(0.5 * rarity);
    let root_b1 =
        scale * libm::sinh(z / delta) * (6.0 * (n - 2.0) / ((n + 1.0) * (n + 3.0))).sqrt();
    root_b1 * (n * (n - 1.0)).sqrt() / (n - 2.0)
}

/// The share of the variance that one of `n` ≥ 3 normal numbers exceeds with probability `rarity`
/// at most (Grubbs 1950).
#[must_use]
pub fn normal_variance_share(n: usize, rarity: f64) -> f64 {
    let n = n as f64;
    let t = student_t::upper_quantile(rarity / (2.0 * n), n - 2.0);
    let t2 = t * t;
    // One of n holds at most (n − 1)/n; the limit of t → ∞.
    (n - 1.0) / n * t2 / (n - 2.0 + t2)
}
