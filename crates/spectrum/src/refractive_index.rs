//! Refractive indices of dielectrics: named ones, the dispersion formulas of Cauchy and Sellmeier,
//! and tables.

use crate::tabulated::{Irregular, Outside};
use crate::{Spectrum, SpectrumError, cie, error};
use glam::Vec4;

/// The wavelengths (nm) beyond which the eye sees next to nothing: what a table leaves out there is not worth a word.
const SEEN: [f64; 2] = [400.0, 700.0];

/// A table of n, η or k that is constant beyond its ends, and a note if that affects visible wavelengths.
///
/// # Errors
/// Wavelengths (nm) that do not increase, or too few.
pub fn held_table(
    wavelengths: &[f64],
    values: &[f64],
) -> Result<(Spectrum, Option<String>), SpectrumError> {
    let table = Irregular::with_outside(wavelengths, values, Outside::Hold)?;
    let [first, last] = table.range().map(f64::from);
    let ends = first > SEEN[0] || last < SEEN[1];
    let note = ends.then(|| {
        format!("this index is given from {first} to {last} nm: beyond, it stays what it is there")
    });
    Ok((Spectrum::from(table), note))
}

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
        Self::Cauchy([a as f32, b as f32, c as f32]).checked()
    }

    /// Sellmeier's formula with strengths `b` and squared resonance wavelengths `c` (µm²).
    pub fn sellmeier(b: [f64; 3], c: [f64; 3]) -> Result<Self, SpectrumError> {
        for value in b.iter().chain(&c) {
            error::finite("a coefficient of Sellmeier's formula", *value)?;
        }
        Self::Sellmeier {
            b: b.map(|v| v as f32),
            c: c.map(|v| v as f32),
        }
        .checked()
    }

    /// The index `table`, above zero at every rendered wavelength.
    pub fn tabulated(table: Spectrum) -> Result<Self, SpectrumError> {
        Self::Tabulated(table).checked()
    }

    /// `self` if it is finite and above zero at every whole nanometre of 360–830 nm.
    fn checked(self) -> Result<Self, SpectrumError> {
        for i in 0..cie::COUNT {
            let value = self.eval(Vec4::splat((cie::FIRST + i) as f32)).x;
            error::positive("a refractive index within 360–830 nm", f64::from(value))?;
        }
        Ok(self)
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

/// Sellmeier's coefficients of one material: its name, B₁ to B₃, and C₁ to C₃ in µm².
type Sellmeier = (&'static str, [f64; 3], [f64; 3]);

/// Materials with a published dispersion: glasses by SCHOTT's data sheets, fused quartz by Malitson
/// (1965), diamond by Peter (1923).
static DISPERSIVE: &[Sellmeier] = &[
    (
        "bk7",
        [1.039_612_12, 0.231_792_344, 1.010_469_45],
        [0.006_000_698_67, 0.020_017_914_4, 103.560_653],
    ),
    (
        "f2",
        [1.345_333_59, 0.209_073_176, 0.937_357_162],
        [0.009_977_438_71, 0.047_045_076_7, 111.886_764],
    ),
    (
        "n-sf10",
        [1.621_539_02, 0.256_287_842, 1.644_475_52],
        [0.012_224_145_7, 0.059_573_677_5, 147.468_793],
    ),
    (
        "n-sf11",
        [1.737_596_95, 0.313_747_346, 1.898_781_01],
        [0.013_188_707, 0.062_306_814_2, 155.236_29],
    ),
    (
        "fused quartz",
        [0.696_166_3, 0.407_942_6, 0.897_479_4],
        [0.004_679_148_25, 0.013_512_063, 97.934_002_5],
    ),
    (
        "diamond",
        [4.3356, 0.3306, 0.0],
        [0.011_236, 0.030_625, 0.0],
    ),
];

/// The index of a named material with its dispersion, in any case of letters; `None` where only a
/// constant is known ([`lookup`]).
pub fn dispersive(name: &str) -> Option<RefractiveIndex> {
    let (_, b, c) = DISPERSIVE
        .iter()
        .find(|(known, ..)| known.eq_ignore_ascii_case(name))?;
    RefractiveIndex::sellmeier(*b, *c).ok()
}

/// Names [`dispersive`] knows.
pub fn dispersive_names() -> impl Iterator<Item = &'static str> {
    DISPERSIVE.iter().map(|(name, ..)| *name)
}

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

#[cfg(test)]
mod tests {
    use super::*;

    fn at(index: &RefractiveIndex, lambda: f32) -> f64 {
        f64::from(index.eval(Vec4::splat(lambda)).x)
    }

    #[test]
    fn names_are_found_in_any_case() {
        assert_eq!(lookup("BK7"), Some(1.5046));
        assert_eq!(lookup("Carbon Dioxide"), Some(1.000_45));
        assert_eq!(lookup("bk 7"), None);
        assert_eq!(names().count(), 23);
        for (name, value) in DIELECTRICS {
            assert_eq!(lookup(name), Some(*value));
        }
    }

    #[test]
    fn dispersion_is_the_published_one() {
        // Index at the d line (587.56 nm) and Abbe's number (n_d − 1)/(n_F − n_C) by SCHOTT's data
        // sheets and Malitson (1965).
        for (name, n_d, abbe) in [
            ("bk7", 1.516_80, 64.17),
            ("f2", 1.620_04, 36.37),
            ("n-sf10", 1.728_28, 28.53),
            ("n-sf11", 1.784_72, 25.68),
            ("fused quartz", 1.458_46, 67.82),
        ] {
            let index = dispersive(name).expect("the material has coefficients");
            assert!(index.is_dispersive());
            let d = at(&index, 587.56);
            let v = (d - 1.0) / (at(&index, 486.13) - at(&index, 656.27));
            assert!(
                (d - n_d).abs() < 1e-5 && (v / abbe - 1.0).abs() < 1e-3,
                "{name}: {d} {v}"
            );
        }
        let diamond = dispersive("Diamond").expect("diamond has coefficients");
        assert!((at(&diamond, 589.29) - 2.4175).abs() < 1e-3);
        assert!(dispersive("water").is_none());
        for name in dispersive_names() {
            let constant = lookup(name);
            let index = dispersive(name).expect("names() lists what the look-up knows");
            assert!(
                constant.is_none_or(|n| (n - at(&index, 589.29)).abs() < 0.013),
                "{name}"
            );
        }
    }

    #[test]
    fn cauchys_formula_is_in_micrometres() {
        // Borosilicate glass: A = 1.5046, B = 0.0042 µm².
        let index = RefractiveIndex::cauchy(1.5046, 0.0042, 0.0).expect("finite coefficients");
        assert!((at(&index, 500.0) - (1.5046 + 0.0042 / 0.25)).abs() < 1e-6);
        let quartic = RefractiveIndex::cauchy(1.5, 0.0, 0.001).expect("finite coefficients");
        assert!((at(&quartic, 500.0) - (1.5 + 0.001 / 0.0625)).abs() < 1e-6);
    }

    #[test]
    fn bad_indices_are_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(RefractiveIndex::constant(bad).is_err(), "{bad}");
        }
        assert!(RefractiveIndex::cauchy(f64::NAN, 0.0, 0.0).is_err());
        // An index of zero or less somewhere in 360–830 nm is refused.
        assert!(RefractiveIndex::cauchy(-1.0, 0.0, 0.0).is_err());
        assert!(RefractiveIndex::sellmeier([1.0, 0.0, 0.0], [0.25, 0.0, 0.0]).is_err());
        assert!(
            !RefractiveIndex::constant(1.5)
                .expect("above 0")
                .is_dispersive()
        );
    }
}
