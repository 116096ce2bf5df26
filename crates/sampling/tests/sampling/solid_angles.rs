//! Triangles and rectangles of any shape, seen from anywhere: the solid angle is that of an
//! independent formula, samples are unit vectors that meet the light, and invert inverts.

use etalon_math::float64::{atan, tan};
use etalon_sampling::warps::{RectangleView, SphericalRectangle, SphericalTriangle};
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
        let Some(triangle) = SphericalTriangle::new(corners.map(Vec3::as_dvec3)) else {
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

    /// A view's density is positive everywhere, integrates to one (exactly so by the midpoints of
    /// four squares: it is bilinear), and is the Jacobian of the inverse.
    #[test]
    fn views(corner in point(), a in point(), b in point(), n in point(), u in square()) {
        let normal = n.normalize_or_zero();
        let view = RectangleView::new(corner, [a, b], normal);
        let quarters = [(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)];
        let integral: f32 = quarters.iter().map(|&q| 0.25 * view.density(q.into())).sum();
        prop_assert!((integral - 1.0).abs() < 1e-5, "{integral}");
        let p = Vec2::from(view.sample(u.to_array()));
        prop_assert!(p.cmpge(Vec2::ZERO).all() && p.cmple(Vec2::ONE).all());
        prop_assert!(view.density(p.to_array()) > 0.0);
        // Where a density is nearly zero the inverse is steep.
        let back = view.invert(p);
        prop_assert!(back.distance(u) < 1e-4 * (1.0 + view.density(p.to_array())), "{u} {back}");
        let h = 1e-3;
        let at = u * 0.9 + 0.05;
        let step = |d: Vec2| (view.invert(at + d * h) - view.invert(at - d * h)) / (2.0 * h);
        let jacobian = step(Vec2::X).perp_dot(step(Vec2::Y));
        let density = view.density(at.to_array());
        prop_assert!((jacobian - density).abs() < 0.01 * (1.0 + density), "{jacobian} {density}");
    }
}

/// From afar, a view's density follows what each point of a rectangle sends: to within 4 % from
/// five diagonals away. Refused: the cosine at the receiver left out, r² instead of r³.
#[test]
fn views_follow_irradiance() {
    let (corner, edges) = (
        Vec3::new(2.0, -4.0, 3.0),
        [Vec3::new(0.0, 0.6, 0.0), Vec3::new(0.0, 0.0, 0.8)],
    );
    let normal = Vec3::new(0.5, -0.7, 0.3).normalize();
    let view = RectangleView::new(corner, edges, normal);
    let sent = |p: Vec2| {
        let y = corner + edges[0] * p.x + edges[1] * p.y;
        y.dot(normal) / y.length_squared().powi(2)
    };
    let cells = 16;
    let center = |i: usize| (i as f32 + 0.5) / cells as f32;
    let points: Vec<Vec2> = (0..cells * cells)
        .map(|i| Vec2::new(center(i % cells), center(i / cells)))
        .collect();
    let mean = points.iter().map(|&p| sent(p)).sum::<f32>() / points.len() as f32;
    for p in points {
        let ratio = view.density(p.to_array()) * mean / sent(p);
        assert!((ratio - 1.0).abs() < 0.04, "{p}: {ratio}");
    }
}
