//! The irradiance of the plane z = 0 under lights without extent, at the point (x, y).
//!
//! - Point light of intensity I at the height h, at the distance d: E = I h/d³, the law of inverse
//!   squares with Lambert's cosine h/d (*Photometria*, 1760).
//! - Spot light: the same with I f(θ), θ the angle from its axis: f = 1 up to the beam width b, 0 beyond the cutoff c, and between
//!   them, by the program, (c − θ)/(c − b) (Mitsuba 3's documentation of `spot`), t² (3 − 2t) (pbrt-v4) or t⁴ (Pharr, Jakob and
//!   Humphreys, *Physically Based Rendering*, 2016, section 12.3.2), t = (cos θ − cos c)/(cos b − cos c).
//! - Directional light of irradiance E⊥ that goes along ω: E = E⊥ |ω_z|/|ω|.

use crate::scene::Falloff;
use etalon_math::float64::{acos, cos};

/// E/I of a light `at` a place (m), in 1/m².
pub fn inverse_square(at: [f64; 3], [x, y]: [f64; 2]) -> f64 {
    let to = [at[0] - x, at[1] - y, at[2]];
    let square = dot(to, to);
    to[2] / (square * square.sqrt())
}

/// f(θ) of a spot light `at` a place that aims at `target` in the plane. Angles in degrees.
pub fn fall_off(
    falloff: Falloff,
    at: [f64; 3],
    target: [f64; 2],
    [beam, cutoff]: [f64; 2],
    [x, y]: [f64; 2],
) -> f64 {
    let axis = [target[0] - at[0], target[1] - at[1], -at[2]];
    let ray = [x - at[0], y - at[1], -at[2]];
    let cosine = dot(axis, ray) / (dot(axis, axis) * dot(ray, ray)).sqrt();
    let [bright, dark] = [beam, cutoff].map(|angle| cos(angle.to_radians()));
    let t = ((cosine - dark) / (bright - dark)).clamp(0.0, 1.0);
    match falloff {
        Falloff::LinearInAngle => {
            let angle = acos(cosine.min(1.0)).to_degrees();
            ((cutoff - angle) / (cutoff - beam)).clamp(0.0, 1.0)
        }
        Falloff::SmoothInCosine => t * t * (3.0 - 2.0 * t),
        Falloff::QuarticInCosine => t.powi(4),
    }
}

/// E/E⊥ of parallel light that goes along `to`.
pub fn parallel(to: [f64; 3]) -> f64 {
    -to[2] / dot(to, to).sqrt()
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::{fall_off, inverse_square, parallel};
    use crate::scene::Falloff;
    use etalon_math::float64::{cos, sin, tan};
    use std::f64::consts::PI;

    #[test]
    fn irradiance_is_the_textbooks() {
        // 100 cd at 2 m: 25 lx below the lamp, and 25 cos³ 60° = 3.125 lx at 60° from it.
        let at = [1.0, -1.0, 2.0];
        assert!((100.0 * inverse_square(at, [1.0, -1.0]) - 25.0).abs() < 1e-12);
        let aside = 1.0 + 2.0 * tan(PI / 3.0);
        assert!((100.0 * inverse_square(at, [aside, -1.0]) - 3.125).abs() < 1e-12);
    }

    #[test]
    fn the_plane_receives_what_the_spot_light_gives() {
        // Φ = I ∫ f dω = 2π I [1 − (sin c − sin b)/(c − b)] by the angle.
        let (beam, cutoff) = (15f64, 40f64);
        let (b, c) = (beam.to_radians(), cutoff.to_radians());
        // In the cosine, f has the means ½ and 1/5 between the angles.
        let by_cosine = |mean: f64| 2.0 * PI * (1.0 - cos(b) + mean * (cos(b) - cos(c)));
        let rules = [
            (
                Falloff::LinearInAngle,
                2.0 * PI * (1.0 - (sin(c) - sin(b)) / (c - b)),
            ),
            (Falloff::SmoothInCosine, by_cosine(0.5)),
            (Falloff::QuarticInCosine, by_cosine(0.2)),
        ];
        let at = [0.3, 0.1, 1.2];
        let (n, half) = (1200, 1.1);
        let step = 2.0 * half / f64::from(n);
        for (falloff, expected) in rules {
            let mut sum = 0.0;
            for i in 0..n * n {
                let x = 0.3 - half + step * (f64::from(i % n) + 0.5);
                let y = 0.1 - half + step * (f64::from(i / n) + 0.5);
                let f = fall_off(falloff, at, [0.3, 0.1], [beam, cutoff], [x, y]);
                sum += f * inverse_square(at, [x, y]) * step * step;
            }
            assert!((sum / expected - 1.0).abs() < 1e-4, "{sum} {expected}");
        }
    }

    #[test]
    fn a_spot_light_is_dark_beyond_its_cutoff() {
        let at = [-1.0, 0.0, 1.0];
        // The axis leans by 45°; the point below the lamp is 45° off, the point (−1 + tan 65°, 0) 20°.
        let f = |x: f64| {
            fall_off(
                Falloff::LinearInAngle,
                at,
                [0.0, 0.0],
                [10.0, 40.0],
                [x, 0.0],
            )
        };
        assert_eq!(f(-1.0), 0.0);
        assert_eq!(f(0.0), 1.0);
        let aside = tan(65f64.to_radians()) - 1.0;
        assert!((f(aside) - 2.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn slanted_light_is_spread() {
        // 3-4-5: a beam of area 4 falls on an area of 5.
        assert!((parallel([3.0, 0.0, -4.0]) - 0.8).abs() < 1e-15);
    }
}
