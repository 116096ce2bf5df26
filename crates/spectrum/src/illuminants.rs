//! CIE standard illuminants: E, A (CIE 015:2018, equation 4.1), D65, and the fluorescent F1–F12.
//!
//! Each is scaled to luminance Y = 1 ([`crate::cie::luminance`]), so that D65 is the white of
//! linear Rec. 709.

use crate::cie;
use crate::tables::illuminants::{D65, FLUORESCENT};
use crate::{Regular, SpectrumError};
use etalon_math::float64;

/// Range of the table of D65, nm; the spectrum is zero outside.
pub const D65_RANGE: [f64; 2] = [360.0, 830.0];

/// Range of the tables of F1–F12, nm; the spectra are zero outside.
pub const FLUORESCENT_RANGE: [f64; 2] = [380.0, 780.0];

/// Steps of the tables, nm.
const STEP: usize = 5;

/// D65 as the CIE tabulates it (100 at 560 nm) at 360 + `offset` nm, for compile-time tables.
pub(crate) const fn d65_relative(offset: f64) -> f64 {
    let t = offset / STEP as f64;
    let mut i = t as usize;
    if i > D65.len() - 2 {
        i = D65.len() - 2;
    }
    D65[i] + (t - i as f64) * (D65[i + 1] - D65[i])
}

/// (X, Y, Z) of D65 as the CIE tabulates it, by the rule of [`cie::xyz`].
pub(crate) const D65_RELATIVE_XYZ: [f64; 3] = {
    let mut sum = [0.0; 3];
    let mut i = 0;
    while i < cie::COUNT {
        let ends = if i == 0 || i == cie::COUNT - 1 {
            1.0
        } else {
            2.0
        };
        let here = cie::row(i);
        let at = ends / 6.0 * d65_relative(i as f64);
        let mut c = 0;
        while c < 3 {
            sum[c] += at * here[c];
            c += 1;
        }
        if i + 1 < cie::COUNT {
            let next = cie::row(i + 1);
            let middle = 4.0 / 6.0 * d65_relative(i as f64 + 0.5);
            let mut c = 0;
            while c < 3 {
                sum[c] += middle * 0.5 * (here[c] + next[c]);
                c += 1;
            }
        }
        i += 1;
    }
    let n = cie::NORMALISATION;
    [sum[0] / n, sum[1] / n, sum[2] / n]
};

/// CIE D65 at `lambda` nm, scaled to Y = 1.
pub fn d65(lambda: f64) -> f64 {
    if (D65_RANGE[0]..=D65_RANGE[1]).contains(&lambda) {
        d65_relative(lambda - D65_RANGE[0]) / D65_RELATIVE_XYZ[1]
    } else {
        0.0
    }
}

/// CIE illuminant A at `lambda` nm, scaled to Y = 1:
/// 100 (560/λ)⁵ (e^(1.435·10⁷/(2848·560)) − 1)/(e^(1.435·10⁷/(2848 λ)) − 1) up to a factor.
pub fn a(lambda: f64) -> f64 {
    a_relative(lambda) / *A_LUMINANCE
}

static A_LUMINANCE: std::sync::LazyLock<f64> =
    std::sync::LazyLock::new(|| cie::luminance(a_relative));

fn a_relative(lambda: f64) -> f64 {
    let numerator = float64::exp(1.435e7 / (2848.0 * 560.0)) - 1.0;
    let denominator = float64::exp(1.435e7 / (2848.0 * lambda)) - 1.0;
    let ratio = 560.0 / lambda;
    let squared = ratio * ratio;
    100.0 * squared * squared * ratio * numerator / denominator
}

/// CIE illuminant E: the constant that has Y = 1.
pub fn e(_lambda: f64) -> f64 {
    cie::NORMALISATION / E_INTEGRAL
}

/// ∫ ȳ dλ of the table, nm.
const E_INTEGRAL: f64 = {
    let mut sum = 0.5 * (cie::row(0)[1] + cie::row(cie::COUNT - 1)[1]);
    let mut i = 1;
    while i < cie::COUNT - 1 {
        sum += cie::row(i)[1];
        i += 1;
    }
    sum
};

/// CIE D65 over 360–830 nm in steps of 5 nm, scaled to Y = 1.
pub fn d65_spectrum() -> Regular {
    tabulated(D65_RANGE, &D65).expect("the table of D65 is finite and has two values or more")
}

/// [`d65_spectrum`], made once.
#[inline]
pub fn white() -> &'static Regular {
    static WHITE: std::sync::LazyLock<Regular> = std::sync::LazyLock::new(d65_spectrum);
    &WHITE
}

/// CIE F`number` over 380–780 nm in steps of 5 nm, scaled to Y = 1; `None` unless `number` is
/// 1 to 12.
pub fn fluorescent(number: usize) -> Option<Regular> {
    let values = FLUORESCENT.get(number.checked_sub(1)?)?;
    tabulated(FLUORESCENT_RANGE, values).ok()
}

/// `values` over `range`, scaled to Y = 1.
pub(crate) fn tabulated(range: [f64; 2], values: &[f64]) -> Result<Regular, SpectrumError> {
    let relative = |lambda: f64| {
        let t = (lambda - range[0]) / STEP as f64;
        if !(t >= 0.0 && t <= (values.len() - 1) as f64) {
            return 0.0;
        }
        let i = (t as usize).min(values.len() - 2);
        values[i] + (t - i as f64) * (values[i + 1] - values[i])
    };
    let scale = 1.0 / cie::luminance(relative);
    let scaled: Vec<f64> = values.iter().map(|v| v * scale).collect();
    Regular::new(range[0], range[1], &scaled)
}
