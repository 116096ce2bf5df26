//! The normal distribution: p(x) = exp(−(x − µ)²/2σ²) / (σ√2π).

use core::f64::consts::{FRAC_1_SQRT_2, PI, SQRT_2};
use etalon_math::float::{exp, ln, sin_cos_turns};
use etalon_math::float64;
use glam::Vec2;

const FRAC_1_SQRT_TAU: f64 = 0.398_942_280_401_432_7;

/// Two independent standard normal numbers (Box & Muller 1958); within ±5.8.
#[inline]
pub fn square_to_normal(u: Vec2) -> Vec2 {
    // 1 − u.x is in (0, 1]: its logarithm is finite.
    let radius = (-2.0 * ln(1.0 - u.x)).sqrt();
    let (sin, cos) = sin_cos_turns(u.y);
    Vec2::new(radius * cos, radius * sin)
}

/// The density of one standard normal number.
#[inline]
pub fn standard_normal_density(x: f32) -> f32 {
    FRAC_1_SQRT_TAU as f32 * exp(-0.5 * x * x)
}

/// The density of a normal number with the given mean and standard deviation (positive).
#[inline]
pub fn normal_density(x: f32, mean: f32, deviation: f32) -> f32 {
    standard_normal_density((x - mean) / deviation) / deviation
}

/// The probability of a standard normal number below `x`, to nearly full relative precision
/// in the lower tail.
pub fn normal_cdf(x: f64) -> f64 {
    0.5 * float64::erfc(-x * FRAC_1_SQRT_2)
}

/// The number below which a standard normal number falls with probability `p`, the inverse of
/// [`normal_cdf`]; −∞ at 0 and +∞ at 1.
///
/// Three steps of Halley's method from the closed approximation of Winitzki (2008), in the
/// lower half, where `p` is precise; relative error below 10⁻¹³.
pub fn inverse_normal_cdf(p: f64) -> f64 {
    if !(p > 0.0) {
        return f64::NEG_INFINITY;
    }
    if p >= 1.0 {
        return f64::INFINITY;
    }
    if p == 0.5 {
        return 0.0;
    }
    let tail = p.min(1.0 - p);
    const A: f64 = 0.147;
    // 1 − erf² of the point, logarithmically: 4·tail·(1 − tail).
    let log = float64::ln(4.0 * tail * (1.0 - tail));
    let half = 2.0 / (PI * A) + 0.5 * log;
    let mut x = -SQRT_2 * float64::safe_sqrt((half * half - log / A).sqrt() - half);
    for _ in 0..3 {
        // With f = Φ − p, f'' / f' = −x.
        let density = FRAC_1_SQRT_TAU * float64::exp(-0.5 * x * x);
        let step = (normal_cdf(x) - tail) / density;
        x -= step / (1.0 + 0.5 * x * step);
    }
    if p < 0.5 { x } else { -x }
}
