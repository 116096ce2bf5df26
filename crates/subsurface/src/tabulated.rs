//! `tabphase`: a phase function by a table of values at cosines μ equally spaced from −1 (back) to 1 (straight on), linear
//! in between and scaled so that
//!
//! ```text
//! 2π ∫ p(μ) dμ = 1
//! ```
//!
//! The distribution function is a quadratic in each interval, which is inverted exactly.

use crate::rotational::Rotational;
use etalon_params::Params;
use std::f64::consts::TAU;

/// A tabulated phase function.
#[derive(Clone, Debug, PartialEq)]
pub struct Tabulated {
    /// p at the table's cosines (sr⁻¹).
    values: Vec<f64>,
    /// 2π ∫ p dμ from −1 to each of them.
    below: Vec<f64>,
}

impl Tabulated {
    /// From two values or more, none below zero, not all zero; `None` of any other.
    pub fn new(values: &[f64]) -> Option<Self> {
        let sound = |value: &f64| value.is_finite() && *value >= 0.0;
        if values.len() < 2 || !values.iter().all(sound) {
            return None;
        }
        let width = 2.0 / (values.len() - 1) as f64;
        let mut below = vec![0.0];
        let mut sum = 0.0;
        for pair in values.windows(2) {
            sum += TAU * width * 0.5 * (pair[0] + pair[1]);
            below.push(sum);
        }
        (sum > 0.0).then(|| Self {
            values: values.iter().map(|value| value / sum).collect(),
            below: below.iter().map(|part| part / sum).collect(),
        })
    }

    /// Reads `values`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Self> {
        let accepted = "two numbers or more, none below 0 and not all 0, separated by commas";
        let Some(text) = params.string("values") else {
            if !params.has("values") {
                params.missing("values", accepted);
            }
            return None;
        };
        let words = text.split([',', ' ']).filter(|word| !word.is_empty());
        let values: Option<Vec<f64>> = words.map(|word| word.parse().ok()).collect();
        let table = values.as_deref().and_then(Self::new);
        if table.is_none() {
            params.refuse("values", text, accepted);
        }
        table
    }

    fn width(&self) -> f64 {
        2.0 / (self.values.len() - 1) as f64
    }
}

impl Rotational for Tabulated {
    fn value(&self, mu: f32) -> f32 {
        let place = (f64::from(mu).clamp(-1.0, 1.0) + 1.0) / self.width();
        let index = (place as usize).min(self.values.len() - 2);
        let part = place - index as f64;
        (self.values[index] * (1.0 - part) + self.values[index + 1] * part) as f32
    }

    fn inverse(&self, u: f32) -> f32 {
        let u = f64::from(u);
        let after = self.below.partition_point(|below| *below <= u);
        let index = after.clamp(1, self.values.len() - 1) - 1;
        let [a, b] = [self.values[index], self.values[index + 1]];
        // 2π w (a x + (b − a) x²/2) = u − F for the part x of the interval.
        let rest = (u - self.below[index]) / (TAU * self.width());
        let root = (a * a + 2.0 * (b - a) * rest).max(0.0).sqrt();
        let part = if a + root > 0.0 {
            2.0 * rest / (a + root)
        } else {
            0.0
        };
        ((index as f64 + part.clamp(0.0, 1.0)) * self.width() - 1.0) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_a_phase_function() {
        crate::rotational::check(&Tabulated::new(&[1.0, 1.0]).expect("sound"));
        crate::rotational::check(&Tabulated::new(&[1.0, 1.3, 1.1, 1.6, 1.4]).expect("sound"));
    }

    #[test]
    fn refuses_what_is_no_phase_function() {
        for values in [&[1.0][..], &[0.0, 0.0], &[1.0, -1.0], &[1.0, f64::NAN], &[]] {
            assert_eq!(Tabulated::new(values), None);
        }
    }

    #[test]
    fn empty_intervals_are_never_chosen() {
        let table = Tabulated::new(&[0.0, 0.0, 1.0, 0.0, 0.0]).expect("sound");
        for i in 0..=100 {
            let mu = table.inverse(i as f32 / 100.0);
            assert!(mu.abs() <= 0.5 + 1e-6, "{mu}");
        }
    }
}
