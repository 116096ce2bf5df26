//! Smooth interfaces, and piles of them.
//!
//! One between air and glass of index n reflects R = ½ (R_s + R_p) of natural light by Fresnel's equations (1823); one
//! between air and a metal of index n + ik, with a² and b² as below,
//!
//! ```text
//! 2a² = √((n² − k² − s²)² + 4n²k²) + n² − k² − s²,   a² + b² = √((n² − k² − s²)² + 4n²k²),   s = sin θ, c = cos θ
//! R_s = (a² + b² − 2ac + c²)/(a² + b² + 2ac + c²)
//! R_p = R_s (c² (a² + b²) − 2acs² + s⁴)/(c² (a² + b²) + 2acs² + s⁴)
//! ```
//!
//! (Born and Wolf, *Principles of Optics*, 1959, section 13.2). Through m interfaces that absorb nothing passes, with all
//! reflections between all of them summed,
//!
//! T = (1 − R)/(1 + (m − 1) R)
//!
//! (Stokes, "On the intensity of the light reflected from or transmitted through a pile of plates",
//! *Proceedings of the Royal Society* 11, 1862). A plate is two interfaces. Stokes has this for either polarisation; a
//! renderer that forgets it between interfaces has it for R = ½ (R_s + R_p).

/// R of an interface to the relative index `index` for natural light.
pub fn reflectance(cosine: f64, index: f64) -> f64 {
    // The index times the cosine behind the interface, by Snell's law.
    let behind = (index * index - 1.0 + cosine * cosine).sqrt();
    let s = (cosine - behind) / (cosine + behind);
    let p = (index * index * cosine - behind) / (index * index * cosine + behind);
    0.5 * (s * s + p * p)
}

/// R of a metal of index n + ik for natural light.
pub fn conductor(cosine: f64, n: f64, k: f64) -> f64 {
    let (c2, s2) = (cosine * cosine, 1.0 - cosine * cosine);
    let real = n * n - k * k - s2;
    let sum = (real * real + 4.0 * n * n * k * k).sqrt();
    let twice = 2.0 * (0.5 * (sum + real)).sqrt() * cosine;
    let s = (sum + c2 - twice) / (sum + c2 + twice);
    let (even, odd) = (c2 * sum + s2 * s2, twice * s2);
    0.5 * s * (1.0 + (even - odd) / (even + odd))
}

/// T of `interfaces` interfaces that reflect the fraction `r` each.
pub fn transmittance(r: f64, interfaces: u32) -> f64 {
    (1.0 - r) / (1.0 + f64::from(interfaces - 1) * r)
}

#[cfg(test)]
mod tests {
    use super::{conductor, reflectance, transmittance};
    use etalon_math::float64::cos;

    #[test]
    fn one_interface_is_fresnels() {
        // n = 1.5 at 0°, 30°, 45° and 60°, by mpmath.
        let numbers = [
            (0.0, 0.04),
            (30.0, 0.041_522_625_975_821_5),
            (45.0, 0.050_239_911_012_235_9),
            (60.0, 0.089_186_712_802_212_7),
        ];
        for (degrees, expected) in numbers {
            let found = reflectance(cos(f64::to_radians(degrees)), 1.5);
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
    }

    #[test]
    fn plates_are_added_one_by_one() {
        // Light that goes to and fro between what is there and one more interface:
        // T' = T t/(1 − R r), a geometric series.
        for r in [0.04, 0.3, 0.9] {
            let mut through = 1.0 - r;
            for interfaces in 2..12 {
                let back = 1.0 - through;
                through = through * (1.0 - r) / (1.0 - back * r);
                assert!((transmittance(r, interfaces) - through).abs() < 1e-14);
            }
        }
        // Window glass passes 92.3 %, three panes of it 80 %.
        assert!((transmittance(0.04, 2) - 12.0 / 13.0).abs() < 1e-15);
        assert!((transmittance(0.04, 6) - 0.8).abs() < 1e-15);
    }

    #[test]
    fn metals_are_complex_glasses() {
        // r_s = (c − m c')/(c + m c') and r_p = (m c − c')/(m c + c') in complex numbers, m = n + ik, with
        // m c' = √(m² − s²) = g + ih.
        for (degrees, n, k) in [(45f64, 0.2, 3.0), (75.0, 0.2, 3.0), (60.0, 1.5, 0.0)] {
            let c = cos(degrees.to_radians());
            let (re, im) = (n * n - k * k - 1.0 + c * c, 2.0 * n * k);
            let size = (re * re + im * im).sqrt();
            let g = (0.5 * (size + re)).sqrt();
            let h = (0.5 * (size - re)).max(0.0).sqrt();
            let norm = |a: f64, b: f64| a * a + b * b;
            let s = norm(c - g, h) / norm(c + g, h);
            // Both ends of r_p times m.
            let (a, b) = ((n * n - k * k) * c, 2.0 * n * k * c);
            let p = norm(a - g, b - h) / norm(a + g, b + h);
            let found = conductor(c, n, k);
            assert!((found - 0.5 * (s + p)).abs() < 1e-14, "{found}");
        }
        assert!((conductor(0.5, 1.5, 0.0) - reflectance(0.5, 1.5)).abs() < 1e-15);
        // At right angles ((n − 1)² + k²)/((n + 1)² + k²).
        assert!((conductor(1.0, 0.2, 3.0) - 9.64 / 10.44).abs() < 1e-15);
    }
}
