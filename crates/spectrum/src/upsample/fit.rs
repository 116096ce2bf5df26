//! Fitting the three coefficients of a colour, offline.
//!
//! Given a linear Rec. 709 colour, find c with the least ‖Lab(c) − Lab(colour)‖², where Lab(c) is the
//! CIE 1976 L*a*b* value of the reflectance S(c₀ t² + c₁ t + c₂) lit by D65 (Jakob and Hanika 2019,
//! section 4, equations 6–8). Every colour of Rec. 709 but a few at the very edge has a reflectance
//! that meets it exactly, so the metric only decides what happens at that edge. The minimiser is
//! Gauss–Newton with Levenberg's damping, in double precision.

use crate::colour_space::{RGB_TO_XYZ, WHITE, XYZ_TO_RGB, apply};
use crate::{cie, illuminants};
use etalon_math::float64;

/// Coefficients found for a colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// c₀, c₁, c₂ for the wavelength variable t in [−1, 1].
    pub coefficients: [f64; 3],
    /// ‖Lab(c) − Lab(colour)‖, the CIE 1976 colour difference that is left.
    pub difference: f64,
}

/// Tolerance of the fits: 10⁻⁹ of a just noticeable difference.
const CONVERGED: f64 = 1e-9;
/// Most steps of the minimiser.
const MAX_STEPS: usize = 200;
/// Greatest magnitude of a coefficient: beyond it the spectrum is a step, or below 10⁻¹⁰, and
/// the coefficients only drift.
const MAX_COEFFICIENT: f64 = 1e5;

/// The quadrature of reflectance times D65 times the colour-matching functions.
#[derive(Clone, Debug)]
pub struct Fitter {
    /// For each node: t, and the weights of X/Xₙ, Y/Yₙ, Z/Zₙ.
    nodes: Vec<[f64; 4]>,
}

impl Default for Fitter {
    fn default() -> Self {
        Self::new()
    }
}

impl Fitter {
    /// Nodes at every nanometre of 360–830 nm, trapezoidal, normalised to give white exactly.
    pub fn new() -> Self {
        let mut nodes: Vec<[f64; 4]> = (0..cie::COUNT)
            .map(|i| {
                let lambda = (cie::FIRST + i) as f64;
                let ends = if i == 0 || i == cie::COUNT - 1 {
                    0.5
                } else {
                    1.0
                };
                let power = ends * illuminants::d65(lambda);
                let [x, y, z] = cie::row(i);
                [super::variable(lambda), power * x, power * y, power * z]
            })
            .collect();
        let total: [f64; 3] = std::array::from_fn(|c| nodes.iter().map(|n| n[c + 1]).sum());
        for node in &mut nodes {
            for c in 0..3 {
                node[c + 1] /= total[c];
            }
        }
        Self { nodes }
    }

    /// Linear Rec. 709 of the reflectance with these coefficients, lit by D65.
    pub fn rgb(&self, coefficients: [f64; 3]) -> [f64; 3] {
        let (relative, _) = self.relative_xyz(coefficients);
        apply(&XYZ_TO_RGB, std::array::from_fn(|c| relative[c] * WHITE[c]))
    }

    /// The best coefficients for the colour `rgb`, found from `start`.
    pub fn fit(&self, rgb: [f64; 3], start: [f64; 3]) -> Fit {
        let xyz = apply(&RGB_TO_XYZ, rgb);
        let (target, _) = lab(std::array::from_fn(|c| xyz[c] / WHITE[c]));
        let mut c = start;
        let (mut residual, mut jacobian) = self.residual(c, target);
        let mut error = norm(residual);
        let mut damping = 1e-6;
        for _ in 0..MAX_STEPS {
            if error < CONVERGED || damping > 1e12 {
                break;
            }
            let step = damped_step(&jacobian, residual, damping);
            let mut next: [f64; 3] = std::array::from_fn(|i| c[i] - step[i]);
            let largest = next.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
            if largest > MAX_COEFFICIENT {
                next = next.map(|v| v * (MAX_COEFFICIENT / largest));
            }
            let (next_residual, next_jacobian) = self.residual(next, target);
            let next_error = norm(next_residual);
            if next_error < error {
                (c, residual, jacobian, error) = (next, next_residual, next_jacobian, next_error);
                damping = (damping * 0.1).max(1e-15);
            } else {
                damping *= 8.0;
            }
        }
        Fit {
            coefficients: c,
            difference: error,
        }
    }

    /// Lab(c) − `target` and its derivatives by c.
    fn residual(&self, c: [f64; 3], target: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
        let (relative, by_c) = self.relative_xyz(c);
        let (value, by_relative) = lab(relative);
        let residual = std::array::from_fn(|i| value[i] - target[i]);
        let jacobian = std::array::from_fn(|i| {
            std::array::from_fn(|j| (0..3).map(|k| by_relative[i][k] * by_c[k][j]).sum())
        });
        (residual, jacobian)
    }

    /// (X/Xₙ, Y/Yₙ, Z/Zₙ) of the reflectance with coefficients `c`, and its derivatives by c.
    fn relative_xyz(&self, c: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
        let mut value = [0.0; 3];
        let mut by_c = [[0.0; 3]; 3];
        for &[t, wx, wy, wz] in &self.nodes {
            let x = (c[0] * t + c[1]) * t + c[2];
            let inverse_root = 1.0 / (1.0 + x * x).sqrt();
            let s = 0.5 + 0.5 * x * inverse_root;
            let slope = 0.5 * inverse_root * inverse_root * inverse_root;
            for (k, w) in [wx, wy, wz].into_iter().enumerate() {
                value[k] += w * s;
                let ws = w * slope;
                by_c[k][0] += ws * t * t;
                by_c[k][1] += ws * t;
                by_c[k][2] += ws;
            }
        }
        (value, by_c)
    }
}

/// CIE 1976 L*a*b* of tristimulus values relative to the white, and its derivatives by them.
fn lab(relative: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
    const DELTA: f64 = 6.0 / 29.0;
    let f = relative.map(|t| {
        if t > DELTA * DELTA * DELTA {
            float64::cbrt(t)
        } else {
            t / (3.0 * DELTA * DELTA) + 4.0 / 29.0
        }
    });
    let slope: [f64; 3] = std::array::from_fn(|i| {
        if relative[i] > DELTA * DELTA * DELTA {
            1.0 / (3.0 * f[i] * f[i])
        } else {
            1.0 / (3.0 * DELTA * DELTA)
        }
    });
    let value = [
        116.0 * f[1] - 16.0,
        500.0 * (f[0] - f[1]),
        200.0 * (f[1] - f[2]),
    ];
    let derivative = [
        [0.0, 116.0 * slope[1], 0.0],
        [500.0 * slope[0], -500.0 * slope[1], 0.0],
        [0.0, 200.0 * slope[1], -200.0 * slope[2]],
    ];
    (value, derivative)
}

/// The δ that solves (JᵀJ + μ diag(JᵀJ)) δ = Jᵀr.
fn damped_step(j: &[[f64; 3]; 3], r: [f64; 3], damping: f64) -> [f64; 3] {
    let mut a: [[f64; 3]; 3] =
        std::array::from_fn(|p| std::array::from_fn(|q| (0..3).map(|i| j[i][p] * j[i][q]).sum()));
    let b: [f64; 3] = std::array::from_fn(|p| (0..3).map(|i| j[i][p] * r[i]).sum());
    for (p, row) in a.iter_mut().enumerate() {
        row[p] += damping * row[p] + 1e-300;
    }
    cholesky_solve(&a, b)
}

/// Solves a x = b for a symmetric positive definite 3 × 3 matrix.
fn cholesky_solve(a: &[[f64; 3]; 3], b: [f64; 3]) -> [f64; 3] {
    let mut l = [[0.0; 3]; 3];
    for i in 0..3 {
        for k in 0..=i {
            let sum: f64 = (0..k).map(|m| l[i][m] * l[k][m]).sum();
            l[i][k] = if i == k {
                (a[i][i] - sum).max(1e-300).sqrt()
            } else {
                (a[i][k] - sum) / l[k][k]
            };
        }
    }
    let mut y = [0.0; 3];
    for i in 0..3 {
        let sum: f64 = (0..i).map(|m| l[i][m] * y[m]).sum();
        y[i] = (b[i] - sum) / l[i][i];
    }
    let mut x = [0.0; 3];
    for i in (0..3).rev() {
        let sum: f64 = (i + 1..3).map(|m| l[m][i] * x[m]).sum();
        x[i] = (y[i] - sum) / l[i][i];
    }
    x
}

/// Euclidean length.
fn norm(v: [f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}
