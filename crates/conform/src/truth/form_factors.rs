//! Form factors between rectangles: which fraction of the light that leaves one arrives at the other.
//!
//! From the rectangle x₁ < x < x₂, y₁ < y < y₂ of the plane z = 0, F = 1/A Σ (−1)^(i+j+k+l)
//! G(xᵢ, yⱼ, η_k, ξ_l) over both ends of each interval (Ehlert and Smith, "View factors for
//! perpendicular and parallel rectangular plates", *Journal of Thermophysics and Heat Transfer* 7,
//! 1993):
//!
//! - to the rectangle ξ₁ < x < ξ₂, η₁ < y < η₂ of the plane z = h, with s = x − ξ, t = y − η,
//!   2π G = t √(s² + h²) atan(t/√(s² + h²)) + s √(t² + h²) atan(s/√(t² + h²)) − ½ h² ln(s² + t² + h²);
//! - to the rectangle ξ₁ < z < ξ₂, η₁ < y < η₂ of the plane x = 0, with r² = x² + ξ², t = y − η,
//!   2π G = t r atan(t/r) + ¼ (t² − r²) ln(r² + t²).

use etalon_math::float64::{atan, ln};
use std::f64::consts::PI;

/// The ends of an interval (m).
pub type Ends = [f64; 2];

/// From x, y in the plane z = 0 to ξ, η in the plane z = `height`; all in metres.
pub fn parallel(x: Ends, y: Ends, xi: Ends, eta: Ends, height: f64) -> f64 {
    let square = height * height;
    sum(x, y, xi, eta, |x, y, xi, eta| {
        let (s, t) = (x - xi, y - eta);
        let (rs, rt) = ((s * s + square).sqrt(), (t * t + square).sqrt());
        t * rs * atan(t / rs) + s * rt * atan(s / rt) - 0.5 * square * ln(s * s + t * t + square)
    })
}

/// From x, y in the plane z = 0 to ξ (the height), η in the plane x = 0; all in metres.
pub fn perpendicular(x: Ends, y: Ends, xi: Ends, eta: Ends) -> f64 {
    sum(x, y, xi, eta, |x, y, xi, eta| {
        let (square, t) = (x * x + xi * xi, y - eta);
        // Both terms vanish with their argument.
        if square + t * t == 0.0 {
            return 0.0;
        }
        let r = square.sqrt();
        let angle = if r > 0.0 { r * atan(t / r) } else { 0.0 };
        t * angle + 0.25 * (t * t - square) * ln(square + t * t)
    })
}

/// Σ (−1)^(i+j+k+l) G(xᵢ, yⱼ, ξ_l, η_k)/(2π A).
fn sum(x: Ends, y: Ends, xi: Ends, eta: Ends, g: impl Fn(f64, f64, f64, f64) -> f64) -> f64 {
    let mut sum = 0.0;
    for i in 0..16 {
        let end = |bit: usize| (i >> bit) & 1;
        let sign = if (i as u32).count_ones().is_multiple_of(2) {
            1.0
        } else {
            -1.0
        };
        sum += sign * g(x[end(0)], y[end(1)], xi[end(2)], eta[end(3)]);
    }
    sum / (2.0 * PI * (x[1] - x[0]) * (y[1] - y[0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parallel_rectangles_are_the_catalogues() {
        // Howell's configuration C-11 by mpmath; the cube's 0.1998 is in every textbook.
        let cases = [
            ([1.0, 1.0], 0.199_824_895_698_387_38),
            ([1.5, 1.0], 0.252_257_540_865_884_5),
        ];
        for ([w, d], expected) in cases {
            let found = parallel([0.0, w], [0.0, d], [0.0, w], [0.0, d], 1.0);
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
    }

    #[test]
    fn perpendicular_rectangles_are_the_catalogues() {
        // Howell's configuration C-14 by mpmath; the cube's is 0.2000.
        let cases = [
            ([1.0, 1.0], 0.200_043_776_075_403_15),
            ([1.5, 1.2], 0.159_053_309_513_797_18),
            ([1.0, 2.0], 0.232_852_602_795_361_89),
        ];
        for ([w, h], expected) in cases {
            let found = perpendicular([0.0, w], [0.0, 1.0], [0.0, h], [0.0, 1.0]);
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
    }

    #[test]
    fn a_closed_room_catches_everything() {
        // From any part of the floor: four walls and the ceiling.
        let (x, y) = ([0.2, 0.3], [0.5, 0.9]);
        let [w, d, h] = [1.5, 1.0, 1.2];
        let mirrored = |[a, b]: Ends, size: f64| [size - b, size - a];
        let total = parallel(x, y, [0.0, w], [0.0, d], h)
            + perpendicular(x, y, [0.0, h], [0.0, d])
            + perpendicular(mirrored(x, w), y, [0.0, h], [0.0, d])
            + perpendicular(y, x, [0.0, h], [0.0, w])
            + perpendicular(mirrored(y, d), x, [0.0, h], [0.0, w]);
        assert!((total - 1.0).abs() < 1e-12, "{total}");
    }
}
