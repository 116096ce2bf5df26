//! The irradiance of the plane z = 0 under a light of radiance 1, at the point (x, y).
//!
//! - Sphere of radius r at height h: E = π (r/d)² h/d, with d the distance of its centre, as
//!   long as all of it is above the plane. Of a sphere that the plane cuts only a part is seen
//!   (Snyder, "Area light sources for real-time graphics", 1996): with cos ω = h/d, sin σ = r/d,
//!   x = cot σ, y = −x cot ω, z = sin ω √(1 − y²),
//!   E = (cos ω acos y − x z) sin² σ + atan(z/x).
//! - Parallel disk of radius r at height h, at the distance a from its axis:
//!   E = π · ½ [1 − (a² + h² − r²) / √((a² + h² + r²)² − 4 a² r²)].
//!
//! Configurations B-38 and B-13 of Howell's *Catalog of Radiation Heat Transfer Configuration
//! Factors*.

use etalon_math::float64::{acos, atan};
use std::f64::consts::PI;

/// Under a sphere of radius `r` (m) whose centre is at the height `h` (m); the point in metres.
pub fn sphere(h: f64, r: f64, [x, y]: [f64; 2]) -> f64 {
    let d = (x * x + y * y + h * h).sqrt();
    let (sine, cosine) = (r / d, h / d);
    if h >= r {
        return PI * sine * sine * cosine;
    }
    let across = (1.0 - cosine * cosine).sqrt();
    let cot = (1.0 / (sine * sine) - 1.0).sqrt();
    let y = -cot * cosine / across;
    let z = across * (1.0 - y * y).sqrt();
    (cosine * acos(y) - cot * z) * sine * sine + atan(z / cot)
}

/// Under a parallel disk of radius `r` (m) at the height `h` (m); the point in metres.
pub fn disk(h: f64, r: f64, [x, y]: [f64; 2]) -> f64 {
    let (a2, h2, r2) = (x * x + y * y, h * h, r * r);
    let sum = a2 + h2 + r2;
    0.5 * PI * (1.0 - (sum - 2.0 * r2) / (sum * sum - 4.0 * a2 * r2).sqrt())
}

#[cfg(test)]
mod tests {
    use super::{disk, sphere};
    use crate::truth::by_definition::{POINTS, grid, irradiance};
    use etalon_math::float64::{cos, sin};
    use std::f64::consts::PI;

    const N: usize = 400;

    #[test]
    fn sphere_is_the_integral_over_its_surface() {
        for at in POINTS {
            let lights = grid(N).map(|(u, v)| {
                let z = 2.0 * u - 1.0;
                let (r, phi) = ((1.0 - z * z).sqrt(), 2.0 * PI * v);
                let n = [r * cos(phi), r * sin(phi), z];
                let p = [0.5 * n[0], 0.5 * n[1], 1.5 + 0.5 * n[2]];
                (p, n, PI / (N * N) as f64)
            });
            let expected = irradiance(lights, at);
            assert!((sphere(1.5, 0.5, at) / expected - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn a_sphere_is_cut_by_the_plane() {
        // (height, radius, distance along the plane, E): ∫ cos θ dω over the visible part of the
        // cone, by mpmath's quadrature to 15 digits.
        let numbers = [
            (0.1, 0.3, 1.5, 0.010_382_056_894_715),
            (0.0, 0.3, 0.5, 0.163_501_108_793_284),
            (0.1, 0.3, 4.0, 0.000_548_419_568_318_992),
        ];
        for (height, radius, distance, expected) in numbers {
            let found = sphere(height, radius, [0.6 * distance, -0.8 * distance]);
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
        }
    }

    #[test]
    fn disk_is_the_integral_over_its_surface() {
        for at in POINTS {
            let lights = grid(N).map(|(u, v)| {
                let (r, phi) = (0.75 * u.sqrt(), 2.0 * PI * v);
                let area = PI * 0.75 * 0.75 / (N * N) as f64;
                ([r * cos(phi), r * sin(phi), 1.0], [0.0, 0.0, -1.0], area)
            });
            let expected = irradiance(lights, at);
            assert!((disk(1.0, 0.75, at) / expected - 1.0).abs() < 1e-4);
        }
    }
}
