//! K₀, the modified Bessel function of the second kind: how a field that is absorbed falls off about a line,
//!
//! ```text
//! K₀(x) = ∫₀^∞ e^(−x cosh t) dt
//! ```
//!
//! by the polynomials of M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions, 1964, 9.8.1, 9.8.5 and 9.8.6.

use crate::float::{exp, ln};

fn polynomial(x: f32, coefficients: &[f32]) -> f32 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// K₀(x) for x > 0, to 10⁻⁶ of it.
pub fn bessel_k0(x: f32) -> f32 {
    if x > 2.0 {
        let series = [
            1.253_314_1,
            -0.078_323_58,
            0.021_895_68,
            -0.010_624_46,
            0.005_878_72,
            -0.002_515_4,
            0.000_532_08,
        ];
        return polynomial(2.0 / x, &series) * exp(-x) / x.sqrt();
    }
    let series = [
        -0.577_215_7,
        0.422_784_2,
        0.230_697_56,
        0.034_885_9,
        0.002_626_98,
        0.000_107_5,
        0.000_007_4,
    ];
    let i0 = [
        1.0,
        3.515_623,
        3.089_942_5,
        1.206_749_2,
        0.265_973_2,
        0.036_076_8,
        0.004_581_3,
    ];
    let (half, part) = (0.5 * x, x / 3.75);
    polynomial(half * half, &series) - ln(half) * polynomial(part * part, &i0)
}

#[cfg(test)]
mod tests {
    use super::bessel_k0;
    use crate::float64::{exp, pow};

    /// Against the integral, by the trapezoid rule, which is exact to all digits for it.
    #[test]
    fn it_is_its_integral() {
        for i in 0..60 {
            let x = 1e-4 * pow(1.25, f64::from(i));
            let steps = 4000;
            let width = 16.0 / f64::from(steps);
            let sum: f64 = (0..=steps)
                .map(|i| {
                    let t = f64::from(i) * width;
                    let cosh = 0.5 * (exp(t) + exp(-t));
                    exp(-x * cosh) * if i == 0 { 0.5 } else { 1.0 }
                })
                .sum();
            let off = f64::from(bessel_k0(x as f32)) / (sum * width) - 1.0;
            assert!(off.abs() < 2e-6, "{x}: {off}");
        }
    }
}
