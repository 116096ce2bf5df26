//! Corrections of p-values for the number of hypotheses they belong to.
//!
//! For m hypotheses with sorted p₍₁₎ ≤ … ≤ p₍ₘ₎ the adjusted p-values are
//!
//! - Holm (1979): maxⱼ≤ᵢ min(1, (m − j + 1) p₍ⱼ₎); any dependence;
//! - Šidák, stepping down (Holland & Copenhaver 1987): maxⱼ≤ᵢ 1 − (1 − p₍ⱼ₎)^(m−j+1); independence;
//! - Benjamini & Hochberg (1995): minⱼ≥ᵢ m p₍ⱼ₎ / j; independence or positive dependence, and it
//!   bounds the share of false rejections, not their probability.

/// How a family's p-values are corrected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Correction {
    /// Bounds the probability of any false rejection, whatever the dependence.
    Holm,
    /// Bounds the probability of any false rejection; only for independent tests.
    Sidak,
    /// Bounds the expected share of false rejections among all; for exploration, never a verdict.
    BenjaminiHochberg,
}

impl Correction {
    /// The adjusted p-values, in the order given.
    #[must_use]
    pub fn adjust(self, p_values: &[f64]) -> Vec<f64> {
        match self {
            Self::Holm => holm(p_values),
            Self::Sidak => sidak_step_down(p_values),
            Self::BenjaminiHochberg => benjamini_hochberg(p_values),
        }
    }
}

/// Holm's adjusted p-values, in the order given. Valid under any dependence.
#[must_use]
pub fn holm(p_values: &[f64]) -> Vec<f64> {
    step_down(p_values, |p, remaining| (remaining as f64 * p).min(1.0))
}

/// Šidák's adjusted p-values, stepping down, in the order given. Needs independence, so not for
/// tiles of one image.
#[must_use]
pub fn sidak_step_down(p_values: &[f64]) -> Vec<f64> {
    step_down(p_values, sidak)
}

/// Benjamini and Hochberg's (1995) adjusted p-values, in the order given: rejecting those at
/// most q keeps the expected share of false rejections at q. Needs independence or positive
/// dependence; meant for exploration, never for a verdict.
#[must_use]
pub fn benjamini_hochberg(p_values: &[f64]) -> Vec<f64> {
    let order = ascending(p_values);
    let count = p_values.len() as f64;
    let mut adjusted = vec![0.0; p_values.len()];
    let mut least = 1.0_f64;
    for (rank, &index) in order.iter().enumerate().rev() {
        least = least.min(p_values[index] * count / (rank + 1) as f64);
        adjusted[index] = least;
    }
    adjusted
}

/// The probability that the smallest of `count` independent p-values is at most `p` (Šidák
/// 1967): 1 − (1 − p)^count. Needs independence, so not for tiles of one image.
#[must_use]
pub fn sidak(p: f64, count: usize) -> f64 {
    -libm::expm1(count as f64 * libm::log1p(-p))
}

/// The level at which to test each of `count` independent hypotheses for `alpha` together.
#[must_use]
pub fn sidak_level(alpha: f64, count: usize) -> f64 {
    -libm::expm1(libm::log1p(-alpha) / count.max(1) as f64)
}

/// The running maximum, from the smallest p-value, of `adjust(p, hypotheses not yet rejected)`.
fn step_down(p_values: &[f64], adjust: impl Fn(f64, usize) -> f64) -> Vec<f64> {
    let mut adjusted = vec![0.0; p_values.len()];
    let mut greatest = 0.0_f64;
    for (rank, &index) in ascending(p_values).iter().enumerate() {
        greatest = greatest.max(adjust(p_values[index], p_values.len() - rank));
        adjusted[index] = greatest;
    }
    adjusted
}

/// The indices of the p-values from the smallest to the greatest.
fn ascending(p_values: &[f64]) -> Vec<usize> {
    let mut order: Vec<_> = (0..p_values.len()).collect();
    order.sort_by(|&a, &b| p_values[a].total_cmp(&p_values[b]));
    order
}
