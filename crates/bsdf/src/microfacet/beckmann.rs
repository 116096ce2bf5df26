//! The distribution of Beckmann & Spizzichino (1963): Gaussian slopes.

use core::f32::consts::FRAC_2_SQRT_PI;
use etalon_math::lane::{Lane, Mask, Select, Vector, branch, erf, exp, ln, sin_cos_turns};

const FRAC_1_SQRT_PI: f32 = 0.5 * FRAC_2_SQRT_PI;

/// G1 for α² tan² θ by the rational approximation of Walter et al. (2007, eq. 27 f.).
#[inline(always)]
pub fn g1_rational<F: Lane>(roughness2: F) -> F {
    let a = F::ONE / roughness2.sqrt();
    let rational = a * (a * 2.181 + 3.535) / (a * (a * 2.577 + 2.276) + 1.0);
    a.ge(F::splat(1.6)).select(F::ONE, rational)
}

/// G1 = 2 / (1 + erf a + exp(−a²)/(a√π)), a = 1/(α tan θ) (ibid., eq. 26).
#[inline(always)]
pub fn g1_exact<F: Lane>(roughness2: F) -> F {
    // Above a = 4.5 the difference from 1 is below 10⁻¹⁰.
    let nearly_one = roughness2.le(F::splat(1.0 / (4.5 * 4.5)));
    branch!(nearly_one, F::ONE, {
        let t = roughness2.sqrt();
        let a = F::ONE / t;
        F::splat(2.0) / (erf(a) + 1.0 + exp(-a * a) * t * FRAC_1_SQRT_PI)
    })
}

/// Slopes for α = 1 as they are on the surface: tan² θ = −ln(1 − u) (ibid., eq. 28).
#[inline(always)]
pub fn sample_slopes<F: Lane>([u, v]: [F; 2]) -> [F; 2] {
    let radius = (-ln(F::ONE - u)).safe_sqrt();
    let (sin, cos) = sin_cos_turns(v);
    [cos * radius, sin * radius]
}

/// Slopes for α = 1 as seen from the unit vector `from` with z > 0 (Heitz & d'Eon 2014,
/// *Importance Sampling Microfacet-Based BSDFs using the Distribution of Visible Normals*).
///
/// Along the azimuth of `from`, the slope x has the density ∝ (cos θ − x sin θ) exp(−x²) up to
/// x = cot θ; its distribution function, times 2, is cos θ·c + sin θ exp(−x²)/√π with
/// c = 1 + erf x, and is inverted by Halley's method in c, where it is concave (after W. Jakob
/// 2014, *An Improved Visible Normal Sampling Routine for the Beckmann Distribution*). Across,
/// the slope is Gaussian.
#[inline(always)]
pub fn sample_visible_slopes<F: Lane>(from: F::Vector, [u, v]: [F; 2]) -> [F; 2] {
    let [x, y, cos] = from.xyz();
    let sin = (x * x + y * y).sqrt();
    let has_azimuth = sin.gt(F::splat(1e-7));
    let [x, y] = has_azimuth.select([x / sin, y / sin], [F::ONE, F::ZERO]);
    let along = visible_slope(cos, sin, u);
    // A uniform number may be 0, whose slope would be infinite.
    let across = inverse_erf_plus_one(v.max(F::splat(0.5 * f32::EPSILON)) * 2.0);
    [x * along - y * across, y * along + x * across]
}

/// The slope x of a visible facet, for the cosine and sine of the direction.
#[inline(always)]
fn visible_slope<F: Lane>(cos: F, sin: F, u: F) -> F {
    // c at the steepest visible slope, cot θ.
    let a = cos / sin.max(F::splat(1e-7));
    let limit = erf(a) + 1.0;
    let grazing = sin * FRAC_1_SQRT_PI;
    let target = u * (cos * limit + grazing * exp(-a * a));
    let (mut low, mut high) = (F::ZERO, limit);
    // Exact at normal incidence (p = 1); elsewhere p is fitted so that c is within 0.03.
    let p = sin * (sin * (sin * 0.133 + 0.106) - 0.795) + 1.0;
    let mut c = limit * (F::ONE - exp(p * ln(F::ONE - u)));
    let mut slope = F::ZERO;
    let mut open = F::Mask::splat(true);
    for _ in 0..12 {
        let inside = c.gt(low) & c.lt(high);
        c = inside.select(c, (low + high) * 0.5);
        let x = inverse_erf_plus_one(c);
        let gauss = exp(-x * x);
        let error = cos * c + grazing * gauss - target;
        [low, high] = error.gt(F::ZERO).select([low, c], [c, high]);
        // dx/dc = (√π/2) exp(x²); the error's derivatives in c are cos − sin·x and −sin·dx/dc.
        let dx_dc = F::ONE / (gauss * FRAC_2_SQRT_PI);
        let derivative = cos - sin * x;
        let newton = error / derivative;
        let step = newton / (newton * 0.5 * sin * dx_dc / derivative + 1.0);
        let close = step.abs().le(c * 2e-3);
        // The remainder is of third order: two terms of the Taylor series suffice.
        let dx = -step * dx_dc;
        slope = (open & close).select(x + dx * (x * dx + 1.0), slope);
        open = open & !close;
        if !open.any() {
            return slope;
        }
        c = c - step;
    }
    branch!(open, inverse_erf_plus_one(c), slope)
}

/// The x for which 1 + erf x is `c`, in (0, 2): precise near 0 too. (M. Giles 2012,
/// *Approximating the erfinv Function*, single precision.)
#[inline(always)]
fn inverse_erf_plus_one<F: Lane>(c: F) -> F {
    let c = c.clamp(1e-30, 2.0 - 1.2e-7);
    let w = -ln(c * (F::splat(2.0) - c));
    let ratio = branch!(
        w.lt(F::splat(5.0)),
        (w - 2.5).polynomial([
            2.810_226_4e-8,
            3.432_739_4e-7,
            -3.523_387_7e-6,
            -4.391_506_5e-6,
            2.185_808_7e-4,
            -1.253_725e-3,
            -4.177_681_6e-3,
            0.246_640_73,
            1.501_409_4,
        ]),
        (w.sqrt() - 3.0).polynomial([
            -2.002_142_6e-4,
            1.009_505_6e-4,
            1.349_343_2e-3,
            -3.673_428_4e-3,
            5.739_507_7e-3,
            -7.622_461_3e-3,
            9.438_870_5e-3,
            1.001_674,
            2.832_976_8,
        ])
    );
    ratio * (c - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_error_function_inverts() {
        for i in 1..4000 {
            let x = f64::from(i) * 0.001 - 2.0;
            let c = 1.0 + etalon_math::float64::erf(x);
            assert!(
                (f64::from(inverse_erf_plus_one(c as f32)) - x).abs() < 2e-5,
                "{x}"
            );
        }
        // The lower tail keeps its precision: 1 + erf(−4) = 1.5417257900e-8.
        assert!((inverse_erf_plus_one(1.541_725_8e-8) + 4.0).abs() < 1e-4);
    }

    #[test]
    fn rational_g1_is_within_its_stated_error() {
        for i in 1..4000 {
            let t2 = (i as f32 * 0.01).powi(2);
            assert!((g1_rational(t2) / g1_exact(t2) - 1.0).abs() < 3.6e-3);
        }
    }

    #[test]
    fn visible_slopes_invert_their_distribution() {
        // The distribution function at the returned slope, in f64, is the number that went in.
        let cdf = |cos: f64, sin: f64, x: f64| {
            cos * etalon_math::float64::erfc(-x)
                + sin * etalon_math::float64::exp(-x * x) / core::f64::consts::PI.sqrt()
        };
        for i in 0..=40 {
            let cos = (f64::from(i) / 40.0).max(1e-4);
            let sin = (1.0 - cos * cos).sqrt();
            for j in 1..200 {
                let u = f64::from(j) / 200.0;
                let x = f64::from(visible_slope(cos as f32, sin as f32, u as f32));
                let limit = if sin > 0.0 { cos / sin } else { 40.0 };
                let back = cdf(cos, sin, x) / cdf(cos, sin, limit);
                assert!((back - u).abs() < 3e-6, "{cos} {u} {x} {back}");
            }
        }
    }
}
