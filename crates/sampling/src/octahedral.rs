//! The octahedral equal-area map between directions and the unit square: Clarberg (2008), "Fast Equal-Area Mapping of the
//! (Hemi)Sphere using SIMD", Journal of Graphics Tools 13(3), equations 2 to 6.
//!
//! With (a, b) = 2 (u, v) − 1, the distance s = 1 − |a| − |b| from the inner square (|a| + |b| = 1), and r = 1 − |s|,
//!
//! ```text
//! z = ±(1 − r²), of the sign of s,     φ = π/4 · ((|b| − |a|)/r + 1),     (x, y) = r √(2 − r²) (±cos φ, ±sin φ)
//! ```
//!
//! with the signs of a and b. The square's centre is +z, its corners are −z; dω = 4π du dv everywhere.

use core::f32::consts::FRAC_2_PI;
use etalon_math::float;
use glam::{Vec2, Vec3};

/// The unit direction at a place of the unit square.
#[inline]
pub fn to_direction(place: Vec2) -> Vec3 {
    let signed = place * 2.0 - 1.0;
    let Vec2 { x: a, y: b } = signed.abs();
    let inward = 1.0 - (a + b);
    let r = 1.0 - inward.abs();
    // An eighth of a turn at most either way from the diagonal.
    let eighths = if r > 0.0 { (b - a) / r } else { 0.0 };
    let (sin, cos) = float::sin_cos_turns((eighths + 1.0) / 8.0);
    let across = r * (2.0 - r * r).sqrt();
    Vec3::new(
        (cos * across).copysign(signed.x),
        (sin * across).copysign(signed.y),
        (1.0 - r * r).copysign(inward),
    )
}

/// The place of a unit direction in the unit square.
#[inline]
pub fn to_square(direction: Vec3) -> Vec2 {
    let Vec3 { x, y, z } = direction.abs();
    // 1 − |z| cancels near the poles; (x² + y²)/(1 + |z|) is the same.
    let r = ((x * x + y * y) / (1.0 + z)).sqrt();
    let b = r * float::atan2(y, x) * FRAC_2_PI;
    let inner = Vec2::new(r - b, b);
    let folded = match direction.z < 0.0 {
        true => Vec2::new(1.0 - inner.y, 1.0 - inner.x),
        false => inner,
    };
    let signed = Vec2::new(
        folded.x.copysign(direction.x),
        folded.y.copysign(direction.y),
    );
    (signed + 1.0) * 0.5
}

/// The place in the unit square that shows the same direction as a place up to 1 outside of it: the map goes on over an edge turned by
/// half a turn about the edge's middle.
#[inline]
pub fn wrapped(place: Vec2) -> Vec2 {
    let over = |at: Vec2| match at.x {
        x if x < 0.0 => Vec2::new(-x, 1.0 - at.y),
        x if x > 1.0 => Vec2::new(2.0 - x, 1.0 - at.y),
        _ => at,
    };
    let across = |at: Vec2| Vec2::new(at.y, at.x);
    across(over(across(over(place))))
}

/// The places up to 1 outside of the unit square that show the same direction as a place in it, with that place first.
#[inline]
pub fn copies(place: Vec2) -> [Vec2; 9] {
    let Vec2 { x, y } = place;
    let at = Vec2::new;
    [
        place,
        at(-x, 1.0 - y),
        at(2.0 - x, 1.0 - y),
        at(1.0 - x, -y),
        at(1.0 - x, 2.0 - y),
        at(x - 1.0, y - 1.0),
        at(x + 1.0, y - 1.0),
        at(x - 1.0, y + 1.0),
        at(x + 1.0, y + 1.0),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    proptest! {
        #![proptest_config(ProptestConfig {
            failure_persistence: None,
            rng_seed: RngSeed::Fixed(1),
            ..ProptestConfig::with_cases(1000)
        })]

        #[test]
        fn square_and_sphere_correspond(u in 0.0f32..1.0, v in 0.0f32..1.0) {
            let place = Vec2::new(u, v);
            let direction = to_direction(place);
            prop_assert!((direction.length() - 1.0).abs() < 1e-6);
            prop_assert!((to_square(direction) - place).abs().max_element() < 1e-6);
            for copy in copies(place) {
                prop_assert!((to_direction(wrapped(copy)) - direction).length() < 2e-6, "{copy}");
            }
        }

        /// A small square around any place covers 4π times its area, by central differences; they err by the square of the
        /// step, and a crease of the map must not lie between. Rejects any other map of the octahedron.
        #[test]
        fn areas_are_equal(u in 0.01f32..0.99, v in 0.01f32..0.99) {
            const STEP: f32 = 1.0 / 512.0;
            let place = Vec2::new(u, v);
            let [a, b] = (place * 2.0 - 1.0).abs().to_array();
            prop_assume!((1.0 - a - b).abs() > 0.02 && a > 0.01 && b > 0.01);
            let slope = |step| (to_direction(place + step) - to_direction(place - step)) / (2.0 * STEP);
            let covered = slope(Vec2::X * STEP).cross(slope(Vec2::Y * STEP)).length();
            let near_pole = STEP / (1.0 - (1.0 - a - b).abs());
            prop_assert!((covered / (4.0 * core::f32::consts::PI) - 1.0).abs() < 5e-4 + near_pole * near_pole);
        }
    }

    #[test]
    fn poles_axes_and_corners() {
        let at = |x, y| to_direction(Vec2::new(x, y));
        let near = |a: Vec3, b: Vec3| a.distance(b) < 1e-6;
        assert!(near(at(0.5, 0.5), Vec3::Z));
        assert!(near(at(1.0, 0.5), Vec3::X) && near(at(0.5, 1.0), Vec3::Y));
        assert!(near(at(0.0, 0.0), Vec3::NEG_Z) && near(at(1.0, 0.0), Vec3::NEG_Z));
    }
}
