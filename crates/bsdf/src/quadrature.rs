//! Gauss–Legendre quadrature.

use etalon_math::float64;

/// Nodes and weights of Gauss–Legendre quadrature on [0, 1], by Newton's method on the Legendre
/// polynomials (Press et al. 2007, section 4.6).
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            let mut x = float64::cos(core::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5));
            let mut derivative = 1.0;
            for _ in 0..8 {
                let (mut p, mut previous) = (1.0, 0.0);
                for k in 0..n {
                    let k = k as f64;
                    (p, previous) = (((2.0 * k + 1.0) * x * p - k * previous) / (k + 1.0), p);
                }
                derivative = n as f64 * (x * p - previous) / (x * x - 1.0);
                x -= p / derivative;
            }
            (
                0.5 * (1.0 + x),
                1.0 / ((1.0 - x * x) * derivative * derivative),
            )
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadrature_is_exact_for_polynomials() {
        let nodes = gauss_legendre(48);
        for power in [0, 1, 5, 40, 95] {
            let sum: f64 = nodes.iter().map(|(x, w)| w * x.powi(power)).sum();
            assert!(
                (sum - 1.0 / f64::from(power + 1)).abs() < 1e-13,
                "{power} {sum}"
            );
        }
    }
}
