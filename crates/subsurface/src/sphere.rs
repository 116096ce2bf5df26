//! Scattering by a homogeneous sphere (L. Lorenz 1890, G. Mie 1908; as in C. Bohren & D. Huffman, Absorption and Scattering of
//! Light by Small Particles, 1983, chapter 4).
//!
//! With x = 2π r n/λ, the size of a sphere of radius r in a medium of index n, and m its index over that,
//!
//! ```text
//! aₙ = ((Dₙ(mx)/m + n/x) ψₙ(x) − ψₙ₋₁(x)) / ((Dₙ(mx)/m + n/x) ξₙ(x) − ξₙ₋₁(x))            (4.88)
//! bₙ = ((m Dₙ(mx) + n/x) ψₙ(x) − ψₙ₋₁(x)) / ((m Dₙ(mx) + n/x) ξₙ(x) − ξₙ₋₁(x))
//! Q_sca = 2/x² Σ (2n+1) (|aₙ|² + |bₙ|²),   Q_ext = 2/x² Σ (2n+1) Re(aₙ + bₙ)              (4.61, 4.62)
//! S₁ = Σ (2n+1)/(n(n+1)) (aₙ πₙ + bₙ τₙ),   S₂ = Σ (2n+1)/(n(n+1)) (aₙ τₙ + bₙ πₙ)        (4.74)
//! ```
//!
//! with ψ and ξ Riccati and Bessel's functions, D the logarithmic derivative of ψ, by downward recurrence (4.89), and πₙ and τₙ of
//! the angle (4.47). Unpolarised light is scattered as (|S₁|² + |S₂|²)/2.

use etalon_math::float64;
use num_complex::Complex64;

/// A sphere with the coefficients of its series.
#[derive(Clone, Debug)]
pub struct Sphere {
    size: f64,
    /// aₙ and bₙ from n = 1.
    series: Vec<[Complex64; 2]>,
}

impl Sphere {
    /// Of size x (above 0), with the index m relative to what is around; an absorbing one has a positive imaginary part.
    pub fn new(size: f64, index: Complex64) -> Self {
        // W. Wiscombe 1980: enough terms for any sphere.
        let terms = (size + 4.0 * float64::cbrt(size) + 2.0).ceil() as usize;
        let inside = index * size;
        let first = terms.max(inside.norm_sqr().sqrt() as usize) + 16;
        let mut derivative = Complex64::ZERO;
        let mut derivatives = vec![Complex64::ZERO; terms + 1];
        for n in (1..=first).rev() {
            if n <= terms {
                derivatives[n] = derivative;
            }
            let step = Complex64::from(n as f64) / inside;
            derivative = step - (derivative + step).inv();
        }
        // ψ₋₁, ψ₀, χ₋₁ and χ₀, with ξ = ψ − iχ.
        let (sin, cos) = float64::sin_cos(size);
        let [mut psi, mut chi] = [[cos, sin], [-sin, cos]];
        let series = (1..=terms).map(|n| {
            let factor = (2 * n - 1) as f64 / size;
            for function in [&mut psi, &mut chi] {
                let [before, here] = *function;
                *function = [here, factor * here - before];
            }
            let [xi_before, xi] = [0, 1].map(|i| Complex64::new(psi[i], -chi[i]));
            let term = |factor: Complex64| {
                let factor = factor + n as f64 / size;
                (factor * psi[1] - psi[0]) / (factor * xi - xi_before)
            };
            [term(derivatives[n] / index), term(derivatives[n] * index)]
        });
        Self {
            size,
            series: series.collect(),
        }
    }

    fn terms(&self) -> impl Iterator<Item = (f64, &[Complex64; 2])> {
        self.series
            .iter()
            .enumerate()
            .map(|(i, ab)| ((i + 1) as f64, ab))
    }

    /// Q_sca: what it scatters, over the light that falls on its cross-section.
    pub fn scattering(&self) -> f64 {
        let sum: f64 = self
            .terms()
            .map(|(n, [a, b])| (2.0 * n + 1.0) * (a.norm_sqr() + b.norm_sqr()))
            .sum();
        2.0 / (self.size * self.size) * sum
    }

    /// Q_ext: what it scatters or absorbs.
    pub fn extinction(&self) -> f64 {
        let sum: f64 = self
            .terms()
            .map(|(n, [a, b])| (2.0 * n + 1.0) * (a + b).re)
            .sum();
        2.0 / (self.size * self.size) * sum
    }

    /// (|S₁|² + |S₂|²)/2 where the direction of travel turns by an angle with the cosine `mu`.
    pub fn intensity(&self, mu: f64) -> f64 {
        let [mut s1, mut s2] = [Complex64::ZERO; 2];
        let [mut before, mut pi] = [0.0, 1.0];
        for (n, [a, b]) in self.terms() {
            let tau = n * mu * pi - (n + 1.0) * before;
            let weight = (2.0 * n + 1.0) / (n * (n + 1.0));
            s1 += (a * pi + b * tau) * weight;
            s2 += (a * tau + b * pi) * weight;
            [before, pi] = [pi, ((2.0 * n + 1.0) * mu * pi - (n + 1.0) * before) / n];
        }
        0.5 * (s1.norm_sqr() + s2.norm_sqr())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The example of Bohren and Huffman's appendix A: a sphere of index 1.55 and radius 0.525 µm at 0.6328 µm, as printed
    /// there.
    #[test]
    fn the_published_example_is_met() {
        let size = 2.0 * core::f64::consts::PI * 0.525 / 0.6328;
        let sphere = Sphere::new(size, Complex64::new(1.55, 0.0));
        assert!((sphere.scattering() - 3.10543).abs() < 1e-5);
        assert!((sphere.extinction() - 3.10543).abs() < 1e-5);
        // Q_back = 4/x² |S₁(180°)|².
        let back = 4.0 / (size * size) * sphere.intensity(-1.0);
        assert!((back - 2.92534).abs() < 1e-5, "{back}");
        // S₁₁ over that straight on.
        for (degrees, expected) in [(18.0, 0.356897), (27.0, 0.0766119)] {
            let mu = float64::cos(f64::to_radians(degrees));
            let share = sphere.intensity(mu) / sphere.intensity(1.0);
            assert!((share / expected - 1.0).abs() < 1e-5, "{degrees}: {share}");
        }
    }

    /// Small ones scatter as Rayleigh's (5.8), large ones take twice their cross-section, and what does not absorb scatters all.
    #[test]
    fn limits_are_met() {
        let index = Complex64::new(1.33, 0.0);
        let small = Sphere::new(0.01, index);
        let square = index * index;
        let share = (square - 1.0) / (square + 2.0);
        let rayleigh = 8.0 / 3.0 * 1e-8 * share.norm_sqr();
        assert!((small.scattering() / rayleigh - 1.0).abs() < 1e-3);
        let large = Sphere::new(3000.0, Complex64::new(1.33, 0.01));
        assert!(
            (large.extinction() - 2.0).abs() < 0.02,
            "{}",
            large.extinction()
        );
        assert!(large.scattering() < large.extinction());
        for size in [0.5, 3.0, 20.0, 400.0] {
            let sphere = Sphere::new(size, index);
            assert!((sphere.scattering() / sphere.extinction() - 1.0).abs() < 1e-9);
            if size > 100.0 {
                continue;
            }
            // 2π ∫ (|S₁|² + |S₂|²)/2 dμ = π x² Q_sca.
            let count = 200_000;
            let mean =
                (0..count).map(|i| sphere.intensity(-1.0 + (2 * i + 1) as f64 / f64::from(count)));
            let integral = mean.sum::<f64>() * 4.0 / f64::from(count);
            let expected = size * size * sphere.scattering();
            assert!(
                (integral / expected - 1.0).abs() < 1e-3,
                "{size}: {integral} {expected}"
            );
        }
    }
}
