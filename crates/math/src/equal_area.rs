//! The equal-area map between directions and the unit square, as pbrt-v4 has it (Clarberg 2008, "Fast Equal-Area Mapping of the
//! (Hemi)Sphere Using SIMD").
//!
//! The octahedron |x| + |y| + |z| = 1 is unfolded onto the square [−1, 1]²: the upper half (z ≥ 0) is the inner diamond, the lower half are the four corners.
//! With (u, v) in [−1, 1]², s = 1 − |u| − |v| and r = 1 − |s|,
//!
//! ```text
//! |z| = 1 − r²,   the angle of (x, y) in its quadrant = π/4 · ((|v| − |u|)/r + 1)
//! dω = π du dv
//! ```

use crate::lane::{self, Lane, Select, Vector, sin_cos_turns};
use glam::Vec2;

/// The places in the unit square [0, 1]² of unit directions.
#[inline(always)]
pub fn to_square<F: Lane>(direction: F::Vector) -> [F; 2] {
    let [x, y, z] = direction.xyz();
    // 1 − |z| cancels near the poles; (x² + y²)/(1 + |z|) is the same.
    let r = ((x * x + y * y) / (z.abs() + 1.0)).sqrt();
    let v = lane::atan2(y.abs(), x.abs()) * core::f32::consts::FRAC_2_PI * r;
    let u = r - v;
    let below = z.lt(F::ZERO);
    let [u, v] = below.select([F::ONE - v, F::ONE - u], [u, v]);
    [u.copysign(x), v.copysign(y)].map(|c| (c + 1.0) * 0.5)
}

/// The unit directions at places of the unit square.
#[inline(always)]
pub fn to_direction<F: Lane>(place: [F; 2]) -> F::Vector {
    let [u, v] = place.map(|c| c * 2.0 - 1.0);
    let (across, up) = (u.abs(), v.abs());
    let s = F::ONE - (across + up);
    let r = F::ONE - s.abs();
    let slope = r
        .gt(F::ZERO)
        .select((up - across) / r.max(F::splat(f32::MIN_POSITIVE)), F::ZERO);
    let (sin, cos) = sin_cos_turns((slope + 1.0) * 0.125);
    let horizontal = r * (F::splat(2.0) - r * r).safe_sqrt();
    F::Vector::from_xyz(
        (horizontal * cos).copysign(u),
        (horizontal * sin).copysign(v),
        (F::ONE - r * r).copysign(s),
    )
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
    use glam::Vec3;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    proptest! {
        #![proptest_config(ProptestConfig {
            failure_persistence: None,
            rng_seed: RngSeed::Fixed(1),
            ..ProptestConfig::with_cases(2000)
        })]

        #[test]
        fn square_and_sphere_correspond(u in 0.0f32..1.0, v in 0.0f32..1.0) {
            let direction = to_direction::<f32>([u, v]);
            prop_assert!((direction.length() - 1.0).abs() < 1e-6);
            let back = Vec2::from(to_square::<f32>(direction));
            let place = Vec2::new(u, v);
            prop_assert!((back - place).abs().max_element() < 1e-6, "{back}");
            for copy in copies(place) {
                let seen = to_direction::<f32>(wrapped(copy).to_array());
                prop_assert!((seen - direction).length() < 2e-6, "{copy}");
            }
        }

        /// Every place has 4π steradian per unit of area, by central differences. Rejects angles that are not linear in the quadrant.
        #[test]
        fn areas_are_kept(u in 0.05f32..0.45, v in 0.05f32..0.45) {
            const STEP: f32 = 1.0 / 1024.0;
            prop_assume!((u + v - 0.5).abs() > 0.01);
            let at = |du: f32, dv: f32| to_direction::<f32>([u + du, v + dv]);
            let du = (at(STEP, 0.0) - at(-STEP, 0.0)) / (2.0 * STEP);
            let dv = (at(0.0, STEP) - at(0.0, -STEP)) / (2.0 * STEP);
            let jacobian = du.cross(dv).length() / (4.0 * core::f32::consts::PI);
            prop_assert!((jacobian - 1.0).abs() < 2e-3, "{jacobian}");
        }
    }

    #[test]
    fn poles_and_axes() {
        let at = |direction| Vec2::from(to_square::<f32>(direction));
        for (direction, place) in [
            (Vec3::Z, [0.5, 0.5]),
            (Vec3::X, [1.0, 0.5]),
            (Vec3::Y, [0.5, 1.0]),
            (Vec3::NEG_X, [0.0, 0.5]),
            (Vec3::NEG_Y, [0.5, 0.0]),
            (Vec3::NEG_Z, [1.0, 1.0]),
        ] {
            let found = at(direction);
            assert!(
                (found - Vec2::from(place)).abs().max_element() < 1e-6,
                "{direction} {found}"
            );
        }
    }
}
