//! Polygons into triangles.
//!
//! A convex polygon becomes the fan around its first corner, as in Mitsuba. A concave one, for
//! which a fan would fold over itself, is cut by its ears (Meisters, "Polygons Have Ears", 1975).
//! Both look at the polygon along its mean (Newell) normal.

use glam::{DVec2, DVec3, Vec3};

/// Polygons of more corners than this are always cut as fans: ears cost quadratic time.
const MOST_CORNERS_FOR_EARS: usize = 1024;

/// Cuts the polygon of these corners and gives the triangles, as corner numbers within the
/// polygon, to `emit`. Fewer than three corners make no triangle.
pub(crate) fn triangulate(corners: &[Vec3], mut emit: impl FnMut([usize; 3])) {
    let count = corners.len();
    if count <= 3 || count > MOST_CORNERS_FOR_EARS {
        return fan(0..count, emit);
    }
    let Some(flat) = project(corners) else {
        return fan(0..count, emit);
    };
    if is_convex(&flat) {
        return fan(0..count, emit);
    }
    let mut left: Vec<usize> = (0..count).collect();
    while left.len() > 3 {
        let Some(ear) = find_ear(&flat, &left) else {
            break;
        };
        let n = left.len();
        emit([left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]]);
        left.remove(ear);
    }
    fan(left, emit);
}

fn fan(corners: impl IntoIterator<Item = usize>, mut emit: impl FnMut([usize; 3])) {
    let mut corners = corners.into_iter();
    let (Some(first), Some(mut previous)) = (corners.next(), corners.next()) else {
        return;
    };
    for corner in corners {
        emit([first, previous, corner]);
        previous = corner;
    }
}

/// The polygon seen along its Newell normal, counter-clockwise; `None` if it has no area.
fn project(corners: &[Vec3]) -> Option<Vec<DVec2>> {
    let origin = corners[0].as_dvec3();
    let points: Vec<DVec3> = corners.iter().map(|c| c.as_dvec3() - origin).collect();
    let normal: DVec3 = (0..points.len())
        .map(|i| points[i].cross(points[(i + 1) % points.len()]))
        .sum();
    let normal = normal.try_normalize()?;
    let (right, up) = normal.any_orthonormal_pair();
    Some(
        points
            .iter()
            .map(|p| DVec2::new(p.dot(right), p.dot(up)))
            .collect(),
    )
}

/// Twice the signed area of a triangle.
fn area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

fn is_convex(flat: &[DVec2]) -> bool {
    let n = flat.len();
    let largest = flat.iter().map(|p| p.length_squared()).fold(0.0, f64::max);
    (0..n).all(|i| area(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) >= -1e-9 * largest)
}

/// The position in `left` of a convex corner whose triangle contains no other corner.
fn find_ear(flat: &[DVec2], left: &[usize]) -> Option<usize> {
    let n = left.len();
    (0..n).find(|&i| {
        let (a, b, c) = (
            flat[left[(i + n - 1) % n]],
            flat[left[i]],
            flat[left[(i + 1) % n]],
        );
        area(a, b, c) > 0.0
            && !left.iter().map(|&k| flat[k]).any(|p| {
                p != a
                    && p != b
                    && p != c
                    && area(a, b, p) >= 0.0
                    && area(b, c, p) >= 0.0
                    && area(c, a, p) >= 0.0
            })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(points: &[[f32; 2]]) -> Vec<[usize; 3]> {
        let corners: Vec<Vec3> = points.iter().map(|p| Vec3::new(p[0], 0.5, p[1])).collect();
        let mut triangles = Vec::new();
        triangulate(&corners, |t| triangles.push(t));
        triangles
    }

    #[test]
    fn convex_polygons_become_fans() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert_eq!(cut(&square), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(cut(&square[..3]), [[0, 1, 2]]);
        assert_eq!(cut(&square[..2]), [[0; 3]; 0]);
        // All corners on one line: no area, but still the right number of triangles.
        assert_eq!(
            cut(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]]).len(),
            2
        );
    }

    #[test]
    fn concave_polygons_keep_their_area() {
        let dart = [[2.0, 0.0], [0.5, 0.5], [0.0, 2.0], [0.0, 0.0]];
        let comb = [
            [0.0, 0.0],
            [5.0, 0.0],
            [5.0, 3.0],
            [4.0, 1.0],
            [3.0, 3.0],
            [2.0, 1.0],
            [1.0, 3.0],
            [0.0, 1.0],
        ];
        for polygon in [&dart[..], &comb[..]] {
            let triangles = cut(polygon);
            assert_eq!(triangles.len(), polygon.len() - 2);
            let point = |i: usize| DVec2::new(polygon[i][0].into(), polygon[i][1].into());
            let signed = |i, j, k| area(point(i), point(j), point(k));
            let whole: f64 = (1..polygon.len() - 1).map(|i| signed(0, i, i + 1)).sum();
            let parts: f64 = triangles
                .iter()
                .map(|t| signed(t[0], t[1], t[2]).abs())
                .sum();
            assert!((whole.abs() - parts).abs() < 1e-9, "{triangles:?}");
        }
    }
}
