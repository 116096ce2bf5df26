//! The Anderson–Darling test of a sample against a continuous distribution.
//!
//! A² = −n − (1/n) Σᵢ (2i − 1) [ln u₍ᵢ₎ + ln(1 − u₍ₙ₊₁₋ᵢ₎)], uᵢ = F(xᵢ)
//!
//! (Anderson & Darling 1954). It weighs the tails of F more than Kolmogorov–Smirnov does, which is
//! where p-values matter. In the limit A² is Σⱼ Zⱼ² / (j (j + 1)), whose tail is Smirnov's (1937)
//! alternating sum of integrals between the poles of its characteristic function,
//!
//! P(A² > z) = (1/π) Σₖ (−1)^{k+1} ∫ e^{−zu/2} √(πu / |cos(π s / 2)|) du / u, s = √(1 + 4u),
//!
//! u from (2k − 1) 2k to 2k (2k + 1), here by Gauss–Chebyshev quadrature to 12 digits. For finite
//! n the correction of Marsaglia & Marsaglia (2004, section 3), their fit to simulations, is added;
//! it agrees with two million samples of 5, 10 and 40 numbers within the simulation's own error
//! (10⁻³ in the body; in the far tail the correction is good to 1/n *relative*). A single observation
//! is exact.

use std::f64::consts::PI;

/// The outcome of a test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AndersonDarling {
    /// A²; infinite if something impossible was observed (F = 0 or 1).
    pub statistic: f64,
    /// The probability of a statistic at least this great under the hypothesis.
    pub p_value: f64,
}

/// Tests whether a sample comes from the distribution with these lower and upper tails, P(X ≤ x)
/// and P(X > x), fully specified beforehand. Both are asked for, so that neither is 1 − the other.
/// `None` of an empty sample or where a tail leaves [0, 1], NaN included.
#[must_use]
pub fn test(
    sample: &[f64],
    lower: impl Fn(f64) -> f64,
    upper: impl Fn(f64) -> f64,
) -> Option<AndersonDarling> {
    if sample.is_empty() {
        return None;
    }
    let mut tails: Vec<(f64, f64)> = sample.iter().map(|&x| (lower(x), upper(x))).collect();
    let valid = |p: f64| (0.0..=1.0).contains(&p);
    if tails.iter().any(|&(low, up)| !valid(low) || !valid(up)) {
        return None;
    }
    // Ascending x; the upper tail tells apart what the lower rounds to one.
    tails.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.total_cmp(&a.1)));
    let n = tails.len() as f64;
    let sum: f64 = (0..tails.len())
        .map(|i| {
            let opposite = tails[tails.len() - 1 - i].1;
            (2 * i + 1) as f64 * (libm::log(tails[i].0) + libm::log(opposite))
        })
        .sum();
    let statistic = -n - sum / n;
    Some(AndersonDarling {
        statistic,
        p_value: sf(statistic, tails.len()),
    })
}

/// Tests whether a sample, such as p-values under their hypothesis, is uniform on [0, 1];
/// `None` of an empty sample or of numbers outside.
#[must_use]
pub fn test_uniform(sample: &[f64]) -> Option<AndersonDarling> {
    test(sample, |x| x, |x| 1.0 - x)
}

/// The probability that A² of `n` observations exceeds `z`.
#[must_use]
pub fn sf(z: f64, n: usize) -> f64 {
    if z.is_nan() || n == 0 {
        return f64::NAN;
    }
    if z == f64::INFINITY {
        return 0.0;
    }
    if n == 1 {
        // A² = −1 − ln(u (1 − u)).
        let quarter = 4.0 * libm::exp(-1.0 - z);
        return if quarter >= 1.0 {
            1.0
        } else {
            // 1 − √(1 − q), without its cancellation.
            quarter / (1.0 + (1.0 - quarter).sqrt())
        };
    }
    let limit = limit_sf(z);
    (limit - correction(limit, n as f64)).clamp(0.0, 1.0)
}

/// The probability that A² exceeds `z` in the limit of many observations.
#[must_use]
pub fn limit_sf(z: f64) -> f64 {
    // Below this the probability of a smaller A² is less than 10⁻¹⁶ (it is 10⁻¹³ at 0.04).
    if z < 0.03 {
        return 1.0;
    }
    let mut sum = 0.0;
    for k in 1..200 {
        let term = between_poles(z, f64::from(4 * k));
        if k % 2 == 1 {
            sum += term;
        } else {
            sum -= term;
        }
        if term < 1e-17 * sum {
            break;
        }
    }
    sum.clamp(0.0, 1.0)
}

/// The integral around s = `centre` = 4k, over s = 4k + sin θ with θ from −π/2 to π/2, divided by
/// π; at equally spaced θ it converges exponentially.
fn between_poles(z: f64, centre: f64) -> f64 {
    const POINTS: u32 = 64;
    let sum: f64 = (0..POINTS)
        .map(|i| {
            let theta = PI * ((f64::from(i) + 0.5) / f64::from(POINTS) - 0.5);
            let x = libm::sin(theta);
            let s = centre + x;
            let u = 0.25 * (s * s - 1.0);
            // cos θ / √cos(πx/2) is smooth up to the ends.
            let ends = libm::cos(theta) / libm::cos(0.5 * PI * x).sqrt();
            libm::exp(-0.5 * z * u) * (PI / u).sqrt() * ends * 0.5 * s
        })
        .sum();
    sum / f64::from(POINTS)
}

/// What Marsaglia & Marsaglia add to the limit's *lower* tail for `n` observations, as a function
/// of the upper tail. In the highest fifth it vanishes with the upper tail, so that a small tail
/// keeps its relative accuracy.
fn correction(upper: f64, n: f64) -> f64 {
    let x = 1.0 - upper;
    let edge = 0.012_65 + 0.1757 / n;
    if x > 0.8 {
        // Their polynomial about x = 1, less its −6 · 10⁻⁴ there, the rounding of its coefficients.
        let q = upper;
        -q * (0.4747 - q * (6.531 - q * (43.05 - q * (162.562 - q * 255.7844)))) / n
    } else if x < edge {
        let t = x / edge;
        let t = t.sqrt() * (1.0 - t) * (49.0 * t - 102.0);
        t * (0.0037 / (n * n) + 0.000_78 / n + 0.000_06) / n
    } else {
        let t = (x - edge) / (0.8 - edge);
        let t = -0.000_226_33
            + t * (6.54034 - t * (14.6538 - t * (14.458 - t * (8.259 - 1.91864 * t))));
        t * (0.04213 + 0.01365 / n) / n
    }
}
