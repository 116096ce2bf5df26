//! How much light a smooth interface reflects.
//!
//! Unpolarised light: the mean of the two polarisations (Fresnel 1823; Born & Wolf 1999,
//! *Principles of Optics*, section 1.5). Indices are relative: η is that of the medium entered
//! over that of the medium left.

use crate::quadrature::gauss_legendre;
pub use etalon_math::fresnel::dielectric;
use etalon_math::lane::{Lane, Mask, Spectral};

/// [`dielectric`] for an index per wavelength: the reflectances, and the refracted cosine of the wavelength that chooses.
#[inline(always)]
pub fn dielectric_spectrum<F: Lane>(cos: F, eta: F::Spectrum) -> (F::Spectrum, F) {
    let (hero, cos_t) = dielectric(cos, eta.hero());
    if eta.is_uniform().all() {
        return (F::Spectrum::uniform(hero), cos_t);
    }
    let [_, b, c, d] = eta.waves();
    let reflectance = |eta| dielectric(cos, eta).0;
    let waves = [hero, reflectance(b), reflectance(c), reflectance(d)];
    (F::Spectrum::from_waves(waves), cos_t)
}

/// Reflectance of a conductor with relative complex index η + ik, per wavelength, for a direction
/// with cosine `cos` (0 or more). (Born & Wolf 1999, section 14.2; the form without complex numbers
/// is that of Siegel & Howell 2001, *Thermal Radiation Heat Transfer*, eq. 3-35 ff.)
#[inline(always)]
pub fn conductor<F: Lane, S: Spectral<F>>(cos: F, eta: S, k: S) -> S {
    let cos2 = cos * cos;
    let sin2 = F::ONE - cos2;
    // η² − k² − sin²θ, arranged so that η near 1 keeps its digits at grazing angles.
    let real = (eta - F::ONE) * (eta + F::ONE) - k * k + cos2;
    let a2_b2 = (real * real + eta * F::splat(4.0) * eta * k * k).square_roots();
    let a = (((a2_b2 + real) * F::splat(0.5)).at_least(F::ZERO)).square_roots();
    let sum = a2_b2 + cos2;
    let cross = a * (cos * 2.0);
    let s = quotient(sum - cross, sum + cross);
    let sum = a2_b2 * cos2 + sin2 * sin2;
    let cross = cross * sin2;
    let p = s * quotient(sum - cross, sum + cross);
    (s + p) * F::splat(0.5)
}

/// a / b, which rounding may bring out of [0, 1]; 1 where both vanish (an index-matched wavelength at grazing incidence).
#[inline(always)]
fn quotient<F: Lane, S: Spectral<F>>(a: S, b: S) -> S {
    (a / b).at_least(F::ZERO).below(F::ONE)
}

/// The share of diffuse light inside a smooth dielectric that its interface reflects back, for
/// an `eta` of the inside over the outside.
///
/// The fits that Mitsuba 3 uses, so that `plastic` has its energy: above 1, d'Eon & Irving
/// (2011), *A Quantized-Diffusion Model for Rendering Translucent Materials*; below, that is
/// seen from the denser side, Egan & Hilgeman (1973). They are within 0.5 % of the integral
/// 2 ∫ F(μ, 1/η) μ dμ for η between 0.4 and 2.5; beyond, where they soon exceed 1, the integral
/// itself is taken.
pub fn internal_diffuse_reflectance(eta: f64) -> f64 {
    if !(0.4..=2.5).contains(&eta) {
        return diffuse_reflectance(1.0 / eta);
    }
    // The light arrives from inside: its relative index is 1/η.
    let relative = 1.0 / eta;
    if relative < 1.0 {
        0.0636 * eta + 0.6681 + relative * (0.7099 - 1.4399 * relative)
    } else {
        [-1.36881, 4.98554, -7.80989, 6.75335, -3.4793, 0.919317]
            .iter()
            .fold(0.0, |sum, c| sum * eta + c)
    }
}

/// 2 ∫ F(μ, η) μ dμ over [0, 1] by quadrature, apart on either side of the critical angle.
fn diffuse_reflectance(eta: f64) -> f64 {
    let critical = (1.0 - eta * eta).max(0.0).sqrt();
    let below: f64 = gauss_legendre(64)
        .into_iter()
        .map(|(x, weight)| {
            // Squared, since F begins at the critical angle with an infinite slope.
            let mu = critical + (1.0 - critical) * x * x;
            let reflectance = f64::from(dielectric(mu as f32, eta as f32).0);
            2.0 * mu * reflectance * weight * 2.0 * x * (1.0 - critical)
        })
        .sum();
    critical * critical + below
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec4;

    #[test]
    fn dielectric_matches_known_points() {
        // Normal incidence: ((η − 1)/(η + 1))².
        assert!((dielectric(1.0, 1.5).0 - 0.04).abs() < 1e-7);
        // Brewster's angle: the p polarisation vanishes, half of the s polarisation remains.
        let cos = 1.0 / (1.0f32 + 1.5 * 1.5).sqrt();
        let s = (1.0 - 1.5f32 * 1.5) / (1.0 + 1.5 * 1.5);
        assert!((dielectric(cos, 1.5).0 - 0.5 * s * s).abs() < 1e-6);
        assert_eq!(dielectric(0.5, 1.0 / 1.5), (1.0, 0.0));
        assert_eq!(dielectric(0.0, 1.5).0, 1.0);
    }

    #[test]
    fn conductor_without_absorption_is_a_dielectric() {
        for i in 0..=100 {
            let cos = i as f32 / 100.0;
            let metal = conductor(cos, Vec4::splat(1.5), Vec4::ZERO).x;
            assert!((metal - dielectric(cos, 1.5).0).abs() < 2e-6, "{cos}");
        }
    }

    #[test]
    fn conductor_matches_complex_arithmetic() {
        // r_s = (c − n c_t)/(c + n c_t) in complex numbers, worked out in f64 as (re, im).
        type C = (f64, f64);
        let mul = |a: C, b: C| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
        let div = |a: C, b: C| {
            let d = b.0 * b.0 + b.1 * b.1;
            ((a.0 * b.0 + a.1 * b.1) / d, (a.1 * b.0 - a.0 * b.1) / d)
        };
        let sqrt = |a: C| {
            let r = (a.0 * a.0 + a.1 * a.1).sqrt();
            (
                ((r + a.0) / 2.0).sqrt(),
                ((r - a.0) / 2.0).sqrt().copysign(a.1),
            )
        };
        for (eta, k) in [(0.2, 3.9), (1.4, 7.5), (3.0, 0.3)] {
            for i in 1..=20 {
                let c = f64::from(i) / 20.0;
                let n = (eta, k);
                let n2 = mul(n, n);
                let root = sqrt((n2.0 - (1.0 - c * c), n2.1));
                let norm = |a: C| a.0 * a.0 + a.1 * a.1;
                let s = norm(div((c - root.0, -root.1), (c + root.0, root.1)));
                let nc = (n2.0 * c, n2.1 * c);
                let p = norm(div(
                    (nc.0 - root.0, nc.1 - root.1),
                    (nc.0 + root.0, nc.1 + root.1),
                ));
                let here = conductor(c as f32, Vec4::splat(eta as f32), Vec4::splat(k as f32)).x;
                assert!((f64::from(here) - 0.5 * (s + p)).abs() < 3e-6);
            }
        }
    }

    #[test]
    fn degenerate_conductors_reflect_within_bounds() {
        assert_eq!(conductor(0.7, Vec4::ZERO, Vec4::ONE), Vec4::ONE);
        for cos in [0.0, 1e-20, 1e-4, 1.0] {
            for (eta, k) in [(1.0, 0.0), (0.0, 0.0), (1e-3, 1e3), (50.0, 50.0)] {
                let r = conductor(cos, Vec4::splat(eta), Vec4::splat(k));
                assert!(r.min_element() >= 0.0 && r.max_element() <= 1.0 + 1e-6);
            }
        }
    }

    #[test]
    fn quadrature_of_the_diffuse_reflectance_is_right() {
        for eta in [0.1, 0.4, 0.7, 1.3, 2.0, 30.0] {
            let n = 200_000;
            let integral: f64 = (0..n)
                .map(|i| {
                    let mu = (f64::from(i) + 0.5) / f64::from(n);
                    2.0 * mu * f64::from(dielectric(mu as f32, eta as f32).0)
                })
                .sum::<f64>()
                / f64::from(n);
            let here = diffuse_reflectance(eta);
            assert!((here - integral).abs() < 1e-5, "{eta} {here} {integral}");
        }
    }

    #[test]
    fn fits_are_within_half_a_percent_of_the_integral() {
        for eta in [0.41, 1.0 / 1.5, 1.2, 1.33, 1.49, 1.9, 2.4] {
            let fit = internal_diffuse_reflectance(eta);
            let integral = diffuse_reflectance(1.0 / eta);
            assert!(
                (fit - integral).abs() < 5e-3 * integral,
                "{eta} {fit} {integral}"
            );
        }
    }
}
