//! The integrating sphere: a closed sphere of radius R that reflects the fraction ρ diffusely.
//!
//! Light leaving a point of a sphere diffusely spreads evenly over all of it, so only the direct
//! light knows where the lamp is. With a point light of intensity I at any place inside
//!
//! L(x) = ρ/π · [ I cos θ/d² + ρ/(1 − ρ) · I/R² ],
//!
//! and with a black ball of radius r and radiance L₀ in the middle, which sends π L₀ (r/R)² to all of the wall and takes the
//! share (r/R)² of what the wall sends,
//!
//! L = ρ L₀ (r/R)² / (1 − ρ (1 − (r/R)²))
//!
//! (Jacquez and Kuppenheim, "Theory of the integrating sphere", *JOSA* 45, 1955.)

use std::f64::consts::PI;

/// Where a ray from a point inside along a direction meets the wall; the sphere, of this radius (m), is about the origin.
pub fn wall(from: [f64; 3], direction: [f64; 3], radius: f64) -> [f64; 3] {
    let a = dot(direction, direction);
    let b = dot(from, direction);
    let c = dot(from, from) - radius * radius;
    let t = (-b + (b * b - a * c).sqrt()) / a;
    std::array::from_fn(|i| from[i] + t * direction[i])
}

/// cos θ/d² (1/m²) of a lamp at a point of the wall.
pub fn per_square(point: [f64; 3], lamp: [f64; 3], radius: f64) -> f64 {
    let to: [f64; 3] = std::array::from_fn(|i| lamp[i] - point[i]);
    let square = dot(to, to);
    // The inward normal is −point/R.
    -dot(to, point) / (radius * square * square.sqrt())
}

/// The radiance that is reflected more than once, of a point light of this intensity.
pub fn indirect(reflectance: f64, intensity: f64, radius: f64) -> f64 {
    reflectance * reflectance / (PI * (1.0 - reflectance)) * intensity / (radius * radius)
}

/// The wall's radiance about a ball of radiance 1 whose radius is the share `ratio` of the sphere's.
pub fn about_ball(reflectance: f64, ratio: f64) -> f64 {
    let square = ratio * ratio;
    reflectance * square / (1.0 - reflectance * (1.0 - square))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_math::float64::{cos, sin};

    #[test]
    fn the_wall_receives_what_the_lamp_gives() {
        // The mean of cos θ/d² over the wall is 4π/(4π R²), wherever the lamp is.
        let (n, radius) = (300, 1.3);
        let mut sum = 0.0;
        for i in 0..n * n {
            let z = 2.0 * (f64::from(i % n) + 0.5) / f64::from(n) - 1.0;
            let phi = 2.0 * PI * (f64::from(i / n) + 0.5) / f64::from(n);
            let r = (1.0 - z * z).sqrt();
            let point = [r * cos(phi), r * sin(phi), z].map(|c| radius * c);
            sum += per_square(point, [0.3, 0.35, 0.1], radius);
        }
        let mean = sum / f64::from(n * n);
        assert!((mean * radius * radius - 1.0).abs() < 1e-4, "{mean}");
    }

    #[test]
    fn a_ray_from_inside_ends_at_the_wall() {
        let from = [0.0, 0.0, -0.6];
        let point = wall(from, [0.4, -0.2, 1.0], 1.0);
        assert!((dot(point, point) - 1.0).abs() < 1e-12);
        assert!(point[2] > from[2]);
    }

    #[test]
    fn a_balls_light_is_reflected_over_and_over() {
        // By powers: the ball gives π (4π r²), of which the wall keeps 1 − ρ at each of its turns and the ball, black, all
        // that comes back to it.
        let (rho, ratio) = (0.9, 0.2);
        let (mut arriving, mut wall) = (ratio * ratio, 0.0);
        for _ in 0..500 {
            wall += rho * arriving;
            arriving = rho * arriving * (1.0 - ratio * ratio);
        }
        assert!((about_ball(rho, ratio) - wall).abs() < 1e-14);
    }
}
