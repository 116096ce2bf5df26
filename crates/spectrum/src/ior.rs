//! Refractive indices of dielectrics: named ones, the dispersion formulas of Cauchy and Sellmeier,
//! and tables.

use crate::{Spectrum, SpectrumError, error};
use glam::Vec4;

/// A real refractive index as a function of the wavelength.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RefractiveIndex {
    /// The same at every wavelength: no dispersion.
    Constant(f32),
    /// n(λ) = A + B/λ² + C/λ⁴, λ in µm (Cauchy 1836).
    Cauchy([f32; 3]),
    /// n(λ)² = 1 + Σᵢ Bᵢ λ²/(λ² − Cᵢ), λ in µm, Cᵢ in µm² (Sellmeier 1872).
    Sellmeier {
        /// Strengths of the three resonances.
        b: [f32; 3],
        /// Squared wavelengths of the three resonances, µm².
        c: [f32; 3],
    },
    /// A table.
    Tabulated(Spectrum),
}

impl RefractiveIndex {
    /// The constant index `value`, above zero.
    pub fn constant(value: f64) -> Result<Self, SpectrumError> {
        Ok(Self::Constant(
            error::positive("a refractive index", value)? as f32,
        ))
    }

    /// Cauchy's formula with A (no unit), B (µm²) and C (µm⁴; zero for the two-term form).
    pub fn cauchy(a: f64, b: f64, c: f64) -> Result<Self, SpectrumError> {
        for value in [a, b, c] {
            error::finite("a coefficient of Cauchy's formula", value)?;
        }
        Ok(Self::Cauchy([a as f32, b as f32, c as f32]))
    }

    /// Sellmeier's formula with strengths `b` and squared resonance wavelengths `c` (µm²).
    pub fn sellmeier(b: [f64; 3], c: [f64; 3]) -> Result<Self, SpectrumError> {
        for value in b.iter().chain(&c) {
            error::finite("a coefficient of Sellmeier's formula", *value)?;
        }
        Ok(Self::Sellmeier {
            b: b.map(|v| v as f32),
            c: c.map(|v| v as f32),
        })
    }

    /// The index at four wavelengths in nm.
    #[inline]
    pub fn eval(&self, lambda: Vec4) -> Vec4 {
        match self {
            Self::Constant(value) => Vec4::splat(*value),
            Self::Cauchy([a, b, c]) => {
                let inverse = (lambda * lambda).recip() * 1e6;
                *a + inverse * (*b + inverse * *c)
            }
            Self::Sellmeier { b, c } => {
                let squared = lambda * lambda * 1e-6;
                let mut sum = Vec4::ONE;
                for i in 0..3 {
                    sum += squared * b[i] / (squared - c[i]);
                }
                sum.sqrt()
            }
            Self::Tabulated(table) => table.eval(lambda),
        }
    }

    /// Whether the index depends on the wavelength.
    pub fn is_dispersive(&self) -> bool {
        !matches!(
            self,
            Self::Constant(_) | Self::Tabulated(Spectrum::Uniform(_))
        )
    }
}

/// Names of dielectrics with their index near the sodium D line, as Mitsuba 3 lists them.
pub static DIELECTRICS: &[(&str, f64)] = &[
    ("vacuum", 1.0),
    ("helium", 1.000_036),
    ("hydrogen", 1.000_132),
    ("air", 1.000_277),
    ("carbon dioxide", 1.000_45),
    ("water", 1.333),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.520_45),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.47),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.575),
    ("diamond", 2.419),
];

/// The index of a named dielectric, in any case of letters.
pub fn lookup(name: &str) -> Option<f64> {
    DIELECTRICS
        .iter()
        .find(|(known, _)| known.eq_ignore_ascii_case(name))
        .map(|(_, index)| *index)
}

/// Names [`lookup`] knows.
pub fn names() -> impl Iterator<Item = &'static str> {
    DIELECTRICS.iter().map(|(name, _)| *name)
}
