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

use etalon_math::float64::{cos, sin};

/// Of the part between these polar angles and azimuths (rad).
pub fn part([nx, ny, nz]: [f64; 3], theta: [f64; 2], phi: [f64; 2]) -> f64 {
    let difference = |f: fn(f64) -> f64, [a, b]: [f64; 2]| f(b) - f(a);
    let upright = 0.5 * difference(|t| t - sin(t) * cos(t), theta);
    let level = nx * difference(sin, phi) - ny * difference(cos, phi);
    let zenith = 0.5 * nz * difference(|t| sin(t) * sin(t), theta);
    upright * level + zenith * difference(|p| p, phi)
}

#[cfg(test)]
mod tests {
    use super::part;
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
}
