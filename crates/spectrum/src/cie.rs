//! The CIE 1931 2° standard observer: the colour-matching functions x̄, ȳ, z̄ at 1 nm from 360 to
//! 830 nm (CIE 018:2019), linear in between and zero outside, and integrals against them.
//!
//! X = ∫ L(λ) x̄(λ) dλ / N, likewise Y and Z. N is [`NORMALISATION`].

use crate::tables::cie1931::CIE_1931;

/// First tabulated wavelength, nm.
pub const FIRST: usize = 360;

/// Number of tabulated wavelengths, 1 nm apart.
pub const COUNT: usize = CIE_1931.len();

/// The constant N that turns ∫ L ȳ dλ into Y, nm.
///
/// It is the one Mitsuba 3 divides by, so that pictures share its scale. It lies 0.1 % below the
/// integral of the tabulated ȳ (106.857 nm): the constant spectrum 1 has Y = 1.001.
pub const NORMALISATION: f64 = 106.750_259_399_414_06;

/// (x̄, ȳ, z̄) at `lambda` nm.
pub fn colour_matching(lambda: f64) -> [f64; 3] {
    let t = lambda - FIRST as f64;
    if !(t >= 0.0 && t <= (COUNT - 1) as f64) {
        return [0.0; 3];
    }
    let i = (t as usize).min(COUNT - 2);
    let f = t - i as f64;
    let (a, b) = (CIE_1931[i], CIE_1931[i + 1]);
    std::array::from_fn(|c| a[c] + f * (b[c] - a[c]))
}

/// (x̄, ȳ, z̄) at 360 + `index` nm.
pub(crate) const fn row(index: usize) -> [f64; 3] {
    CIE_1931[index]
}

/// (X, Y, Z) of the spectral radiance `spectrum`, by Simpson's rule on every nanometre: exact
/// when the spectrum is linear between whole nanometres.
pub fn xyz(spectrum: impl Fn(f64) -> f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    let mut add = |weight: f64, lambda: f64, matching: [f64; 3]| {
        let value = weight * spectrum(lambda);
        for c in 0..3 {
            sum[c] += value * matching[c];
        }
    };
    for i in 0..COUNT {
        let lambda = (FIRST + i) as f64;
        let ends = if i == 0 || i == COUNT - 1 { 1.0 } else { 2.0 };
        add(ends / 6.0, lambda, CIE_1931[i]);
        if i + 1 < COUNT {
            let middle = std::array::from_fn(|c| 0.5 * (CIE_1931[i][c] + CIE_1931[i + 1][c]));
            add(4.0 / 6.0, lambda + 0.5, middle);
        }
    }
    sum.map(|s| s / NORMALISATION)
}

/// The luminance Y of the spectral radiance `spectrum`; 1 for [`crate::illuminants::d65`].
pub fn luminance(spectrum: impl Fn(f64) -> f64) -> f64 {
    xyz(spectrum)[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matches_published_values() {
        // CIE 018:2019, at the maximum of ȳ and at the ends.
        assert_eq!(colour_matching(555.0), [0.512_050_1, 1.0, 0.005_749_999]);
        assert_eq!(colour_matching(359.999), [0.0; 3]);
        assert_eq!(colour_matching(830.001), [0.0; 3]);
        assert!(colour_matching(830.0)[1] > 0.0);
        // Published sums over 360–830 nm at 1 nm.
        let sum = (0..COUNT).fold([0.0; 3], |s, i| {
            std::array::from_fn(|c: usize| s[c] + CIE_1931[i][c])
        });
        for (s, published) in sum.iter().zip([106.865_469, 106.856_917, 106.892_251]) {
            assert!((s - published).abs() < 1e-5, "{s} {published}");
        }
    }

    #[test]
    fn equal_energy_is_the_equal_energy_point() {
        let [x, y, z] = xyz(|_| 1.0);
        let s = x + y + z;
        // CIE 015: illuminant E at x = 0.33331, y = 0.33329 for this observer at 1 nm.
        assert!((x / s - 0.333_31).abs() < 1e-4 && (y / s - 0.333_29).abs() < 1e-4);
        assert!((y - 106.8569 / NORMALISATION).abs() < 1e-5);
    }
}
