//! Parallel light on a layer of matter that scatters evenly in all directions, seen from above.
//!
//! With the irradiance E of a plane across the light, μ₀ and μ the cosines of the ways in and out with the normal, and ϖ the
//! albedo, a layer without end has the radiance
//!
//! ```text
//! L = ϖ E/(4π) · μ₀/(μ + μ₀) · H(μ) H(μ₀),   H(μ) = 1 + ϖ/2 μ H(μ) ∫₀¹ H(μ')/(μ + μ') dμ'
//! ```
//!
//! (S. Chandrasekhar, Radiative Transfer, 1950, chapter V), one of the optical thickness τ
//!
//! ```text
//! L = ϖ E/(4π) · μ₀/(μ + μ₀) · (X(μ) X(μ₀) − Y(μ) Y(μ₀))
//! ∂X/∂τ = g Y,   ∂Y/∂τ = g X − Y/μ,   g = ϖ/2 ∫₀¹ Y(μ')/μ' dμ',   X = Y = 1 at τ = 0
//! ```
//!
//! (ibid., chapter VIII; tables in H. van de Hulst, Multiple Light Scattering, 1980), and by single scattering alone
//!
//! ```text
//! L = ϖ E/(4π) · μ₀/(μ + μ₀) · (1 − exp(−τ (1/μ + 1/μ₀)))
//! ```

use etalon_math::float64::exp;

/// Chandrasekhar's H for even scattering of albedo ϖ.
#[derive(Clone, Debug)]
pub struct Escape {
    albedo: f64,
    /// Midpoints of [0, 1], and H there.
    nodes: Vec<[f64; 2]>,
}

impl Escape {
    /// Of the albedo ϖ.
    pub fn new(albedo: f64) -> Self {
        const NODES: usize = 400;
        let middle = |i| (i as f64 + 0.5) / NODES as f64;
        let mut escape = Self {
            albedo,
            nodes: (0..NODES).map(|i| [middle(i), 1.0]).collect(),
        };
        // In the form 1/H = √(1 − ϖ) + ϖ/2 ∫ μ' H(μ')/(μ + μ') dμ', which converges for any ϖ up to 1.
        for _ in 0..200 {
            let values: Vec<f64> = escape.nodes.iter().map(|[mu, _]| escape.at(*mu)).collect();
            for (node, value) in escape.nodes.iter_mut().zip(values) {
                node[1] = 0.5 * (node[1] + value);
            }
        }
        escape
    }

    /// H at a cosine.
    pub fn at(&self, mu: f64) -> f64 {
        let part = |[other, value]: &[f64; 2]| other * value / (mu + other);
        let mean = self.nodes.iter().map(part).sum::<f64>() / self.nodes.len() as f64;
        1.0 / ((1.0 - self.albedo).sqrt() + 0.5 * self.albedo * mean)
    }
}

/// Chandrasekhar's X and Y of a layer.
#[derive(Clone, Debug)]
pub struct Layer {
    /// Cosines, and X and Y there.
    nodes: Vec<[f64; 3]>,
}

impl Layer {
    /// Of the albedo ϖ and the optical thickness τ.
    pub fn new(albedo: f64, thickness: f64) -> Self {
        const NODES: usize = 400;
        const STEPS: usize = 1500;
        // μ = s², as Y/μ is large where μ is small.
        let middle = |i: usize| (i as f64 + 0.5) / NODES as f64;
        let mut nodes: Vec<[f64; 3]> = (0..NODES).map(|i| [middle(i).powi(2), 1.0, 1.0]).collect();
        let source = |nodes: &[[f64; 3]]| {
            // dμ/μ = 2 ds/s.
            let sum: f64 = nodes.iter().map(|[mu, _, y]| 2.0 * y / mu.sqrt()).sum();
            0.5 * albedo * sum / NODES as f64
        };
        // A step with Y/μ in closed form.
        let step = |[mu, x, y]: [f64; 3], from: [f64; 3], g: f64, h: f64| {
            let left = exp(-h / mu);
            [
                mu,
                x + h * g * from[2],
                y * left + g * from[1] * mu * (1.0 - left),
            ]
        };
        // Steps that grow: g is large for a thin layer.
        let depth = |i: usize| thickness * (i as f64 / STEPS as f64).powi(4);
        for i in 0..STEPS {
            let h = depth(i + 1) - depth(i);
            let g = source(&nodes);
            let half: Vec<[f64; 3]> = nodes.iter().map(|n| step(*n, *n, g, 0.5 * h)).collect();
            let g = source(&half);
            nodes = nodes
                .iter()
                .zip(&half)
                .map(|(n, m)| step(*n, *m, g, h))
                .collect();
        }
        Self { nodes }
    }

    /// X and Y at a cosine, linear in between.
    pub fn at(&self, mu: f64) -> [f64; 2] {
        let after = self.nodes.partition_point(|node| node[0] < mu);
        let [a, b] =
            [after.saturating_sub(1), after.min(self.nodes.len() - 1)].map(|i| self.nodes[i]);
        let part = if b[0] > a[0] {
            (mu - a[0]) / (b[0] - a[0])
        } else {
            0.0
        };
        [1, 2].map(|i| a[i] + part * (b[i] - a[i]))
    }
}

/// 1 − exp(−τ (1/μ + 1/μ₀)) of a layer of the optical thickness τ, by which light that was scattered once is multiplied.
pub fn once(thickness: f64, mu: f64, into: f64) -> f64 {
    1.0 - exp(-thickness * (1.0 / mu + 1.0 / into))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Chandrasekhar's table XI for ϖ = 1; and the mean of H, 2 (1 − √(1 − ϖ))/ϖ.
    #[test]
    fn h_is_that_of_the_tables() {
        for (albedo, mu, expected) in [(1.0, 1.0, 2.9078), (1.0, 0.5, 2.0128)] {
            let found = Escape::new(albedo).at(mu);
            assert!(
                (found - expected).abs() < 1e-3 * expected,
                "{albedo}, {mu}: {found}"
            );
        }
        let escape = Escape::new(0.8);
        let mean = escape.nodes.iter().map(|[_, h]| h).sum::<f64>() / escape.nodes.len() as f64;
        let expected = 2.0 / 0.8 * (1.0 - 0.2_f64.sqrt());
        assert!((mean - expected).abs() < 1e-4, "{mean} {expected}");
    }

    /// Thick layers are without end, thin ones scatter once, and those that absorb nothing let out all that came in: of the
    /// light along μ₀ the shares (X(μ₀) X(μ) − Y(μ₀) Y(μ))/(μ + μ₀) and (Y(μ₀) X(μ) − X(μ₀) Y(μ))/(μ₀ − μ) of μ/2 dμ, and what
    /// passes straight.
    #[test]
    fn layers_are_between_thin_and_thick_ones() {
        let (escape, thick) = (Escape::new(0.8), Layer::new(0.8, 40.0));
        for mu in [0.3, 0.6, 1.0] {
            let ratio = thick.at(mu)[0] / escape.at(mu);
            assert!((ratio - 1.0).abs() < 1e-3, "{mu}: {ratio}");
        }
        let thin = Layer::new(0.01, 0.05);
        let [a, b] = [0.6, 0.9].map(|mu| thin.at(mu));
        let once = 1.0 - exp(-0.05 * (1.0 / 0.6 + 1.0 / 0.9));
        let share = (a[0] * b[0] - a[1] * b[1]) / once;
        assert!((share - 1.0).abs() < 0.01, "{share}");
        let white = Layer::new(1.0, 1.0);
        let into = 0.6;
        let [x, y] = white.at(into);
        let out = |[mu, other_x, other_y]: &[f64; 3]| {
            let back = (x * other_x - y * other_y) / (mu + into);
            let through = (y * other_x - x * other_y) / (into - mu);
            // dμ = 2 s ds.
            0.5 * mu * (back + through) * 2.0 * mu.sqrt() / white.nodes.len() as f64
        };
        let all = white.nodes.iter().map(out).sum::<f64>() + exp(-1.0 / into);
        assert!((all - 1.0).abs() < 5e-3, "{all}");
    }
}
