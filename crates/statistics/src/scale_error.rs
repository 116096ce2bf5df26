//! The distribution of an estimated standard error: X = √(χ²ᵥ / ν), and means over it.
//!
//! The density of y = ln X is C · exp(ν (y − e^{2y} / 2)) with C = 2 (ν/2)^{ν/2} / Γ(ν/2). It is
//! entire and smooth for every ν > 0, so Gauss–Legendre panels reach full accuracy; what lies
//! beyond 10⁻²⁶ of its peak is left out.

use crate::quadrature::integrate;
use std::f64::consts::PI;

/// The exponent, relative to the peak, where the density is cut off.
const CUT: f64 = -60.0;

/// The mean of g(X) for `degrees_of_freedom` ν, where g changes quickly only between the two
/// numbers in `steep` (both may lie outside the density's reach), and is zero beyond `zero_above`.
pub(crate) fn mean(
    degrees_of_freedom: f64,
    steep: [f64; 2],
    zero_above: f64,
    g: impl Fn(f64) -> f64,
) -> f64 {
    let nu = degrees_of_freedom;
    let exponent = |y: f64| nu * (y - 0.5 * libm::expm1(2.0 * y));
    let low = cut(&exponent, -60.0 / nu - 1.0);
    let high = cut(&exponent, (60.0 / nu).sqrt()).min(libm::log(zero_above));
    let mut knots = [low, high, high, high];
    for (knot, x) in knots[1..3].iter_mut().zip(steep) {
        *knot = if x > 0.0 { libm::log(x) } else { low };
        *knot = knot.clamp(low, high.max(low));
    }
    let scale = (2.0 * nu).sqrt().max(1.0);
    let integral: f64 = knots
        .windows(2)
        .filter(|ends| ends[1] > ends[0])
        .map(|ends| {
            let panels = ((ends[1] - ends[0]) * scale).ceil().max(8.0) as usize;
            integrate(ends[0], ends[1], panels, |y| {
                libm::exp(exponent(y)) * g(libm::exp(y))
            })
        })
        .sum();
    integral * peak(nu)
}

/// Where the exponent falls to [`CUT`] between zero and `outside`.
fn cut(exponent: &impl Fn(f64) -> f64, outside: f64) -> f64 {
    let (mut inside, mut outside) = (0.0, outside);
    for _ in 0..40 {
        let middle = 0.5 * (inside + outside);
        if exponent(middle) > CUT {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    outside
}

/// C · exp(−ν/2), by Stirling's series where the gamma function's logarithm would cancel.
fn peak(nu: f64) -> f64 {
    let a = 0.5 * nu;
    if a < 30.0 {
        return 2.0 * libm::exp(a * libm::log(a) - libm::lgamma(a) - a);
    }
    let r = 1.0 / (a * a);
    let series = (1.0 / 12.0 - r * (1.0 / 360.0 - r * (1.0 / 1260.0 - r / 1680.0))) / a;
    2.0 * (a / (2.0 * PI)).sqrt() * libm::exp(-series)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// E 1 = 1, E X² = 1 and E X = √(2/ν) Γ((ν+1)/2) / Γ(ν/2).
    #[test]
    fn moments() {
        for nu in [0.7, 1.0, 2.5, 7.0, 59.0, 61.0, 1e3, 1e6] {
            let moment = |g: fn(f64) -> f64| mean(nu, [0.9, 1.1], f64::INFINITY, g);
            assert!((moment(|_| 1.0) - 1.0).abs() < 1e-12, "{nu}");
            assert!((moment(|x| x * x) - 1.0).abs() < 1e-12, "{nu}");
        }
        // E X for ν = 1 and 2: √(2/π), √π/2.
        let first = |nu| mean(nu, [0.0, 0.0], f64::INFINITY, |x| x);
        assert!((first(1.0) - (2.0 / PI).sqrt()).abs() < 1e-13);
        assert!((first(2.0) - 0.5 * PI.sqrt()).abs() < 1e-13);
        // P(X < 1) for ν = 2 is 1 − 1/e.
        let below = mean(2.0, [1.0, 1.0], 1.0, |_| 1.0);
        assert!((below + libm::expm1(-1.0)).abs() < 1e-13);
    }
}
