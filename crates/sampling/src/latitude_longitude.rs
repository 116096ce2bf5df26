//! The latitude-longitude map between directions and the unit square, as Mitsuba has it.
//!
//! ```text
//! d = (sin φ sin θ, cos θ, −cos φ sin θ),   u = φ/2π,   v = θ/π
//! dω = 2π² sin θ du dv
//! ```
//!
//! The image's centre (u = ½) is seen along +Z, its upper border is +Y; u grows to the right of a
//! viewer who looks along +Z.

use core::f32::consts::{FRAC_1_PI, PI, TAU};
use etalon_math::lane::{self, Lane, Select, Vector, sin_cos_turns};

/// The places in the unit square of unit directions; u in [0, 1).
#[inline(always)]
pub fn to_square<F: Lane>(direction: F::Vector) -> [F; 2] {
    let [x, y, z] = direction.xyz();
    let turns = lane::atan2(x, -z) / TAU;
    // atan2 of the horizontal and vertical parts keeps its precision at the poles.
    let horizontal = (x * x + z * z).sqrt();
    let theta = lane::atan2(horizontal, y);
    let u = turns - turns.floor();
    [u.lt(F::ONE).select(u, F::ZERO), theta * FRAC_1_PI]
}

/// The unit directions at places of the unit square, and sin θ there.
#[inline(always)]
pub fn to_direction<F: Lane>([u, v]: [F; 2]) -> (F::Vector, F) {
    let (sin_phi, cos_phi) = sin_cos_turns(u);
    let (sin_theta, cos_theta) = sin_cos_turns(v * 0.5);
    let direction = F::Vector::from_xyz(sin_phi * sin_theta, cos_theta, -cos_phi * sin_theta);
    (direction, sin_theta)
}

/// 2π² sin θ: solid angle per unit area of the square.
#[inline(always)]
pub fn stretch<F: Lane>(sin_theta: F) -> F {
    sin_theta * (2.0 * PI * PI)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec2, Vec3};
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    proptest! {
        #![proptest_config(ProptestConfig {
            failure_persistence: None,
            rng_seed: RngSeed::Fixed(1),
            ..ProptestConfig::with_cases(500)
        })]

        #[test]
        fn square_and_sphere_correspond(u in 0.0f32..1.0, v in 0.02f32..0.98) {
            let (direction, sin_theta) = to_direction::<f32>([u, v]);
            prop_assert!((direction.length() - 1.0).abs() < 1e-6);
            let back = Vec2::from(to_square::<f32>(direction));
            prop_assert!((0.0..1.0).contains(&back.x));
            let turn = (back.x - u).abs();
            // u is periodic; an angle's error grows as 1/sin θ toward the poles.
            prop_assert!(turn.min(1.0 - turn) < 1e-6 / sin_theta && (back.y - v).abs() < 1e-6);
        }

        /// The stretch is the Jacobian, by central differences. Rejects a missing sin θ.
        #[test]
        fn stretch_is_the_jacobian(u in 0.1f32..0.9, v in 0.05f32..0.95) {
            const STEP: f32 = 1.0 / 512.0;
            let at = |du: f32, dv: f32| to_direction::<f32>([u + du, v + dv]).0;
            let du = (at(STEP, 0.0) - at(-STEP, 0.0)) / (2.0 * STEP);
            let dv = (at(0.0, STEP) - at(0.0, -STEP)) / (2.0 * STEP);
            let jacobian = du.cross(dv).length();
            let (_, sin_theta) = to_direction::<f32>([u, v]);
            // Central differences err by (2π·STEP)²/6 < 3·10⁻⁵ in either direction.
            prop_assert!((jacobian / stretch(sin_theta) - 1.0).abs() < 2e-4);
        }
    }

    #[test]
    fn poles_and_axes() {
        let at = |direction| Vec2::from(to_square::<f32>(direction));
        assert_eq!(at(Vec3::Y).y, 0.0);
        assert!((at(Vec3::NEG_Y).y - 1.0).abs() < 1e-6);
        assert!((at(Vec3::Z) - Vec2::splat(0.5)).abs().max_element() < 1e-6);
        assert!((at(Vec3::X).x - 0.25).abs() < 1e-6);
    }
}
