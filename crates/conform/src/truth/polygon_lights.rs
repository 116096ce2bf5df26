//! The irradiance of the plane z = 0 under a convex or flat light of polygons of radiance 1.
//!
//! Every polygon that faces the point adds Lambert's sum over its edges,
//! E = ½ Σ γᵢ n·(rᵢ × rᵢ₊₁)/|rᵢ × rᵢ₊₁| with rᵢ the corners as seen from the point and γᵢ the angle
//! between rᵢ and rᵢ₊₁ (Lambert, *Photometria*, 1760): of a convex solid no such polygon hides
//! another, and inner edges cancel. A polygon may be concave: it is never cut.

use etalon_math::float64::{acos, cos, sin};
use glam::DVec3;

/// Corners in a plane (m), counterclockwise as seen from where the light goes.
pub type Polygon = Vec<[f64; 3]>;

/// Under polygons above the plane, at a point (m) of it.
pub fn polygons(polygons: &[Polygon], [x, y]: [f64; 2]) -> f64 {
    let seen = polygons
        .iter()
        .map(|polygon| polygon.iter().map(|c| [c[0] - x, c[1] - y, c[2]]));
    seen.map(Iterator::collect::<Polygon>)
        .filter(|corners| faces(corners))
        .map(|corners| (0.5 * lambert(&corners)).abs())
        .sum()
}

/// Under a rectangle that is turned by `tilt` (rad) about the y axis, with its middle at the height `h` (m) above the origin
/// and sides of 2 `a` and 2 `b` (m).
pub fn rectangle(h: f64, [a, b]: [f64; 2], tilt: f64, [x, y]: [f64; 2]) -> f64 {
    let corners =
        [(-a, -b), (a, -b), (a, b), (-a, b)].map(|(x, y)| [x * cos(tilt), y, h - x * sin(tilt)]);
    let seen = corners.map(|c| [c[0] - x, c[1] - y, c[2]]);
    (0.5 * lambert(&seen)).abs()
}

/// Lambert's sum for the normal (0, 0, 1) and the corners as seen from the point: twice E, with
/// the sign of the turn.
pub fn lambert(corners: &[[f64; 3]]) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    (0..corners.len())
        .map(|i| {
            let (p, q) = (corners[i], corners[(i + 1) % corners.len()]);
            let cross = [
                p[1] * q[2] - p[2] * q[1],
                p[2] * q[0] - p[0] * q[2],
                p[0] * q[1] - p[1] * q[0],
            ];
            let angle = acos(dot(p, q) / (dot(p, p) * dot(q, q)).sqrt());
            angle * cross[2] / dot(cross, cross).sqrt()
        })
        .sum()
}

/// Whether the polygon faces the origin.
fn faces(corners: &[[f64; 3]]) -> bool {
    // The sum of cross products around a polygon is twice its area, as a vector.
    let next = corners.iter().cycle().skip(1);
    let cross = |(&p, &q)| DVec3::from_array(p).cross(DVec3::from_array(q));
    let normal: DVec3 = corners.iter().zip(next).map(cross).sum();
    normal.dot(DVec3::from_array(corners[0])) < 0.0
}

#[cfg(test)]
mod tests {
    use super::{polygons, rectangle};
    use crate::truth::by_definition::{POINTS, grid, irradiance};
    use etalon_math::float64::{atan, cos, sin};

    #[test]
    fn rectangle_is_the_integral_over_its_surface() {
        const N: usize = 400;
        let tilt = 30f64.to_radians();
        for at in POINTS {
            let lights = grid(N).map(|(u, v)| {
                let (a, b) = (0.8 * (2.0 * u - 1.0), 0.4 * (2.0 * v - 1.0));
                let p = [a * cos(tilt), b, 1.2 - a * sin(tilt)];
                let n = [-sin(tilt), 0.0, -cos(tilt)];
                (p, n, 1.6 * 0.8 / (N * N) as f64)
            });
            let expected = irradiance(lights, at);
            let found = rectangle(1.2, [0.8, 0.4], tilt, at);
            assert!((found / expected - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn two_triangles_are_a_rectangle() {
        // A parallel unit square at unit distance, seen from below its corner: E/L = √½ atan √½
        // (Howell's configuration B-3 with A = B = 1).
        let square = [
            vec![[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0]],
            vec![[0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [1.0, 0.0, 1.0]],
        ];
        let half = 0.5f64.sqrt();
        let expected = half * atan(half);
        let found = polygons(&square, [0.0, 0.0]);
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        // Its back gives nothing.
        let turned = square.map(|triangle| triangle.into_iter().rev().collect());
        assert_eq!(polygons(&turned, [0.0, 0.0]), 0.0);
    }
}
