//! Spectra η and k of a metal from linear Rec. 709 triples of η and k.
//!
//! Triples of a measured metal, to 1 % in each component, are replaced by its curves. Otherwise the reflectance at normal
//! incidence is preserved, as it decides the appearance. With c over the channels and F Fresnel's equation,
//!
//! ```text
//! F(η, k) = ((η − 1)² + k²) / ((η + 1)² + k²)
//! R(λ) = the bounded spectrum of the colour F(η_c, k_c), at most 1 − 10⁻⁶
//! η(λ) = the spectrum of the colour η_c, held to [1/m, m],  m = (1 + √R) / (1 − √R)
//! k(λ)² = (R (η + 1)² − (η − 1)²) / (1 − R)
//! ```
//!
//! so that F(η(λ), k(λ)) = R(λ): under D65 the metal has the colour that an RGB renderer gives it. (No k has that
//! reflectance for η > m.) Upsampling η and k independently misses it by up to 0.07, for gold.

use crate::conductors::{held, lookup, names};
use crate::{LAMBDA_MAX, LAMBDA_MIN, Spectrum, SpectrumError};

/// Most of the light that R(λ) gives back; k grows without bound toward 1.
const MOST: f64 = 1.0 - 1e-6;

/// Relative tolerance of a component to match a metal.
const NEAR: f64 = 0.01;

/// A metal and the linear Rec. 709 triples of its η and k.
type Published = (&'static str, [[f64; 3]; 2]);

/// The triples that Tungsten tabulates, and that exporters and converted scenes carry on. They were computed from
/// handbook curves as if these were radiances (the constant spectrum is not white), partly of other measurements than ours.
static PUBLISHED: &[Published] = &[
    (
        "a-C",
        [
            [2.944_100, 2.227_150, 1.968_167],
            [0.887_433, 0.799_322, 0.815_286],
        ],
    ),
    (
        "Ag",
        [
            [0.155_265, 0.116_723, 0.138_381],
            [4.828_343, 3.122_246, 2.146_950],
        ],
    ),
    (
        "Al",
        [
            [1.657_460, 0.880_369, 0.521_229],
            [9.223_869, 6.269_523, 4.837_001],
        ],
    ),
    (
        "Au",
        [
            [0.143_119, 0.374_957, 1.442_479],
            [3.983_160, 2.385_721, 1.603_215],
        ],
    ),
    (
        "Cr",
        [
            [4.369_683, 2.916_702, 1.654_701],
            [5.206_434, 4.231_365, 3.754_947],
        ],
    ),
    (
        "Cu",
        [
            [0.200_438, 0.924_033, 1.102_212],
            [3.912_949, 2.452_848, 2.142_188],
        ],
    ),
    (
        "Hg",
        [
            [2.398_931, 1.440_025, 0.909_551],
            [6.327_627, 4.371_941, 3.421_790],
        ],
    ),
];

/// The name, for [`lookup`], of the metal that the triples of `eta` and `k` were computed from.
pub fn metal(eta: [f64; 3], k: [f64; 3]) -> Option<&'static str> {
    let is = |known: [[f64; 3]; 2]| {
        let pairs = known
            .as_flattened()
            .iter()
            .zip([eta, k].into_iter().flatten());
        pairs
            .into_iter()
            .all(|(known, given)| (given - known).abs() <= NEAR * known.abs())
    };
    let published = PUBLISHED.iter().find(|(_, triples)| is(*triples));
    published.map(|(name, _)| *name).or_else(|| {
        names().find(|name| {
            lookup(name).is_some_and(|(eta, k)| {
                is([eta.rgb(), k.rgb()]) || is([eta.rgb_under_d65(), k.rgb_under_d65()])
            })
        })
    })
}

/// Smooth η and k of the triples `eta` and `k`, components 0 or more. Those of a grey metal are constant.
///
/// # Errors
/// A component that is negative or not finite.
pub fn smooth(eta: [f64; 3], k: [f64; 3]) -> Result<(Spectrum, Spectrum), SpectrumError> {
    let (index, extinction) = (Spectrum::unbounded(eta)?, Spectrum::unbounded(k)?);
    let grey = |[r, g, b]: [f64; 3]| r == g && g == b;
    if grey(eta) && grey(k) {
        return Ok((index, extinction));
    }
    let colour = std::array::from_fn(|c| reflectance(eta[c], k[c]));
    let reflected = Spectrum::reflectance(colour)?;
    let wavelengths: Vec<f64> = (LAMBDA_MIN as i32..=LAMBDA_MAX as i32)
        .map(f64::from)
        .collect();
    let values = wavelengths.iter().map(|&lambda| {
        let share = reflected.eval_at(lambda).min(MOST);
        let root = share.sqrt();
        let most = (1.0 + root) / (1.0 - root);
        let n = index.eval_at(lambda).clamp(1.0 / most, most);
        let square = (share * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - share);
        (n, square.max(0.0).sqrt())
    });
    let (etas, ks): (Vec<f64>, Vec<f64>) = values.unzip();
    Ok((held(&wavelengths, &etas)?, held(&wavelengths, &ks)?))
}

/// F(η, k) at normal incidence.
fn reflectance(eta: f64, k: f64) -> f64 {
    let square = k * k;
    // Infinite indices are refused before; their squares reflect everything.
    let share = ((eta - 1.0) * (eta - 1.0) + square) / ((eta + 1.0) * (eta + 1.0) + square);
    if share.is_finite() { share } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{cie, colour_space, illuminants};

    /// Linear Rec. 709 of the reflectance at normal incidence, lit by D65.
    fn colour((eta, k): &(Spectrum, Spectrum)) -> [f64; 3] {
        colour_space::xyz_to_rgb(cie::xyz(|lambda| {
            illuminants::d65(lambda) * reflectance(eta.eval_at(lambda), k.eval_at(lambda))
        }))
    }

    fn furthest(a: [f64; 3], b: [f64; 3]) -> f64 {
        (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn triples_of_measured_metals_are_theirs() {
        for name in ["Al", "Ag", "Au", "Cu", "Cr"] {
            let (eta, k) = lookup(name).expect("the metal has data");
            let published = PUBLISHED.iter().find(|(known, _)| *known == name);
            let [a, b] = published.expect("its triples are published").1;
            for (eta, k) in [
                (eta.rgb(), k.rgb()),
                (eta.rgb_under_d65(), k.rgb_under_d65()),
                (a, b),
                // As exporters round them.
                (
                    a.map(|x| (x * 1e3).round() / 1e3),
                    b.map(|x| (x * 1e3).round() / 1e3),
                ),
                (a.map(|x| x * 1.009), b.map(|x| x * 0.991)),
            ] {
                assert_eq!(metal(eta, k), Some(name), "{eta:?} {k:?}");
            }
            // Both must be the metal's.
            assert_eq!(metal(a, b.map(|x| x * 1.02)), None);
            assert_eq!(metal(a.map(|x| x * 0.98), b), None);
        }
    }

    #[test]
    fn other_triples_keep_the_colour_that_three_channels_give() {
        for (name, [eta, k]) in PUBLISHED {
            for (a, b) in [(0.95, 0.95), (0.95, 1.05), (1.05, 0.95), (1.05, 1.05)] {
                let (eta, k) = (eta.map(|x| x * a), k.map(|x| x * b));
                assert_eq!(metal(eta, k), None);
                let expected = std::array::from_fn(|c| reflectance(eta[c], k[c]));
                let made = smooth(eta, k).expect("components above 0");
                let found = colour(&made);
                assert!(
                    furthest(found, expected) < 2e-3,
                    "{name}: {found:?} {expected:?}"
                );
                assert!(made.1.maximum() < 30.0, "{name}: {}", made.1.maximum());
            }
        }
    }

    #[test]
    fn the_ends_are_safe() {
        // A perfect mirror, glass, and one channel that reflects everything.
        let mirror = smooth([0.0; 3], [1.0; 3]).expect("a mirror");
        assert_eq!((mirror.0.range(), mirror.1.range()), ([0.0; 2], [1.0; 2]));
        for (eta, k) in [
            ([1.5, 1.6, 1.7], [0.0; 3]),
            ([0.0, 0.5, 1.0], [3.0, 0.0, 3.0]),
            ([1e-9, 1.0, 1e3], [0.0, 1.0, 1e200]),
        ] {
            let made = smooth(eta, k).expect("components 0 or more");
            for spectrum in [&made.0, &made.1] {
                let [low, high] = spectrum.range();
                assert!(
                    low >= 0.0 && high.is_finite(),
                    "{eta:?} {k:?}: {low} {high}"
                );
            }
            let expected = std::array::from_fn(|c| reflectance(eta[c], k[c]));
            assert!(furthest(colour(&made), expected) < 5e-3, "{eta:?} {k:?}");
        }
        assert!(smooth([-1.0, 0.0, 1.0], [1.0; 3]).is_err());
        assert!(smooth([1.0; 3], [1.0, f64::NAN, 1.0]).is_err());
    }
}
