//! The four wavelengths of a path and the density they are drawn from.
//!
//! One number u in [0, 1) gives the lanes F⁻¹(u), F⁻¹(u + ¼), F⁻¹(u + ½), F⁻¹(u + ¾) (mod 1), with
//! F the distribution function (Wilkie et al., "Hero Wavelength Spectral Sampling", 2014, section
//! 3, with importance sampling by the inverse of F as in Radziszewski et al. 2009). Each lane alone
//! is distributed with density p(λ), and rotating the lanes is adding ¼ to u.

use crate::tables::importance::IMPORTANCE;
use crate::{LAMBDA_MAX, LAMBDA_MIN, SpectrumError, error};
use glam::Vec4;

/// The wavelengths a path carries, with the density each was drawn from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wavelengths {
    /// Vacuum wavelengths of the four lanes, nm. Lane 0 chooses where only one wavelength can.
    pub lambda: Vec4,
    /// p(λ) of each lane, nm⁻¹; above zero.
    pub density: Vec4,
}

impl Wavelengths {
    /// Four wavelengths from one number `u` in [0, 1).
    #[inline]
    pub fn sample(distribution: &WavelengthDistribution, u: f32) -> Self {
        distribution.sample(u)
    }

    /// Wavelength (nm) and density (nm⁻¹) of lane `i` < 4.
    #[inline]
    pub fn lane(&self, i: usize) -> (f32, f32) {
        (self.lambda[i], self.density[i])
    }

    /// The same wavelengths with lane `k` moved to lane 0, `k + 1` to lane 1 and so on (mod 4).
    pub fn rotated(&self, k: usize) -> Self {
        let turn = |v: Vec4| Vec4::new(v[k % 4], v[(k + 1) % 4], v[(k + 2) % 4], v[(k + 3) % 4]);
        Self {
            lambda: turn(self.lambda),
            density: turn(self.density),
        }
    }
}

/// Number of cells of equal probability; a multiple of four, so that the four lanes of a draw lie
/// at the same place in four cells.
const CELLS: usize = 1024;

/// A density of wavelengths over a range, piecewise constant on cells of equal probability, so
/// that a draw is one look-up and its density is exact.
#[derive(Clone, Debug, PartialEq)]
pub struct WavelengthDistribution {
    /// Lower bound and width of each cell, nm.
    cells: Box<[[f32; 2]]>,
    range: [f64; 2],
}

impl WavelengthDistribution {
    /// The importance of wavelengths in [`min`, `max`] nm for an image in linear Rec. 709.
    pub fn new(min: f64, max: f64) -> Result<Self, SpectrumError> {
        error::positive("the shortest wavelength", min)?;
        error::finite("the longest wavelength", max)?;
        if max <= min {
            return Err(SpectrumError::OutOfRange {
                what: "the longest wavelength",
                value: max,
                accepted: "above the shortest wavelength",
            });
        }
        Ok(Self::of_importance(min, max, importance))
    }

    /// The distribution whose density is proportional to `importance` (above zero in the range).
    pub(crate) fn of_importance(min: f64, max: f64, importance: impl Fn(f64) -> f64) -> Self {
        let steps = 8 * CELLS;
        let width = (max - min) / steps as f64;
        let weights: Vec<f64> = (0..steps)
            .map(|i| importance(min + (i as f64 + 0.5) * width))
            .collect();
        let total: f64 = weights.iter().sum();
        let mut bounds = Vec::with_capacity(CELLS + 1);
        bounds.push(min as f32);
        let mut below = 0.0;
        for (i, weight) in weights.iter().enumerate() {
            let above = below + weight / total * CELLS as f64;
            while bounds.len() < CELLS && bounds.len() as f64 <= above {
                let part = (bounds.len() as f64 - below) / (above - below);
                bounds.push((min + (i as f64 + part) * width) as f32);
            }
            below = above;
        }
        bounds.resize(CELLS, max as f32);
        bounds.push(max as f32);
        let cells = bounds.windows(2).map(|b| [b[0], b[1] - b[0]]).collect();
        Self {
            cells,
            range: [min, max],
        }
    }

    /// Shortest and longest wavelength, nm.
    pub fn range(&self) -> [f64; 2] {
        self.range
    }

    /// Four wavelengths from one number `u` in [0, 1).
    #[inline]
    pub fn sample(&self, u: f32) -> Wavelengths {
        let t = u * CELLS as f32;
        let index = (t as usize).min(CELLS - 1);
        let part = (t - index as f32).min(1.0);
        let mut lambda = [0.0; 4];
        let mut density = [0.0; 4];
        for j in 0..4 {
            let [low, width] = self.cells[(index + j * (CELLS / 4)) % CELLS];
            lambda[j] = low + part * width;
            density[j] = 1.0 / (CELLS as f32 * width);
        }
        Wavelengths {
            lambda: Vec4::from_array(lambda),
            density: Vec4::from_array(density),
        }
    }

    /// p(λ) at four wavelengths in nm, nm⁻¹; zero outside the range.
    pub fn density(&self, lambda: Vec4) -> Vec4 {
        Vec4::from_array(lambda.to_array().map(|l| {
            let cell = self.cells.partition_point(|c| c[0] <= l);
            match cell.checked_sub(1).map(|i| self.cells[i]) {
                Some([low, width]) if l <= low + width => 1.0 / (CELLS as f32 * width),
                _ => 0.0,
            }
        }))
    }
}

impl Default for WavelengthDistribution {
    /// The importance of wavelengths over 360–830 nm.
    fn default() -> Self {
        Self::of_importance(LAMBDA_MIN, LAMBDA_MAX, importance)
    }
}

/// What a wavelength in nm is worth for an image in linear Rec. 709 (see the table); beyond the
/// table as little as at its ends.
fn importance(lambda: f64) -> f64 {
    let t = ((lambda - LAMBDA_MIN) / 10.0).clamp(0.0, (IMPORTANCE.len() - 1) as f64);
    let i = (t as usize).min(IMPORTANCE.len() - 2);
    IMPORTANCE[i] + (t - i as f64) * (IMPORTANCE[i + 1] - IMPORTANCE[i])
}

#[cfg(test)]
mod tests;
