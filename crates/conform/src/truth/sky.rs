//! The irradiance of a plane under a part of the sky of radiance 1.
//!
//! Of the polar angles θ₁ to θ₂ and azimuths φ₁ to φ₂, all above the plane whose normal is n, ∫∫ n·ω sin θ dθ dφ with
//! ω = (sin θ cos φ, sin θ sin φ, cos θ) is
//!
//! ```text
//! E = ½ [θ − sin θ cos θ] (n_x [sin φ] − n_y [cos φ]) + ½ n_z [sin² θ] [φ],   [f] = f₂ − f₁
//! ```
//!
//! (Lambert's cosine law, *Photometria*, 1760, integrated).

//! Of a radiance that stands at one direction (θ, φ) and falls linearly to 0 at θ ± h and φ ± k, as interpolation between cells has it,
//! it is the same with another bracket: of a hat of half width h at a, where G is the antiderivative of f,
//!
//! ```text
//! [f] = (G(a − h) − 2 G(a) + G(a + h))/h
//! ```

use etalon_math::float64::{cos, sin};

/// Of the part between these polar angles and azimuths (rad).
pub fn part([nx, ny, nz]: [f64; 3], theta: [f64; 2], phi: [f64; 2]) -> f64 {
    let difference = |f: fn(f64) -> f64, [a, b]: [f64; 2]| f(b) - f(a);
    let upright = 0.5 * difference(|t| t - sin(t) * cos(t), theta);
    let level = nx * difference(sin, phi) - ny * difference(cos, phi);
    let zenith = 0.5 * nz * difference(|t| sin(t) * sin(t), theta);
    upright * level + zenith * difference(|p| p, phi)
}

/// Of a hat of radiance 1 at this direction with these half widths (rad).
pub fn hat([nx, ny, nz]: [f64; 3], [theta, phi]: [f64; 2], [h, k]: [f64; 2]) -> f64 {
    // Each function is G.
    let over = |f: fn(f64) -> f64, a: f64, h: f64| (f(a - h) - 2.0 * f(a) + f(a + h)) / h;
    let upright = over(|t| 0.25 * t * t + 0.125 * cos(2.0 * t), theta, h);
    let level = nx * over(|p| -cos(p), phi, k) + ny * over(|p| -sin(p), phi, k);
    let zenith = nz * over(|t| -0.125 * sin(2.0 * t), theta, h);
    upright * level + zenith * over(|p| 0.5 * p * p, phi, k)
}

#[cfg(test)]
mod tests {
    use super::{hat, part};
    use etalon_math::float64::{cos, sin};
    use std::f64::consts::{FRAC_PI_2, PI, TAU};

    #[test]
    fn the_whole_sky_is_pi() {
        assert!((part([0.0, 0.0, 1.0], [0.0, FRAC_PI_2], [0.0, TAU]) - PI).abs() < 1e-14);
    }

    #[test]
    fn a_part_is_the_sum_of_its_directions() {
        let (n, normal) = (400, [0.6, 0.0, 0.8]);
        let (theta, phi) = ([0.3, 0.9], [-0.4, 1.1]);
        let at = |[a, b]: [f64; 2], i: i32| a + (b - a) * (f64::from(i) + 0.5) / f64::from(n);
        let sum: f64 = (0..n * n)
            .map(|i| {
                let (t, p) = (at(theta, i % n), at(phi, i / n));
                let omega = [sin(t) * cos(p), sin(t) * sin(p), cos(t)];
                let cosine: f64 = (0..3).map(|c| normal[c] * omega[c]).sum();
                cosine * sin(t)
            })
            .sum();
        let expected = sum * 0.6 * 1.5 / f64::from(n * n);
        assert!((part(normal, theta, phi) / expected - 1.0).abs() < 1e-5);
    }

    /// A narrow hat is its direction; a wide one is the sum of its directions.
    #[test]
    fn a_hat_is_the_sum_of_its_directions() {
        let normal: [f64; 3] = [0.48, -0.36, 0.8];
        let ([theta, phi], [h, k]) = ([0.6, 0.3], [0.2, 0.4]);
        let cosine = |t: f64, p: f64| {
            let omega = [sin(t) * cos(p), sin(t) * sin(p), cos(t)];
            sin(t) * (0..3).map(|c| normal[c] * omega[c]).sum::<f64>()
        };
        let narrow = hat(normal, [theta, phi], [1e-3, 1e-3]) / 1e-6;
        assert!((narrow / cosine(theta, phi) - 1.0).abs() < 1e-5, "{narrow}");
        let n = 400;
        let at = |i: i32| 2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0;
        let weight = |x: f64| 1.0 - x.abs();
        let sum: f64 = (0..n * n)
            .map(|i| {
                let (x, y) = (at(i % n), at(i / n));
                weight(x) * weight(y) * cosine(theta + h * x, phi + k * y)
            })
            .sum();
        let expected = sum * 4.0 * h * k / f64::from(n * n);
        assert!((hat(normal, [theta, phi], [h, k]) / expected - 1.0).abs() < 1e-4);
    }
}
