//! α, the probability of BSDF sampling instead of guiding, learned together with the radiance.
//!
//! ```text
//! α = argmax E[f·L·|cos θ|/p · ln(α·p_f + (1 − α)·p_g)]     over the directions taken,
//! ```
//!
//! which minimises the Kullback–Leibler divergence of the mixture from the zero-variance density f·L·|cos θ|
//! (Müller 2019, "Practical Path Guiding in Production", in the course notes "Path Guiding in Production"). There
//! α follows a stochastic gradient, record by record; here a few values are compared, whose sums do not depend on
//! the order in which threads add.
//!
//! With one fixed α for all surfaces, glossy scattering inside an object multiplies weights by up to 1/α at every
//! vertex: p_g, which does not know the lobe, nearly vanishes where p_f is large. Through frosted glass ten such
//! vertices make one path as bright as the rest of the picture. There the learned α is near one. It is never less
//! than the given minimum, so weights stay bounded.

use etalon_math::float::ln;
use std::sync::atomic::{AtomicI64, Ordering};

/// Fractions that are tried beside the least.
const STEPS: usize = 7;

/// The largest α that is tried, so that guiding always has some probability.
const MOST: f32 = 0.95;

/// The most that a record counts (units), so that the sums of 2²⁴ records fit.
const LARGEST: f64 = (1_u64 << 37) as f64;

/// Fewer records do not decide.
const ENOUGH: u64 = 100;

/// The densities of a direction that was taken.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AlternativePdfs {
    /// p_f: how likely the scattering model takes it; 1 for a discrete direction.
    pub(crate) own: f32,
    /// p_g: how likely the learned lobe does; 0 for a discrete direction.
    pub(crate) learned: f32,
}

impl AlternativePdfs {
    fn mix(self, own: f32) -> f32 {
        own * self.own + (1.0 - own) * self.learned
    }
}

/// The gain of each fraction over the least.
#[derive(Debug, Default)]
pub(crate) struct FractionOptimizer([AtomicI64; STEPS]);

/// The fraction of a step from 0, the least.
fn fraction(least: f32, step: usize) -> f32 {
    least + (MOST - least).max(0.0) * step as f32 / STEPS as f32
}

impl FractionOptimizer {
    /// Adds a record of light, in some unit.
    pub(crate) fn add(&self, least: f32, light: f64, alternatives: AlternativePdfs) {
        let base = alternatives.mix(least);
        if !(base > 0.0 && light > 0.0) {
            return;
        }
        let light = light.min(LARGEST);
        for (step, score) in self.0.iter().enumerate() {
            let gain = ln(alternatives.mix(fraction(least, step + 1)) / base);
            score.fetch_add((light * f64::from(gain)) as i64, Ordering::Relaxed);
        }
    }

    /// The best, if there were records enough to tell.
    pub(crate) fn best(&self, least: f32, records: u64) -> Option<f32> {
        let scores = self.0.iter().map(|score| score.load(Ordering::Relaxed));
        let (step, _) = std::iter::once(0)
            .chain(scores)
            .enumerate()
            .max_by_key(|&(step, score)| (score, std::cmp::Reverse(step)))?;
        (records >= ENOUGH).then(|| fraction(least, step))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEAST: f32 = 0.3;

    /// The result for light of density (k + 1)·xᵏ on a line, with the model's density 5x⁴ and a uniform learned one.
    fn best(k: i32) -> f32 {
        let scores = FractionOptimizer::default();
        let n: u16 = 1000;
        for i in 0..n {
            let x = (f32::from(i) + 0.5) / f32::from(n);
            let density = |k: i32| (k + 1) as f32 * x.powi(k);
            let alternatives = AlternativePdfs {
                own: density(4),
                learned: 1.0,
            };
            scores.add(LEAST, 1e6 * f64::from(density(k)), alternatives);
        }
        scores.best(LEAST, n.into()).expect("records enough")
    }

    #[test]
    fn the_better_density_is_followed_more() {
        // The model's own, to the letter; the even one; and between them, by the sum of (k + 1)·xᵏ·ln(5αx⁴ + 1 − α).
        assert_eq!(best(4), MOST);
        assert_eq!(best(0), LEAST);
        assert_eq!(best(2), fraction(LEAST, 5));
    }

    #[test]
    fn few_records_and_darkness_decide_nothing() {
        let scores = FractionOptimizer::default();
        let alternatives = AlternativePdfs {
            own: 9.0,
            learned: 1.0,
        };
        for light in [0.0, -1.0, f64::NAN] {
            scores.add(LEAST, light, alternatives);
        }
        scores.add(LEAST, 1.0, AlternativePdfs::default());
        assert_eq!(scores.best(LEAST, 1000), Some(LEAST));
        scores.add(LEAST, f64::INFINITY, alternatives);
        assert_eq!(scores.best(LEAST, 1000), Some(MOST));
        assert_eq!(scores.best(LEAST, ENOUGH - 1), None);
        // One that follows the model alone stays so.
        scores.add(1.0, 1.0, alternatives);
        assert_eq!(fraction(1.0, STEPS), 1.0);
    }
}
