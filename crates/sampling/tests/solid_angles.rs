//! Triangles and rectangles of any shape, seen from anywhere: the solid angle is that of an
//! independent formula, samples are unit vectors that meet the light, and invert inverts.

use etalon_math::float64::{atan, tan};
use etalon_sampling::warps::{SphericalRectangle, SphericalTriangle};
use glam::{DVec3, Quat, Vec2, Vec3};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

fn point() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-2.0f32..2.0).prop_map(Vec3::from_array)
}

fn square() -> impl Strategy<Value = Vec2> {
    prop::array::uniform2(0.0f32..1.0).prop_map(Vec2::from_array)
}

/// The spherical excess by L'Huilier's theorem, from the lengths of the sides.
fn l_huilier(corners: [Vec3; 3]) -> f64 {
    let [a, b, c] = corners.map(|v| v.as_dvec3().normalize());
    let side = |p: DVec3, q: DVec3| p.angle_between(q);
    let (x, y, z) = (side(b, c), side(c, a), side(a, b));
    let s = 0.5 * (x + y + z);
    let product = tan(0.5 * s) * tan(0.5 * (s - x)) * tan(0.5 * (s - y)) * tan(0.5 * (s - z));
    4.0 * atan(product.max(0.0).sqrt())
}

/// How far a direction's rounding to single precision may move a number of the square: the
/// direction's own rounding over the least width that a light of this solid angle can have.
fn tolerance(solid_angle: f32, u: Vec2) -> f32 {
    // Next to the corner where all lines meet, the line is ill-determined.
    1e-3 + 4e-6 / (solid_angle * u.y.max(1e-3))
}

proptest! {
    #![proptest_config(Config {
        cases: 3000,
        rng_seed: RngSeed::Fixed(2),
        failure_persistence: None,
        ..Config::default()
    })]

    #[test]
    fn triangles(a in point(), b in point(), c in point(), u in square()) {
        let corners = [a, b, c];
        let expected = l_huilier(corners);
        let Some(triangle) = SphericalTriangle::new(corners) else {
            prop_assert!(!(2e-6..6.1).contains(&expected), "refused {expected} sr");
            return Ok(());
        };
        let solid_angle = triangle.solid_angle();
        // L'Huilier's tangent is unbounded towards the hemisphere, hence 6 sr.
        if expected > 1e-3 && expected < 6.0 {
            prop_assert!((f64::from(solid_angle) / expected - 1.0).abs() < 1e-5);
        }
        let w = triangle.sample(u);
        prop_assert!((w.length() - 1.0).abs() < 3e-7);
        let p = triangle.barycentric(w);
        let at = a * (1.0 - p.x - p.y) + b * p.x + c * p.y;
        prop_assert!(at.normalize().distance(w) < 1e-5, "{w} misses at {at}");
        if solid_angle > 1e-3 {
            let error = (triangle.invert(w) - u).abs().max_element();
            prop_assert!(error < tolerance(solid_angle, u), "{error}, {solid_angle} sr");
        }
    }

    #[test]
    fn rectangles(
        corner in point(),
        size in prop::array::uniform2(0.01f32..4.0),
        axis in point(),
        u in square(),
    ) {
        let turn = Quat::from_xyzw(axis.x, axis.y, axis.z, 1.0).normalize();
        let edges = [turn * (Vec3::X * size[0]), turn * (Vec3::Y * size[1])];
        let far = corner + edges[0] + edges[1];
        let expected = l_huilier([corner, corner + edges[0], far])
            + l_huilier([corner, corner + edges[1], far]);
        let Some(rectangle) = SphericalRectangle::new(corner, edges) else {
            prop_assert!(!(2e-6..6.1).contains(&expected), "refused {expected} sr");
            return Ok(());
        };
        let solid_angle = rectangle.solid_angle();
        if expected > 1e-2 && expected < 6.0 {
            prop_assert!((f64::from(solid_angle) / expected - 1.0).abs() < 1e-5);
        }
        let position = rectangle.sample_position(u);
        prop_assert!(position.min_element() >= 0.0 && position.max_element() <= 1.0);
        let w = rectangle.sample(u);
        prop_assert!((w.length() - 1.0).abs() < 3e-7);
        let at = corner + edges[0] * position.x + edges[1] * position.y;
        prop_assert!(at.normalize().distance(w) < 1e-6);
        if solid_angle > 1e-3 {
            let error = (rectangle.invert_position(position) - u).abs().max_element();
            prop_assert!(error < 1e-3, "{error}, {solid_angle} sr");
        }
    }
}
